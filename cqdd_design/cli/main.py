"""The application: its commands, and how every kind of error ends."""

from __future__ import annotations

import contextlib
import errno
import os
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Annotated

import typer
from typer.exceptions import Abort, TyperException

from cqdd_design.cli import (
    analyse,
    bench,
    calibrate,
    catalog,
    check,
    compare,
    doctor,
    explain,
    export,
    inertia,
    interruption,
    new,
    report,
    schema,
    simulate,
    size,
    tolerance,
    torque_evaluate,
    torque_export,
    torque_generate,
    torque_import,
    torque_train,
)
from cqdd_design.cli.colour import ERROR, with_coloured_start
from cqdd_design.cli.fitting import on_screen
from cqdd_design.cli.number_words import number_refused
from cqdd_design.cli.session import INTERRUPTED_WITH_RESULTS, command, print_result
from cqdd_design.environment import PROJECT, missing_dependency
from cqdd_design.errors import CqddError, UsageError, printable
from cqdd_design.version import __version__

app = typer.Typer(
    name="cqdd-design",
    help="Design cycloidal quasi-direct-drive actuators: from a ratio and a torque to a checked "
    "design, the DXF and STEP to make it from, and a report.",
    epilog="Start with: cqdd-design size --ratio 10 --report --export dxf,step",
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)

#: In the order of the work, which is the order of the help.
COMMANDS = (
    new.new,
    size.size,
    check.check,
    analyse.analyse,
    bench.bench,
    calibrate.calibrate,
    simulate.simulate,
    tolerance.tolerance,
    compare.compare,
    inertia.inertia,
    export.export,
    report.report,
    catalog.catalog,
    schema.schema,
    doctor.doctor,
    explain.explain,
)
for _function in COMMANDS:
    app.command()(command(_function))

#: Of ``cqdd-design torque``, by their names there.
TORQUE_COMMANDS: dict[str, Callable[..., int | None]] = {
    "generate": torque_generate.generate,
    "import": torque_import.import_log,
    "train": torque_train.train,
    "evaluate": torque_evaluate.evaluate,
    "export": torque_export.export_network,
}
torque = typer.Typer(
    name="torque",
    help="Learned torque estimation: data, training, files.",
    no_args_is_help=True,
    rich_markup_mode=None,
)
for _name, _within in TORQUE_COMMANDS.items():
    torque.command(_name)(command(_within, f"torque {_name}"))
app.add_typer(torque)


_FULL = {errno.ENOSPC, errno.EFBIG, errno.EDQUOT}
"""A disk without room."""
_BARRED = {errno.ENAMETOOLONG, errno.EACCES, errno.EPERM, errno.EROFS, errno.ELOOP, errno.ENOTDIR}
"""A place that cannot be, or is not ours."""


def _show_version(wanted: bool) -> None:
    if wanted:
        print_result(f"cqdd-design {__version__}")
        raise typer.Exit


def _set_project(folder: Path | None) -> None:
    """For this process, and for those that it starts."""
    if folder is not None:
        os.environ[PROJECT] = str(folder)


def _show_places(context: typer.Context, wanted: bool) -> None:
    if wanted:
        from cqdd_design.cli.places import places, places_document

        print_result(places_document() if context.params.get("json") else places())
        raise typer.Exit


@app.callback()
def _root(
    project: Annotated[
        Path | None,
        typer.Option(
            "--project",
            metavar="DIR",
            callback=_set_project,
            is_eager=True,
            help="Folder of designs/, exports/ and reports/; default CQDD_DESIGN_PROJECT, or here.",
        ),
    ] = None,
    where: Annotated[
        bool,
        typer.Option("--where", callback=_show_places, help="Show where everything is written."),
    ] = False,
    json: Annotated[
        bool,
        typer.Option("--json", is_eager=True, help="With --where: print one JSON document."),
    ] = False,
    version: Annotated[
        bool,
        typer.Option("--version", callback=_show_version, is_eager=True, help="Show the version."),
    ] = False,
) -> None:
    if json:
        raise UsageError("--json before a command belongs to --where; write it after the command.")


def run(arguments: Sequence[str]) -> int:
    """Run the command line.

    Parameters
    ----------
    arguments : sequence of str
        Without the name of the program.

    Returns
    -------
    int
        The exit code (docs/cli.md).
    """
    try:
        given = list(arguments) or ["--help"]
        code = int(app(given, prog_name="cqdd-design", standalone_mode=False) or 0)
        if code == INTERRUPTED_WITH_RESULTS:
            return 130
        # Typer answers Ctrl-C inside a command with this code and no word.
        return _end(arguments, code, "Interrupted", "interrupted") if code == 130 else code
    except (KeyboardInterrupt, Abort):
        return _end(arguments, 130, "Interrupted", "interrupted")
    except TyperException as error:
        return _end(arguments, error.exit_code, "UsageError", _usage_message(error))
    except CqddError as error:
        details = error.to_dict() if hasattr(error, "to_dict") else {}
        return _end(arguments, error.exit_code, type(error).__name__, error.message, details)
    except Exception as error:
        if isinstance(error, OSError) and error.errno in _FULL:
            # Compiled kernels are kept on disk by numba, which does not ask whether there is room.
            place = error.filename or "what is kept for the next run"
            return _end(arguments, 2, "UsageError", f"cannot write {place}: {error.strerror}.")
        if isinstance(error, OSError) and error.errno in _BARRED and error.filename:
            place = str(error.filename)
            told = place if len(place) <= 80 else f"{place[:80]}..."
            return _end(arguments, 2, "UsageError", f"cannot use {told}: {error.strerror}.")
        missing = missing_dependency(error) if isinstance(error, ImportError) else None
        if missing is not None:
            return _end(arguments, missing.exit_code, type(missing).__name__, missing.message)
        return _end(
            arguments,
            1,
            "Bug",
            f"this is a bug in cqdd-design, not in your input ({type(error).__name__}: {error}). "
            f"Please report it with the log {_log_bug(arguments)}.",
        )


def _end(
    arguments: Sequence[str],
    code: int,
    kind: str,
    message: str,
    details: Mapping[str, object] | None = None,
) -> int:
    """Tell one error, on stderr and, where JSON is asked for, as a document."""
    import traceback

    interrupted = interruption.exit_code()
    if interrupted is not None:  # whatever the error is that came of it
        code, kind, message, details = interrupted, "Interrupted", "interrupted", None
    if "--debug" in arguments and kind != "Interrupted":
        traceback.print_exc()
    message = message.replace("?.", "?")
    told = on_screen(f"{ERROR} {printable(message)}", sys.stderr)
    print(with_coloured_start(told, ERROR, sys.stderr), file=sys.stderr)
    if "--json" in arguments:
        from cqdd_design.library.envelope import error_document

        names = [function.__name__ for function in COMMANDS]
        name = next((a for a in arguments if a in names or a == "torque"), None)
        if name == "torque":
            within = next((a for a in arguments if a in TORQUE_COMMANDS), "")
            name = f"torque {within}".strip()
        with contextlib.suppress(UsageError):  # stdout itself may be what failed
            print_result(error_document(name, code, kind, message, details or {}))
    return code


def _usage_message(error: TyperException) -> str:
    message = number_refused(error) or error.format_message()
    context = getattr(error, "ctx", None)
    return message if context is None else f"{message} (see `{context.command_path} --help`)"


def _log_bug(arguments: Sequence[str]) -> str:
    import platform
    import tempfile
    import traceback

    try:
        with tempfile.NamedTemporaryFile(
            "w", prefix="cqdd-design-", suffix=".log", delete=False, encoding="utf-8"
        ) as log:
            log.write(f"cqdd-design {__version__}, Python {platform.python_version()}, ")
            log.write(f"{platform.platform()}\narguments: {list(arguments)!r}\n\n")
            log.write(traceback.format_exc())
    except OSError as error:
        return f"that could not be written ({error.strerror}; add --debug to see it)"
    return log.name
