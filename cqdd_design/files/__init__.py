"""Files: read within bounds, written whole or not at all."""

from cqdd_design.files.arrays import read_arrays
from cqdd_design.files.labels import file_label
from cqdd_design.files.parsing import parse_json, parse_toml, refuse_extremes
from cqdd_design.files.reading import open_regular_file, read_regular_file, read_text_file
from cqdd_design.files.writing import (
    WrittenFile,
    ascii_text,
    atomic_path,
    ensure_folder,
    kind_by_ending,
    refuse_overwrite,
    write_atomically,
    write_with,
)

__all__ = [
    "WrittenFile",
    "ascii_text",
    "atomic_path",
    "ensure_folder",
    "file_label",
    "kind_by_ending",
    "open_regular_file",
    "parse_json",
    "parse_toml",
    "read_arrays",
    "read_regular_file",
    "read_text_file",
    "refuse_extremes",
    "refuse_overwrite",
    "write_atomically",
    "write_with",
]
