"""JSON schema of design files, for editors and for programs that write designs."""

from __future__ import annotations

from typing import Any

from cqdd_design.design.model import Design
from cqdd_design.design.problems import DERIVED_DEFAULTS

_DIALECT = "https://json-schema.org/draft/2020-12/schema"


def design_schema() -> dict[str, Any]:
    """The JSON schema (draft 2020-12) of a design file.

    It describes the file as a person may write it: keys whose default follows from others, such
    as the torques or the pin circle, are not required there although the resolved design always
    has them. Quantities are strings with their unit; bounds and their reasons stand in the
    descriptions, because a schema cannot compare quantities.

    Returns
    -------
    dict
        Ready for ``json.dumps``.
    """
    schema = Design.model_json_schema()
    for table in (schema, *schema["$defs"].values()):
        # Examples of the docstring are Python, which no editor of a design file wants.
        table["description"] = table.get("description", "").partition("\n\nExamples")[0]
        table["required"] = [
            key for key in table.get("required", ()) if key not in DERIVED_DEFAULTS
        ]
        for key, field in table["properties"].items():
            _without_null(field)
            names = _catalogue_names(table["title"], key)
            if names:
                field["examples"] = names
            if key in DERIVED_DEFAULTS and "default" not in field:
                told = field.get("description", "")
                default = f"default: {DERIVED_DEFAULTS[key]}"
                field["description"] = f"{told}; {default}" if told else default
    # The one key that requirements need, the ratio, is taken from the reducer.
    schema["$defs"]["Requirements"]["required"] = []
    return {"$schema": _DIALECT, "$comment": "Written by `cqdd-design schema`.", **schema}


def _without_null(field: dict[str, Any]) -> None:
    """Take from a key that may be left out the null that stands for that: TOML has none."""
    default = field.get("default", "")
    if default is None:
        del field["default"]
    elif isinstance(default, dict):
        field["default"] = {key: value for key, value in default.items() if value is not None}
    kinds = field.get("anyOf", [])
    if {"type": "null"} in kinds:
        del field["anyOf"]
        field.update(next(kind for kind in kinds if kind != {"type": "null"}))


def _catalogue_names(table: str, key: str) -> list[str]:
    """Names an editor may offer for a key, or none."""
    from cqdd_design.catalog import bearings, materials, motors

    if key == "material" or key.endswith("_material"):
        return list(materials())
    if (key == "motor" and table == "Requirements") or (
        key in ("name", "based_on") and table == "MotorTable"
    ):
        return [name for name, one in motors().items() if one.torque_at == "motor"]
    return ["auto", *bearings()] if key == "designation" else []
