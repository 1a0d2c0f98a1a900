"""The folder in which an export is made before it is put in place, and what a killed one left.

A staging folder is locked by the process that fills it, and the system takes the lock back when
that process ends, however it ends. So an unlocked one belongs to nobody.
"""

from __future__ import annotations

import contextlib
import os
import re
import shutil
import uuid
from collections.abc import Iterator
from pathlib import Path

from cqdd_design.errors import UsageError
from cqdd_design.files import ensure_folder


@contextlib.contextmanager
def staging_folder(target: Path, name: str) -> Iterator[Path]:
    """Make a folder in `target` and remove it at the end, and those of killed runs before.

    Parameters
    ----------
    target : Path
        Where files will be put; made if missing.
    name : str
        Of the design.

    Raises
    ------
    UsageError
        When the place cannot be written.
    """
    ensure_folder(target)
    _remove_abandoned(target, name)
    staging = target / f".{name}-{uuid.uuid4().hex[:8]}"
    lock = None
    try:
        lock = _make(staging)
        yield staging
    except UsageError as error:
        # Writers know only the staging folder, readers of the message only the target.
        raise type(error)(str(error).replace(str(staging), str(target))) from error
    finally:
        shutil.rmtree(staging, ignore_errors=True)
        _unlock(lock)


def _make(staging: Path) -> int | None:
    """Make a folder, and return its lock."""
    while True:
        ensure_folder(staging)
        lock = _lock(staging)
        if staging.exists():
            return lock
        _unlock(lock)  # another export found it between its making and its locking


def _remove_abandoned(target: Path, name: str) -> None:
    own = re.compile(rf"\.{re.escape(name)}-[0-9a-f]{{8}}")
    for folder in target.glob(".*"):
        if own.fullmatch(folder.name) and folder.is_dir() and not folder.is_symlink():
            lock = _lock(folder)
            if lock is not None:
                shutil.rmtree(folder, ignore_errors=True)
                _unlock(lock)


def _lock(folder: Path) -> int | None:
    """Lock a folder; None where another process has, or the system has no such locks."""
    try:
        import fcntl
    except ImportError:  # Windows: what a killed run left stays
        return None
    handle = None
    try:
        handle = os.open(folder, os.O_RDONLY)
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        _unlock(handle)
        return None
    return handle


def _unlock(lock: int | None) -> None:
    if lock is not None:
        os.close(lock)
