"""``cqdd-design schema``."""

from __future__ import annotations

import json

from cqdd_design.cli.session import Output, print_result


def schema(out: Output) -> None:
    """Print the JSON schema of design files, for editors."""
    from cqdd_design.design.schema import design_schema

    document = design_schema()
    if out.as_json:
        out.document({"schema": document})
    else:
        print_result(json.dumps(document, indent=2, ensure_ascii=False))
