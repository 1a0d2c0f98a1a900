"""The JSON document of a command or a call: one shape for all, and for every error."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from cqdd_design.errors import UsageError
from cqdd_design.roads.telling import provenance

if TYPE_CHECKING:
    from cqdd_design.design import Design
    from cqdd_design.files import WrittenFile
    from cqdd_design.results import Check, Provenance

#: Changes only when a fixed key changes its meaning.
ENVELOPE_VERSION = 1


def result_document(
    command: str,
    results: Mapping[str, Any],
    *,
    design: Design | None,
    checks: Sequence[Check],
    warnings: Sequence[str],
    files: Sequence[WrittenFile],
) -> str:
    """The document of a command that did its work."""
    told = result_body(
        command,
        results,
        design=design,
        checks=checks,
        warnings=warnings,
        files=files,
        origin=provenance(design),
    )
    return _text(told)


def result_body(
    command: str,
    results: Mapping[str, Any],
    *,
    design: Design | None,
    checks: Sequence[Check],
    warnings: Sequence[str],
    files: Sequence[WrittenFile],
    origin: Provenance,
) -> dict[str, Any]:
    """The same before it is text: plain values of JSON."""
    told = list(warnings)
    body = _body(command, design, origin)
    body["results"] = json_ready(results, "results", told)
    body["checks"] = json_ready([check.to_dict() for check in checks], "checks", told)
    body["files"] = [file.to_dict() for file in files]
    body["warnings"] = told
    return body


def error_document(
    command: str | None, code: int, kind: str, message: str, details: Mapping[str, Any]
) -> str:
    """The document of a command that failed: the same keys, and `error`."""
    try:
        origin = provenance(None)
    except UsageError:  # a nonsense SOURCE_DATE_EPOCH, which is the error that is told here
        origin = None
    body = _body(command, None, origin)
    body["error"] = {
        "code": code,
        "kind": kind,
        "message": message,
        "details": json_ready(details, "error.details", body["warnings"]),
    }
    return _text(body)


def json_ready(value: Any, where: str, warnings: list[str]) -> Any:
    """Plain JSON values of nested mappings, sequences, arrays and numpy scalars.

    Parameters
    ----------
    value : object
        What a library call returned.
    where : str
        Its dotted key, for warnings.
    warnings : list of str
        Extended by one sentence for each number that is not finite; such a number becomes null.
    """
    if value is None or isinstance(value, (str, bool, int)):
        return value
    if isinstance(value, float):
        if math.isfinite(value):
            return value
        warnings.append(f"{where} does not exist for this design (it came out as {value}).")
        return None
    if isinstance(value, Mapping):
        return {str(key): json_ready(v, f"{where}.{key}", warnings) for key, v in value.items()}
    if isinstance(value, Path):
        return str(value)
    if hasattr(value, "tolist"):  # numpy arrays and scalars
        return json_ready(value.tolist(), where, warnings)
    if isinstance(value, (list, tuple)):
        return [json_ready(item, f"{where}[{i}]", warnings) for i, item in enumerate(value)]
    raise TypeError(f"{where} is a {type(value).__name__}, which has no JSON form")


def _body(command: str | None, design: Design | None, origin: Provenance | None) -> dict[str, Any]:
    return {
        "schema_version": ENVELOPE_VERSION,
        "command": command,
        "design": None if design is None else design.to_mapping(),
        "assumed": [] if design is None else list(design.assumed),
        "results": None,
        "checks": [],
        "warnings": [],
        "files": [],
        "provenance": None if origin is None else origin.to_dict(),
    }


def _text(body: Mapping[str, Any]) -> str:
    return json.dumps(body, allow_nan=False, indent=1)
