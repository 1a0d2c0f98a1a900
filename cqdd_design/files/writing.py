"""Atomic writing: a file appears whole under its name or not at all."""

from __future__ import annotations

import contextlib
import errno
import hashlib
import os
import stat
import tempfile
import unicodedata
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from cqdd_design.errors import UsageError
from cqdd_design.files.reading import irregular

_SPELT = str.maketrans(
    {"ä": "ae", "ö": "oe", "ü": "ue", "Ä": "Ae", "Ö": "Oe", "Ü": "Ue", "ß": "ss", "ẞ": "SS"}
)


def ascii_text(text: str) -> str:
    """Text for a file that is plain ASCII: umlauts spelt out, other accents left out, else '?'.

    Examples
    --------
    >>> ascii_text("Knie größe, épaule, 膝")
    'Knie groesse, epaule, ?'
    """
    spelt = unicodedata.normalize("NFC", text).translate(_SPELT)
    letters = unicodedata.normalize("NFKD", spelt)
    bare = "".join(c for c in letters if not unicodedata.combining(c))
    return bare.encode("ascii", "replace").decode("ascii")


@dataclass(frozen=True)
class WrittenFile:
    """A file this package has written: what it is, where, how large, and its SHA-256."""

    path: Path
    kind: str
    bytes: int
    sha256: str
    replaced: bool = field(default=False, compare=False)
    """Whether there was a file of that name before."""

    def to_dict(self) -> dict[str, object]:
        """The JSON form of interfaces: path, kind, bytes, sha256."""
        told = vars(self) | {"path": str(self.path)}
        del told["replaced"]
        return told


def _refusal(path: Path, error: OSError) -> UsageError:
    reasons = {
        errno.ENOSPC: "the disk is full; free some space or choose another folder with --out",
        errno.EACCES: "the folder is not writable; choose another with --out",
        errno.EPERM: "the folder is not writable; choose another with --out",
        errno.EROFS: "the file system is read-only; choose another folder with --out",
        errno.ENOTDIR: "a part of the path is a file, not a folder; choose another with --out",
        errno.EEXIST: "a file stands where a folder is needed; choose another with --out",
        errno.EISDIR: "a folder of that name exists; choose another name with --out",
    }
    number = error.errno or 0
    reason = reasons.get(number, f"{error.strerror or error}; choose another place with --out")
    return UsageError(f"cannot write {path}: {reason}.")


def ensure_folder(folder: Path) -> Path:
    """Create `folder` and its parents, or raise a `UsageError` that says why not."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise _refusal(folder, error) from error
    return folder


def refuse_overwrite(path: Path, *, force: bool) -> None:
    """Raise a `UsageError` when `path` exists and `force` is not set.

    What is no file (a folder, a device, a pipe) is not replaced with `force` either, nor a link
    to one or to nothing; through a link to a file, that file is replaced.
    """
    _replaceable(path)
    if path.exists() and not force:
        raise UsageError(
            f"{path} exists already; add --force to replace it or choose another --out."
        )


def kind_by_ending(path: Path, kinds: Sequence[str], stem: str, asked: str = "") -> str:
    """Kind of a file by its ending, of those that are written.

    Parameters
    ----------
    kinds : sequence of str
        Endings without their dot.
    stem : str
        A name for a path that has none but an ending.
    asked : str
        The kind to name; default the first.

    Raises
    ------
    UsageError
        For another ending, with the nearest name: what a file holds is what it is called.
    """
    kind = path.suffix.lower().removeprefix(".")
    if kind in kinds:
        return kind
    nearest = path.parent / f"{path.stem or stem}.{asked or kinds[0]}"
    endings = [f".{one}" for one in kinds]
    told = f"does not end in {endings[0]}"
    if endings[1:]:
        told = f"ends neither in {' nor in '.join(endings)}"
    raise UsageError(f"{path} {told}; name it {nearest}.")


def _replaceable(path: Path) -> Path:
    """The regular file, standing or to be, that is meant by `path`: the end of a link."""
    try:
        mode = os.stat(path).st_mode
    except OSError as error:
        if path.is_symlink():
            raise UsageError(
                f"cannot write {path}: it is a link to {os.readlink(path)}, which does not exist; "
                "remove it or choose another name with --out."
            ) from None
        if isinstance(error, FileNotFoundError):
            return path
        raise _refusal(path, error) from error
    if not stat.S_ISREG(mode):
        raise UsageError(
            f"cannot write {path}: it is {irregular(mode)}, which is never replaced; "
            "choose another name with --out."
        )
    return path.resolve() if path.is_symlink() else path


@contextlib.contextmanager
def atomic_path(path: Path) -> Iterator[Path]:
    """Yield a temporary path beside `path`; rename it into place when the block succeeds.

    For writers that insist on opening the file themselves. The temporary name keeps the suffix,
    because several CAD writers choose their format by it. On any error nothing is left behind.
    A link is followed, and what is no file is refused.
    """
    path = _replaceable(path)
    ensure_folder(path.parent)
    try:
        handle, name = tempfile.mkstemp(
            prefix=f".{path.stem}-", suffix=path.suffix, dir=path.parent
        )
        os.close(handle)
    except OSError as error:
        raise _refusal(path, error) from error
    temporary = Path(name)
    try:
        yield temporary
        os.chmod(temporary, 0o666 & ~_umask())
        os.replace(temporary, path)
    except OSError as error:
        raise _refusal(path, error) from error
    finally:
        temporary.unlink(missing_ok=True)


def write_atomically(path: Path, content: bytes | str, kind: str) -> WrittenFile:
    """Write `content` to `path` in one step and describe the result.

    Parameters
    ----------
    path : Path
        Destination; its folder is created.
    content : bytes or str
        Text is encoded as UTF-8.
    kind : str
        What the file is, for the list of files ("dxf", "report", ...).

    Raises
    ------
    UsageError
        When the place is not writable or the disk is full; nothing half-written stays.
    """
    data = content.encode("utf-8") if isinstance(content, str) else content
    return write_with(path, kind, lambda temporary: temporary.write_bytes(data))


def write_with(path: Path, kind: str, writer: Callable[[Path], object]) -> WrittenFile:
    """Let `writer(temporary_path)` write the file, then put it in place atomically."""
    before = path.exists()
    with atomic_path(path) as temporary:
        writer(temporary)
    data = path.read_bytes()
    return WrittenFile(path, kind, len(data), hashlib.sha256(data).hexdigest(), before)


def _umask() -> int:
    value = os.umask(0)
    os.umask(value)
    return value
