"""``cqdd-design new``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from cqdd_design.cli import completion
from cqdd_design.cli.options import Force, option
from cqdd_design.cli.session import Output
from cqdd_design.environment import project_folder
from cqdd_design.errors import UsageError


def new(
    out: Output,
    kind: Annotated[
        str | None,
        typer.Argument(
            metavar="[KIND]",
            help="What to write: design, duty, motor or requirements, with every key.",
            autocompletion=completion.templates,
        ),
    ] = None,
    example: Annotated[
        str | None,
        option(
            "NAME",
            "An example design instead, such as cqdd-10.",
            autocompletion=completion.examples,
        ),
    ] = None,
    target: Annotated[
        Path | None, option("FILE", "Default KIND.toml, duty.csv or NAME.toml, here.", "--out")
    ] = None,
    force: Force = False,
) -> None:
    """Write a file to start from: a template with every key, or an example design."""
    from cqdd_design.design import templates
    from cqdd_design.files import write_atomically

    if (kind is None) == (example is None):
        raise UsageError(
            f"new writes one of {', '.join(templates.TEMPLATES)}, as in `cqdd-design new motor`, "
            "or an example design, as in `cqdd-design new --example cqdd-10`; there are "
            f"{', '.join(templates.examples())}."
        )
    if example is not None:
        path = _place(f"{example}.toml", target, force=force)
        text, says = templates.example_text(example, path.stem), "an example design"
    else:
        assert kind is not None
        found = templates.find_template(kind)
        path = _place(found.file, target, force=force)
        text, says = found.text(), found.says
    written = write_atomically(path, text, "template" if example is None else "design")
    out.wrote([written])
    out.document({"kind": kind, "example": example, "says": says}, files=[written])


def _place(name: str, target: Path | None, *, force: bool) -> Path:
    """Where a file of this name is written: in the project, or what was asked for, if alike."""
    from cqdd_design.files import kind_by_ending, refuse_overwrite

    path = project_folder() / name if target is None else target
    refuse_overwrite(path, force=force)
    kind_by_ending(path, (Path(name).suffix[1:],), Path(name).stem)
    return path
