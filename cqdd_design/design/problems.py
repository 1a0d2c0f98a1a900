"""From pydantic's list of errors to sentences for a designer."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from pydantic import BaseModel, ValidationError

from cqdd_design.errors import DesignError, did_you_mean, shown

_MOST_SHOWN, _LONGEST_KEY = 8, 80

#: What a key is when a file leaves it out, where that follows from other keys; these are missing
#: only when those are wrong.
DERIVED_DEFAULTS = {
    "peak_torque": "9 N*m times the ratio, at most 90 N*m",
    "continuous_torque": "0.38 of the peak torque",
    "circle_radius": "0.61 of the ring pitch radius",
    "hole_clocking": "a quarter lobe pitch",
    "outer_diameter": "3 mm of wall outside the teeth",
    "output_pins": "every key at its default",
    "ring": "every key at its default",
    "requirements": "every key at its default",
}


def describe_problems(error: ValidationError, model: type[BaseModel], source: str) -> DesignError:
    """One `DesignError` with a sentence for each problem found.

    Parameters
    ----------
    error : pydantic.ValidationError
        As raised by `model`.
    model : type
        The model that refused, for the names of its keys.
    source : str
        File name, or what to call the input.
    """
    found = _without_consequences(error.errors(include_url=False))
    sentences = [_sentence(item, model) for item in found[:_MOST_SHOWN]]
    if len(found) > _MOST_SHOWN:
        sentences.append(f"and {len(found) - _MOST_SHOWN} more problems")
    return listed(sentences, source)


def listed(sentences: Sequence[str], source: str) -> DesignError:
    """One `DesignError` that tells sentences, each without its last stop, about a file."""
    if len(sentences) == 1:
        return DesignError(f"{source}: {_stopped(sentences[0])}")
    return DesignError(f"{source}:\n" + "\n".join(f"  - {_stopped(text)}" for text in sentences))


def _stopped(sentence: str) -> str:
    """With its last stop, unless it asks."""
    return sentence if sentence.endswith("?") else f"{sentence}."


def _without_consequences(found: list[Any]) -> list[Any]:
    """Drop problems that only follow from others: derived keys missing, one ratio told twice."""
    keys = {tuple(item["loc"]) for item in found}
    kept = []
    for item in found:
        key = tuple(item["loc"])
        derived = item["type"] == "missing" and key[-1] in DERIVED_DEFAULTS
        repeated = key == ("requirements", "ratio") and ("reducer", "ratio") in keys
        if not (derived or repeated):
            kept.append(item)
    return kept or found


def _sentence(item: Any, model: type[BaseModel]) -> str:
    location = tuple(item["loc"])
    key = _short(".".join(str(part) for part in location))
    kind = item["type"]
    if kind == "extra_forbidden":
        known = _known_keys(model, location[:-1])
        hint = did_you_mean(str(location[-1]), known)
        where = _short(_table(location[:-1])) or "the top level"
        return f"{key} is not a key of {where}{hint or '; its keys are ' + ', '.join(known)}"
    if kind == "missing":
        return f"{key} is missing; it has no default"
    if kind == "value_error":
        text = str(item["ctx"]["error"]).removesuffix(".")
        if not location:
            return text
        return (
            f"{key}: {text}"
            if isinstance(item["input"], dict)
            else (f"{key} = {shown(item['input'])}: {text}")
        )
    if kind == "literal_error":
        return f"{key} = {shown(item['input'])} must be {item['ctx']['expected']}"
    if kind in {"model_type", "model_attributes_type", "dict_type"}:
        return f"{key} must be a table, not {shown(item['input'])}"
    expected = item["msg"][0].lower() + item["msg"][1:]
    return f"{key} = {shown(item['input'])}: {expected}"


def _table(location: tuple[Any, ...]) -> str:
    """A table as the file writes it; of a list of tables, which of them."""
    key = ".".join(str(part) for part in location if isinstance(part, str))
    places = [part for part in location if isinstance(part, int)]
    if places:
        return f"table {places[-1] + 1} of [[{key}]]"
    return f"table [{key}]" if key else ""


def _short(key: str) -> str:
    return key if len(key) <= _LONGEST_KEY else f"{key[:_LONGEST_KEY]}..."


def _known_keys(model: type[BaseModel], tables: tuple[Any, ...]) -> list[str]:
    current: Any = model
    for table in tables:
        if isinstance(table, int):  # a place in a list of tables
            continue
        field = current.model_fields.get(table) if hasattr(current, "model_fields") else None
        if field is None:
            return []
        current = field.annotation
        if not hasattr(current, "model_fields"):
            inner = [a for a in getattr(current, "__args__", ()) if hasattr(a, "model_fields")]
            current = inner[0] if inner else None
    fields = getattr(current, "model_fields", {})
    return [field.alias or name for name, field in fields.items()]
