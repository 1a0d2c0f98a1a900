"""Design files that `size` writes: their stamp, and remarks that only a search can make."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from pathlib import Path

from cqdd_design.design import Design, load_design, save_design
from cqdd_design.errors import UsageError
from cqdd_design.files import WrittenFile, write_with
from cqdd_design.sizing.result import Cost

_SCREENED = "# No verdict has seen this design: closed forms alone chose it, see `check`.\n"
"""First line of what the screen alone writes."""
STAMP = "# `size` replaces this file only while the lines above have this sha256: "
_COSTS, _COST = "# What more would cost:", "# - "


def write_fresh(
    path: Path,
    design: Design,
    origins: Mapping[str, str],
    costs: Sequence[Cost],
    *,
    judged: bool,
) -> WrittenFile:
    """Write a design file anew, with its stamp: a former one leaves no comments behind.

    Parameters
    ----------
    origins : mapping
        Where values come from, by dotted key.
    costs : sequence of Cost
        What more would cost, as far as the search told.
    judged : bool
        Whether a verdict has seen the design.
    """

    def write(temporary: Path) -> None:
        temporary.unlink()
        save_design(temporary, design, comments=origins)
        first = "" if judged else _SCREENED
        last = "".join([f"{_COSTS}\n", *(f"{_COST}{one.told}\n" for one in costs)])
        content = first.encode() + temporary.read_bytes() + (last if costs else "").encode()
        temporary.write_bytes(content + f"{STAMP}{_digest(content)}\n".encode())

    return write_with(path, "design", write)


def refuse_edited(path: Path) -> None:
    """Raise where a file of this name holds work that is not `size`'s own."""
    content = _content(path)
    if content is not None and _own(content) is None:
        raise UsageError(
            f"{path} has been edited since `size` wrote it; add --force to replace it, or choose "
            "another place with --out."
        )


def refuse_judged(path: Path) -> None:
    """Raise where a file of this name holds a design that the whole search has judged."""
    if path.exists() and not path.read_bytes().startswith(_SCREENED.encode()):
        raise UsageError(
            f"{path} was written by a search to the verdict, and the screen alone would replace it "
            "by a design that nothing has judged; choose another place with --out, or add --force."
        )


def kept_costs(path: Path, design: Design) -> tuple[str, ...]:
    """What more would cost, as `size` noted it in its file.

    None where the file was edited since, or where `design` is not its own: with another motor or
    another duty, say.
    """
    content = _content(path)
    own = None if content is None else _own(content)
    if own is None or load_design(path).sha256 != design.sha256:
        return ()
    _, _, told = own.decode().partition(f"{_COSTS}\n")
    return tuple(line.removeprefix(_COST) for line in told.splitlines())


def _content(path: Path) -> bytes | None:
    try:
        return path.read_bytes()
    except FileNotFoundError:
        return None
    except OSError as error:
        raise UsageError(f"cannot read {path}: {error.strerror}.") from error


def _own(content: bytes) -> bytes | None:
    """What stands above the stamp; None where the stamp is not that of it."""
    above, stamp, told = content.rpartition(STAMP.encode())
    return above if stamp and told.strip() == _digest(above).encode() else None


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()
