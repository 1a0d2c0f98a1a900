"""The graph of imports: which room uses which, and circles among modules.

    python tools/imports.py            rooms with the rooms they import; exit code 1 for a circle
    python tools/imports.py --dot      the same for Graphviz

Imports inside functions count too. That arrows between rooms only point down is import-linter's
contract in `pyproject.toml`; a circle within a room is what it does not see.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Mapping

import grimp
import networkx

PACKAGE = "cqdd_design"


def module_graph() -> networkx.DiGraph:
    """Every module of the package, with an arrow to each module that it imports."""
    imports = grimp.build_graph(PACKAGE, cache_dir=None)
    graph = networkx.DiGraph()
    graph.add_nodes_from(imports.modules)
    for name in imports.modules:
        graph.add_edges_from((name, one) for one in imports.find_modules_directly_imported_by(name))
    return graph


def circles(graph: networkx.DiGraph) -> list[list[str]]:
    """Groups of modules that import each other, directly or round about."""
    groups = networkx.strongly_connected_components(graph)
    return sorted(sorted(group) for group in groups if len(group) > 1)


def rooms(graph: networkx.DiGraph) -> Mapping[str, set[str]]:
    """The rooms that each room imports."""
    found: dict[str, set[str]] = {}
    for user, used in graph.edges:
        above, below = _room(user), _room(used)
        if above != below:
            found.setdefault(above, set()).add(below)
    return found


def _room(module: str) -> str:
    parts = module.split(".")
    return parts[1] if len(parts) > 1 else PACKAGE


def main() -> int:
    """Print the graph."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    parser.add_argument("--dot", action="store_true", help="for Graphviz")
    dot = parser.parse_args().dot
    graph = module_graph()
    arrows = rooms(graph)
    if dot:
        print("digraph rooms {")
        for above in sorted(arrows):
            for below in sorted(arrows[above]):
                print(f'  "{above}" -> "{below}";')
        print("}")
    else:
        for above in sorted(arrows):
            print(f"{above:12} {' '.join(sorted(arrows[above]))}")
    found = circles(graph)
    for one in found:
        print("circle:", ", ".join(one), file=sys.stderr)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
