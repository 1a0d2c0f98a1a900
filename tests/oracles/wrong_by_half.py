"""Functions of the package, wrong by half for a while: what claims to test them must turn red."""

from __future__ import annotations

import functools
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import fields, is_dataclass, replace
from typing import Any

import numpy as np

FACTOR = 1.5

Exercised = Callable[..., Any] | property | functools.cached_property  # type: ignore[type-arg]


@contextmanager
def wrong_by_half(exercised: Exercised, part: str = "") -> Iterator[None]:
    """Whoever calls a function, method or property gets 1.5 times its result.

    The name is exchanged in its class, or in every loaded module that holds it; compiled kernels,
    which hold no names, keep what they were compiled with. Of a result with many fields only one
    `part` may be wrong, such as ``ring_force`` or ``ledger.copper``.
    """
    plain = _function(exercised)
    if "." in plain.__qualname__:
        owner = plain.__qualname__.split(".")[0]
        holders: list[Any] = [getattr(sys.modules[plain.__module__], owner)]
    else:
        holders = list(sys.modules.values())
    found = [(h, n) for h in holders for n, value in _names(h) if value is exercised]
    assert found, f"nobody holds {name_of(exercised)}"
    wrong = _wrong(exercised, plain, part)
    try:
        for holder, name in found:
            setattr(holder, name, wrong)
            if isinstance(wrong, functools.cached_property):
                wrong.__set_name__(holder, name)
        yield
    finally:
        for holder, name in found:
            setattr(holder, name, exercised)


def _names(holder: Any) -> list[tuple[str, Any]]:
    return list(getattr(holder, "__dict__", {}).items())


def name_of(exercised: Exercised) -> str:
    """Where a function stands, from the room on: ``gearbox.rigid.ring_forces``."""
    plain = _function(exercised)
    return f"{plain.__module__}.{plain.__qualname__}".removeprefix("cqdd_design.")


def _function(exercised: Exercised) -> Any:
    if isinstance(exercised, property):
        return exercised.fget
    return exercised.func if isinstance(exercised, functools.cached_property) else exercised


def _wrong(exercised: Exercised, plain: Callable[..., Any], part: str) -> Any:
    @functools.wraps(plain)
    def scaled(*arguments: Any, **named: Any) -> Any:
        return _scaled_at(plain(*arguments, **named), part)

    if isinstance(exercised, property):
        return property(scaled)
    return functools.cached_property(scaled) if exercised is not plain else scaled


def _scaled_at(value: Any, part: str) -> Any:
    if not part:
        return _scaled(value)
    head, _, rest = part.partition(".")
    changed = {head: _scaled_at(getattr(value, head), rest)}
    return value._replace(**changed) if hasattr(value, "_replace") else replace(value, **changed)


def _scaled(value: Any) -> Any:
    """1.5 times every number in a result; counts, names and models stay."""
    if isinstance(value, float | np.floating):
        return FACTOR * value
    if isinstance(value, np.ndarray) and value.dtype.kind in "fc":
        return FACTOR * value
    if isinstance(value, list):
        return [_scaled(part) for part in value]
    if isinstance(value, tuple):
        parts = [_scaled(part) for part in value]
        return value._make(parts) if hasattr(value, "_make") else tuple(parts)
    if is_dataclass(value) and not isinstance(value, type):
        own = {f.name: getattr(value, f.name) for f in fields(value) if f.init}
        numbers = {k: v for k, v in own.items() if isinstance(v, float | np.ndarray)}
        return replace(value, **{key: _scaled(one) for key, one in numbers.items()})
    return value
