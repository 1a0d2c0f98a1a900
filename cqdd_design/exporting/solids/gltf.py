"""Binary glTF 2.0, as every file of it needs: the container, and the material of a part."""

from __future__ import annotations

import json
import struct
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from cqdd_design.solids.part import Part


def container(document: Mapping[str, Any], binary: bytes) -> bytes:
    """The file of a document and its one buffer, each filled up to a multiple of 4 bytes."""
    text = json.dumps(document, separators=(",", ":"), allow_nan=False).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    total = 12 + 8 + len(text) + 8 + len(binary)
    return b"".join(
        [
            struct.pack("<4sII", b"glTF", 2, total),
            struct.pack("<I4s", len(text), b"JSON"),
            text,
            struct.pack("<I4s", len(binary), b"BIN\0"),
            binary,
        ]
    )


def material(part: Part, metalness: float, roughness: float) -> dict[str, Any]:
    """A part's material in its colour."""
    # glTF colours are linear; those of the parts are sRGB (IEC 61966-2-1).
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in part.colour]
    return {
        "name": part.material,
        "pbrMetallicRoughness": {
            "baseColorFactor": [*(round(value, 6) for value in linear), 1.0],
            "metallicFactor": metalness,
            "roughnessFactor": roughness,
        },
    }
