"""A server of warm processes: the command line as a real process, without starting Python anew.

    python tests/warm_process.py SOCKET

It imports what every command imports, and for each request forks a process that runs the command
line from its first line to its last: its own memory, standard streams, signals and exit code. What
is lost is only the second or two that an interpreter takes to import numpy and its kin and to read
the commands, and the taking apart of all modules at its end, which in a fork copies every page.
Tests of that very start (what is imported, missing packages, other paths) begin a fresh interpreter
instead.

A request is one JSON object in a line: arguments, folder, environment, and the files that take
standard output and error. The answers are lines too: the process's number when it has started, its
exit status when it has ended.
"""

from __future__ import annotations

import atexit
import contextlib
import functools
import gc
import importlib
import json
import os
import pkgutil
import select
import socket
import sys
from typing import Any

PRELOADED = (
    *("numpy", "scipy.optimize", "scipy.special", "numba", "pint", "tomlkit", "pydantic"),
    *("jinja2", "ezdxf", "trimesh", "cadquery"),
    *("cqdd_design.cli.main", "cqdd_design.exporting", "cqdd_design.machine.contact_analysis"),
)


def serve(path: str) -> None:
    """Answer until the client hangs up; only a forked process returns, to become the command."""
    for name in (*PRELOADED, *_own_modules()):
        with contextlib.suppress(ImportError):
            importlib.import_module(name)
    _load_what_numba_loads_late()
    _read_the_commands()
    gc.collect()
    gc.freeze()
    with socket.socket(socket.AF_UNIX) as door:
        door.bind(path)
        door.listen(1)
        connection, _ = door.accept()
    with connection, connection.makefile("r") as requests:
        for line in requests:
            request = json.loads(line)
            child = os.fork()
            if child == 0:
                connection.detach()
                _become(request)
                return
            connection.sendall(f"{child}\n".encode())
            # A client that has gone away wants nothing more of its process.
            while not (ended := os.waitpid(child, os.WNOHANG))[0]:
                select.select([connection], [], [], 0.005)
            connection.sendall(f"{os.waitstatus_to_exitcode(ended[1])}\n".encode())


def _own_modules() -> list[str]:
    """The roads that commands take, and through them nearly all rooms."""
    import cqdd_design.roads

    found = pkgutil.iter_modules(cqdd_design.roads.__path__, "cqdd_design.roads.")
    return [one.name for one in found]


def _load_what_numba_loads_late() -> None:
    """Half a second that the first compiled function of a process takes to import."""
    with contextlib.suppress(ImportError):
        import numba

        numba.njit(lambda x: x)(0.0)


def _read_the_commands() -> None:
    """Signatures and help of all commands, which every process reads anew."""
    import typer.main

    from cqdd_design.cli.main import app

    typer.main.get_command = functools.cache(typer.main.get_command)
    typer.main.get_command(app)


def _become(request: dict[str, Any]) -> None:
    """Take folder, environment and standard streams of the process that was asked for."""
    os.setsid()
    os.chdir(request["folder"])
    os.environ.clear()
    os.environ.update(request["environment"])
    for number, name in ((0, os.devnull), (1, request["out"]), (2, request["err"])):
        flags = os.O_RDONLY if number == 0 else os.O_WRONLY | os.O_CREAT | os.O_TRUNC
        opened = os.open(name, flags, 0o600)
        os.dup2(opened, number)
        os.close(opened)
    for stream in (sys.stdout, sys.stderr):
        stream.reconfigure(encoding="utf-8")  # type: ignore[union-attr]
    sys.argv = ["cqdd-design", *request["arguments"]]


if __name__ == "__main__":
    serve(sys.argv[1])
    from cqdd_design.__main__ import main

    code = main()
    atexit._run_exitfuncs()
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)
