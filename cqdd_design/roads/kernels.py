"""Kernels compiled side by side, before a command needs them: once, on the first use.

As many processes as there are processors put them into numba's cache, each one kernel after the
other: what kernels have in common one process compiles once. The command then reads them from
there. What arguments a kernel takes stands here, since a process that compiles has none.
"""

from __future__ import annotations

import gc
import importlib
import os
import subprocess
import sys
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from queue import SimpleQueue
from threading import Thread
from types import FunctionType
from typing import TYPE_CHECKING, Any, NamedTuple

from cqdd_design.errors import CqddError
from cqdd_design.gearbox.compiled import in_cache

if TYPE_CHECKING:
    from cqdd_design.design import Design

_CONTACTS = ("Contacts", "f4", "f3", "f3", "f3", "f1")
_SPRINGS = ("Springs", "i", "i", "i", "f", "f", "f1", "f", "f", "f")
_LOAD = ("Load", "f", "f")
_RUBBING = ("Rubbing", "f3", "f3", "f3")
_SWEEP = ("SweepResult", "f2", "f3", "f3", "f1", "i1")
_COMPLIANCE = ("Compliance", "f2", "f1", "f", "f4")


class Kernel(NamedTuple):
    """A kernel that commands call.

    Attributes
    ----------
    module, name : str
        Where it stands, and what it is called.
    arguments : tuple
        ``f3`` is a C-contiguous array of three axes of float64, ``i1`` one axis of int64, ``b1``
        of truths, without a number they are scalars; a tuple is a named tuple of such.
    values : tuple of str
        Where the named tuples it takes stand.
    """

    module: str
    name: str
    arguments: tuple[Any, ...]
    values: tuple[str, ...] = ("gearbox.contact.kernel_values",)

    def compiled(self) -> Any:
        """The kernel itself."""
        return getattr(importlib.import_module(f"cqdd_design.{self.module}"), self.name)


GEARBOX = (
    Kernel(
        "gearbox.contact.compliant_sweep_kernel",
        "yield_sweep",
        (_CONTACTS, _SPRINGS, _LOAD, _RUBBING, _COMPLIANCE, "f1", "f2",
         ("YieldingResult", "f2", "f3", "f3", "f3", "f1", "i1")),
    ),
    Kernel(
        "gearbox.contact.friction_sweep_kernel",
        "rub_sweep",
        (_CONTACTS, _SPRINGS, _LOAD, _RUBBING, "f1", _SWEEP, _SWEEP),
    ),
    Kernel(
        "gearbox.contact.sweep_kernel",
        "solve_sweep",
        (_CONTACTS, _SPRINGS, _LOAD, "f1", _SWEEP),
    ),
    Kernel(
        "gearbox.precision.backlash_kernel",
        "backlash_sweep",
        (("RigidParts", "f4", "f3", "f3", "f2", "f2", "f1", "f2", "f4", "f3", "f1", "f", "f"),
         "i1", "f", "f2", ("Extremes", "f1", "f1", "f2")),
    ),
    Kernel(
        "gearbox.bodies.compliance_kernel",
        "add_bearing",
        ("i3", "f3", "f2", "f2", "f2", "f2", "f2", "f3", "f2", "f3", "f3"),
    ),
    Kernel(
        "gearbox.bodies.compliance_kernel",
        "add_contacts",
        ("i3", "f3", "f2", "f2", "f2", "f3", "f3"),
    ),
)  # fmt: skip
"""What any analysis of a gearbox calls, the longest to compile first."""
SIMULATION = (
    Kernel(
        "actuator.kernels.stepping",
        "run_sets",
        ("f2", "f3", ("Signals", *("f2",) * 5), ("Steps", "f", "i", "i"),
         ("Traces", *("f2",) * 14), ("Ledger", *("f1",) * 12), "i", "i"),
        ("actuator.columns",),
    ),
)  # fmt: skip
"""What steps an actuator through time."""
_DRAWN = (
    ("Nominal", "f4", "f3", "f3", "f4", "f3", "f3", "f3", "f2", "f2", "f1", "f1", "f3", "i", "f",
     "f", "f"),
    _SPRINGS,
    _LOAD,
    ("Start", "b1", "b1", "f2", "f3", "f"),
    ("Shared", _RUBBING, _RUBBING, _COMPLIANCE, _COMPLIANCE, ("Worn", "f3", "f3", "f")),
    ("GearboxErrors", "f2", "f1", "f3", "f3", "f2", "f2", "f1", "f2", "f1", "f1"),
    "i",
    "f1",
)  # fmt: skip
_DRAWN_VALUES = "gearbox.contact.kernel_values", "gearbox.contact.part_errors"
ENSEMBLES = (Kernel("gearbox.tolerance.ensemble_kernel", "solve_gearbox", _DRAWN, _DRAWN_VALUES),)
"""What works toleranced gearboxes."""
SIZING = (
    Kernel("sizing.shape_kernel", "reliefs_pass", ("i", "f2", "f2", "f", "b1")),
    Kernel("sizing.shape_kernel", "pin_circles", ("i", "f2", "f1", "f2", "f2", "f2")),
    Kernel("sizing.shape_kernel", "lobed_areas", ("i", "f2", "f1", "f1")),
)
"""What a search calls beside."""


def signature(kernel: Kernel) -> tuple[Any, ...]:
    """The numba types of a kernel's arguments."""
    import numba

    scalars = {"f": numba.float64, "i": numba.int64, "b": numba.boolean}
    known: dict[str, Any] = {}
    for module in kernel.values:
        known |= vars(importlib.import_module(f"cqdd_design.{module}"))

    def typed(one: Any) -> Any:
        if isinstance(one, tuple):
            values = [typed(inner) for inner in one[1:]]
            return numba.types.BaseTuple.from_types(values, known[one[0]])  # type: ignore[no-untyped-call]
        scalar = scalars[one[0]]
        return numba.types.Array(scalar, int(one[1:]), "C") if one[1:] else scalar

    return tuple(typed(one) for one in kernel.arguments)


def missing(
    *, simulation: bool = False, ensembles: bool = False, sizing: bool = False
) -> list[Kernel]:
    """Kernels that no earlier run has left compiled, the longest to compile first."""
    wanted = (
        *(ENSEMBLES if ensembles else ()),
        *GEARBOX[:2],
        *(SIMULATION if simulation else ()),
        *GEARBOX[2:],
        *(SIZING if sizing else ()),
    )
    return [kernel for kernel in wanted if not in_cache(kernel.compiled())]


def kernel_folder() -> Path:
    """Where a compiled kernel is kept; the others are beside their code, or all there."""
    from cqdd_design.files.kernel_cache import KEPT_IN, cache_place

    return Path(KEPT_IN) if KEPT_IN else cache_place(GEARBOX[0].compiled()._cache)


def compile_kernels(
    kernels: list[Kernel], tell: Callable[[int, int], None], design: Design | None = None
) -> None:
    """Compile kernels into the cache, those of a module together.

    Parameters
    ----------
    tell : callable
        Called with how many are done and how many there are, at the start and as each ends. One
        that fails is not told: the command compiles it itself and says why.
    design : Design, optional
        Its discs and ring as elastic bodies, of which no kernel is waited for, are made meanwhile
        and kept for the command.
    """
    beside = Thread(target=_make_bodies, args=(design,), daemon=True)
    with compiling(kernels, tell) as wait:
        beside.start()
        wait()
    beside.join()


def _make_bodies(design: Design | None) -> None:
    # What is wrong with a design the command finds and tells.
    with suppress(CqddError):
        if design is not None:
            from cqdd_design.machine import resolve

            _ = resolve(design).bodies


@contextmanager
def compiling(
    kernels: list[Kernel], tell: Callable[[int, int], None] = lambda done, total: None
) -> Iterator[Callable[[], None]]:
    """Compile kernels beside other work, see `compile_kernels`; what is not done at the end stays.

    Yields
    ------
    callable
        Waits until all are compiled, and alone calls `tell`.
    """
    modules = dict.fromkeys(kernel.module for kernel in kernels)
    left = deque([one.name for one in kernels if one.module == module] for module in modules)
    workers = [_started() for _ in range(min(len(left), os.cpu_count() or 1))]
    ended: SimpleQueue[int] = SimpleQueue()
    threads = [Thread(target=_feed, args=(one, left, ended), daemon=True) for one in workers]
    working = len(workers)

    def wait() -> None:
        nonlocal working
        done = 0
        tell(done, len(kernels))
        while working:
            if count := ended.get():
                done += count
                tell(done, len(kernels))
            else:
                working -= 1

    try:
        for thread in threads:
            thread.start()
        yield wait
    finally:
        for worker in workers:
            worker.kill()
        for worker in workers:
            worker.communicate()


def _started() -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-c", _WORK],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
    )


def _feed(worker: subprocess.Popen[str], left: deque[list[str]], ended: SimpleQueue[int]) -> None:
    """Give a worker names until none are left or it has died; tell how many at a time, then 0."""
    assert worker.stdin is not None
    assert worker.stdout is not None
    with suppress(IndexError, OSError, ValueError):
        while worker.poll() is None:
            names = left.popleft()
            print(*names, file=worker.stdin, flush=True)
            worker.stdout.readline()
            ended.put(len(names))
    ended.put(0)


_WORK = f"from {__name__} import compile_asked; compile_asked()"


_ROOM = 2**17
"""Places for values, of 8 bytes each: Python doubles its pieces from 16 kB until one is enough, and
as much again is then left in it for the frames of what is called."""


def compile_asked() -> None:
    """Compile the kernels whose names come in, a line at a time, and answer each line."""
    # A compiler makes millions of small things and next to no rubbish: a tenth of its time was
    # the collector's. Another fifth went into mapping memory for Python's frames: these stand in
    # pieces of 16 kB, each of which is given back when it is empty, and calls that went up and
    # down over a seam mapped one each time. A frame that claims room for itself brings more.
    gc.disable()
    roomy = FunctionType(_compile_lines.__code__.replace(co_stacksize=_ROOM), globals())
    roomy()


def _compile_lines() -> None:
    # What libraries print goes elsewhere than the answers.
    with os.fdopen(os.dup(1), "w") as answers:
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        for line in sys.stdin:
            names = line.split()
            for kernel in (*GEARBOX, *SIMULATION, *ENSEMBLES, *SIZING):
                if kernel.name in names:
                    kernel.compiled().compile(signature(kernel))
            print(file=answers, flush=True)
