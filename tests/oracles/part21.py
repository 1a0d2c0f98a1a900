"""STEP text read by hand (ISO 10303-21), and what makes a boundary whole (ISO 10303-42).

No kernel: instances by number, their references, and for every shell how often and in which sense
its faces use an edge, with the numbers of Euler's formula.
"""

from __future__ import annotations

import re
from collections import Counter
from typing import NamedTuple

_INSTANCE = re.compile(r"#(\d+)\s*=\s*(.*?);\s*(?=#\d+\s*=|ENDSEC)", re.DOTALL)
_STRING = re.compile(r"'(?:[^']|'')*'")
_REFERENCE = re.compile(r"#(\d+)")
_FLAG = re.compile(r"\.([TF])\.")


class Shell(NamedTuple):
    """A closed shell of a file.

    Attributes
    ----------
    vertices, edges, faces, loops : int
    used_wrongly : tuple of int
        Numbers of the edges that its faces do not use just twice, once in each sense.
    surfaces : Counter
        Entities of the faces' surfaces.
    """

    vertices: int
    edges: int
    faces: int
    loops: int
    used_wrongly: tuple[int, ...]
    surfaces: Counter[str]

    @property
    def genus(self) -> float:
        """Of Euler and Poincaré: V - E + F - (L - F) = 2 (1 - G)."""
        return 1 - 0.5 * (self.vertices - self.edges + 2 * self.faces - self.loops)


class Part21:
    """Instances of a file."""

    def __init__(self, text: str) -> None:
        data = text.split("DATA;", 1)[1]
        self.texts = {int(number): body for number, body in _INSTANCE.findall(data)}
        bare = {number: _STRING.sub("''", body) for number, body in self.texts.items()}
        self._refers = {
            number: tuple(map(int, _REFERENCE.findall(body))) for number, body in bare.items()
        }
        self.kinds = {number: body.split("(", 1)[0].strip() for number, body in bare.items()}
        self._bare = bare

    def all(self, kind: str) -> list[int]:
        """Numbers of the instances of an entity."""
        return [number for number, one in self.kinds.items() if one == kind]

    @property
    def unresolved(self) -> set[int]:
        """Numbers that are referred to and stand nowhere."""
        return {other for those in self._refers.values() for other in those} - set(self.texts)

    def _flag(self, number: int) -> bool:
        return _FLAG.findall(self._bare[number])[-1] == "T"

    def shells(self) -> list[Shell]:
        """Of all solids."""
        return [
            self._shell(shell)
            for solid in self.all("MANIFOLD_SOLID_BREP")
            for shell in self._refers[solid]
        ]

    def _shell(self, shell: int) -> Shell:
        if self.kinds[shell] != "CLOSED_SHELL":
            raise ValueError(f"#{shell} is a {self.kinds[shell]}, no closed shell")
        uses: Counter[tuple[int, bool]] = Counter()
        vertices: set[int] = set()
        surfaces: Counter[str] = Counter()
        loops = 0
        for face in self._refers[shell]:
            *bounds, surface = self._refers[face]
            surfaces[self.kinds[surface]] += 1
            for bound in bounds:
                (loop,) = self._refers[bound]
                loops += 1
                if self.kinds[loop] == "VERTEX_LOOP":
                    vertices.update(self._refers[loop])
                    continue
                for oriented in self._refers[loop]:
                    (edge,) = self._refers[oriented]
                    # A bound that is turned turns all its edges; the face's own sense is that
                    # of its surface, and its bounds are given to the face (ISO 10303-42, 4.4).
                    uses[edge, self._flag(oriented) == self._flag(bound)] += 1
                    vertices.update(self._refers[edge][:2])
        edges = {edge for edge, _ in uses}
        wrong = [edge for edge in edges if (uses[edge, True], uses[edge, False]) != (1, 1)]
        return Shell(
            len(vertices),
            len(edges),
            len(self._refers[shell]),
            loops,
            tuple(sorted(wrong)),
            surfaces,
        )
