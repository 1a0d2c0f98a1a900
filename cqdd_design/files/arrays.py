"""Arrays from an ``.npz`` of elsewhere: sizes are checked before memory is asked for.

numpy believes what a header says: one of 2^40 doubles takes the machine's memory, and a damaged
one ends in any of a dozen errors. Here a file is numbers and one JSON text, or it is refused.
"""

from __future__ import annotations

import math
import zipfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

from cqdd_design.errors import UsageError
from cqdd_design.files.parsing import parse_json
from cqdd_design.files.reading import open_regular_file

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

_METADATA = "metadata"
_MOST_ENTRIES = 100_000
#: Bytes of the metadata; four for each character.
_MOST_TEXT = 64_000_000


def read_arrays(path: Path, most: int, wanted: str) -> tuple[dict[str, NDArray[Any]], Any]:
    """The arrays of an ``.npz`` by name, and the content of its JSON text ``metadata``.

    Parameters
    ----------
    path : Path
        A zip of ``.npy`` of floats and whole numbers, without pickles, which are never read.
    most : int
        The most bytes of all arrays, unpacked.
    wanted : str
        What it should be, and who writes one: the end of the message.

    Raises
    ------
    UsageError
        When it cannot be read, or is anything else.
    """
    arrays: dict[str, NDArray[Any]] = {}
    with open_regular_file(path) as stream:
        try:
            with zipfile.ZipFile(stream) as archive:
                entries = archive.infolist()
                if len(entries) > _MOST_ENTRIES or sum(one.file_size for one in entries) > most:
                    raise _Refused(f"it holds more than {most / 1e6:g} MB")
                for one in entries:
                    name = one.filename.removesuffix(".npy")
                    with archive.open(one) as member:
                        arrays[name] = _array(member, one.file_size, text=name == _METADATA)
        except _Refused as error:
            raise UsageError(f"{path} is not {wanted} ({error}).") from error
        except Exception as error:  # zip, zlib and numpy have a dozen kinds for a damaged file
            raise UsageError(f"{path} is not {wanted}.") from error
    if _METADATA not in arrays:
        raise UsageError(f"{path} has no metadata; it is not {wanted}.")
    return arrays, parse_json(str(arrays.pop(_METADATA)), path)


class _Refused(Exception):
    """Why an archive is not read."""


def _array(member: Any, size: int, *, text: bool) -> NDArray[np.generic]:
    """One ``.npy`` of `size` bytes, whose header has to agree with them."""
    import numpy as np
    from numpy.lib import format as npy

    version = npy.read_magic(member)
    read = npy.read_array_header_1_0 if version == (1, 0) else npy.read_array_header_2_0
    shape, in_columns, kind = read(member)
    if kind.kind not in ("U" if text else "fiu") or kind.itemsize == 0:
        raise _Refused(f"an array of {kind}, where " + ("text" if text else "numbers") + " belong")
    needed = math.prod(shape) * kind.itemsize
    if min(shape, default=0) < 0 or member.tell() + needed != size:
        raise _Refused(f"a header of {math.prod(shape)} values over {size} bytes")
    if text and (shape or size > _MOST_TEXT):
        raise _Refused("metadata that are not one text")
    found = np.frombuffer(member.read(needed), kind)
    ordered = found.reshape(shape, order="F" if in_columns else "C")
    return ordered.astype(kind.newbyteorder("="), order="C")
