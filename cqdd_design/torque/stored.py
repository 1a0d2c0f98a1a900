"""What the JSON of stored networks, checkpoints and data sets must look like.

A file from elsewhere may say anything. What is read from one is checked here, once, for kind and
range; what nothing reads may be anything. Machines that only train have no pydantic, so the rules
are functions: each returns the place and the value of the first thing that is wrong, or None.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping

from cqdd_design.errors import UsageError, is_unprintable, shown

Problem = tuple[str, object] | None
Rule = Callable[[object], Problem]

_FEATURE = re.compile(
    r"position_error|velocity|acceleration|balance|friction_sign|ripple|(sin|cos)_[1-9][0-9]{0,3}"
)
_LONGEST_NAME, _LONGEST_TEXT = 200, 100_000


def _rule(holds: Callable[[object], bool]) -> Rule:
    return lambda value: None if holds(value) else ("", value)


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def _is_whole(value: object, least: int, most: int) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and least <= value <= most


def _is_name(value: object) -> bool:
    """Text that becomes part of file names and of reports."""
    return (
        isinstance(value, str)
        and 0 < len(value) <= _LONGEST_NAME
        and bool(value.strip(" ."))
        and not any(c in "/\\:" or is_unprintable(c) for c in value)
    )


def whole(least: int = 0, most: int = 2**63 - 1) -> Rule:
    """A whole number."""
    return _rule(lambda value: _is_whole(value, least, most))


def one_of(*values: str) -> Rule:
    """One of a few words."""
    return _rule(lambda value: isinstance(value, str) and value in values)


anything = _rule(lambda value: True)
number = _rule(_is_number)
positive = _rule(lambda value: _is_number(value) and value > 0)  # type: ignore[operator]
not_negative = _rule(lambda value: _is_number(value) and value >= 0)  # type: ignore[operator]
name = _rule(_is_name)
text = _rule(lambda value: isinstance(value, str) and len(value) <= _LONGEST_TEXT)
yes_or_no = _rule(lambda value: isinstance(value, bool))
feature = _rule(lambda value: isinstance(value, str) and _FEATURE.fullmatch(value) is not None)


def maybe(rule: Rule) -> Rule:
    """A rule that null meets too."""
    return lambda value: None if value is None else rule(value)


def either(first: Rule, second: Rule) -> Rule:
    """One rule or the other."""
    return lambda value: first(value) and second(value)


def list_of(rule: Rule, least: int = 0, most: int = 10_000_000) -> Rule:
    """A list, every entry of which meets a rule."""

    def check(value: object) -> Problem:
        if not isinstance(value, list | tuple) or not least <= len(value) <= most:
            return "", value
        return _first((str(place), rule(one)) for place, one in enumerate(value))

    return check


def table_of(rule: Rule) -> Rule:
    """A table, every value of which meets a rule."""

    def check(value: object) -> Problem:
        if not isinstance(value, Mapping):
            return "", value
        return _first((str(key)[:40], rule(one)) for key, one in value.items())

    return check


def table(
    needed: Mapping[str, Rule], more: Mapping[str, Rule] | None = None, *, closed: bool = False
) -> Rule:
    """A table with keys that it needs, keys that it may have, and others unless `closed`."""
    known = {**needed, **(more or {})}

    def check(value: object) -> Problem:
        if not isinstance(value, Mapping):
            return "", value
        for key in needed:
            if key not in value:
                return key, None
        for key in value:
            if closed and key not in known:
                return str(key)[:40], value[key]
        return _first((key, rule(value[key])) for key, rule in known.items() if key in value)

    return check


def _first(found: object) -> Problem:
    for place, problem in found:  # type: ignore[attr-defined]
        if problem is not None:
            return ".".join(part for part in (place, problem[0]) if part), problem[1]
    return None


_PENDULUM = table(
    dict.fromkeys(("gravity", "bar_gravity_moment", "hanging_angle"), number)
    | dict.fromkeys(("bar_inertia", "viscous"), not_negative),
    {
        "wall": maybe(
            table(
                {
                    "stiffness": not_negative,
                    "exponent": positive,
                    "damping": not_negative,
                    "side": either(whole(1, 1), whole(-1, -1)),
                }
            )
        )
    },
)
CHOICE = table({"activation": text, "peak": positive}, {"weight_decay": not_negative}, closed=True)
#: Those facts of a network, a training or a data set that something reads.
FACTS = table(
    {},
    {
        "design": text,
        "design_sha256": maybe(text),
        "data_sha256": maybe(text),
        "seed": maybe(whole()),
        "training_gearbox": maybe(whole()),
        "held_mass_kg": maybe(number),
        "supply_voltage_V": maybe(positive),
        "gearbox_ripple_Nm": maybe(not_negative),
        "calibration": maybe(table_of(positive)),
        "infeasible": table_of(anything),
        "pendulum": maybe(_PENDULUM),
        "split": maybe(
            table(
                {"protocol": name},
                {"seed": whole()} | dict.fromkeys(("train", "validation", "test"), list_of(name)),
            )
        ),
        "choice": maybe(CHOICE),
        "actuator": maybe(table_of(anything)),
        "label_range_Nm": maybe(list_of(number, 2, 2)),
        "speed_range_rad_per_s": maybe(list_of(number, 2, 2)),
        "signals_filter": maybe(
            table({"filter_frequency_Hz": positive, "filter_damping_ratio": positive})
        ),
        "validation_rmse_Nm": maybe(not_negative),
        "training_rmse_Nm": maybe(not_negative),
        "leaked_rmse_Nm": maybe(not_negative),
        "updates": whole(),
    },
)
NETWORK = table(
    {
        "name": name,
        "family": one_of("gru", "mlp"),
        "inputs": list_of(feature, 1, 1000),
        "history": whole(1, 10_000),
        "mode": one_of("window", "streaming"),
        "layers": whole(1, 100),
        "hidden": whole(1, 10_000),
        "activation": one_of("", "relu", "tanh", "softsign", "elu"),
        "input_mean": list_of(number),
        "input_std": list_of(positive),
        "torque_mean": number,
        "torque_std": positive,
        "residual": yes_or_no,
        "validity": table(
            {
                "dt": positive,
                "position_gain": not_negative,
                "velocity_gain": not_negative,
                "torque_range": list_of(number, 2, 2),
            },
            closed=True,
        ),
        "differentiator": maybe(
            table({"taps": list_of(number, 2, 64), "delay": number}, closed=True)
        ),
        "facts": FACTS,
    },
    {"format": text},
    closed=True,
)
CHECKPOINT = table(
    {
        "identity": table_of(anything),
        "epoch": whole(0, 10**9),
        "step": whole(0, 10**12),
        "best_rmse": maybe(not_negative),
        "log": list_of(
            table(
                {"epoch": whole()}
                | dict.fromkeys(("training_rmse_Nm", "validation_rmse_Nm", "seconds"), not_negative)
            )
        ),
        "random_state": table_of(whole()),
        "facts": FACTS,
    },
    {"format": text},
    closed=True,
)
MANIFEST = table(
    {
        "dt_s": positive,
        "position_gain_Nm_per_rad": not_negative,
        "velocity_gain_Nms_per_rad": not_negative,
        "torque_range_Nm": list_of(number, 2, 2),
        "facts": FACTS,
        "episodes": list_of(table({"name": name, "group": table_of(either(number, text))}), 1),
    }
)


def require(rule: Rule, content: object, source: str, advice: str) -> None:
    """Raise a `UsageError` where a document does not meet a rule, naming the first wrong field.

    The sentence begins with its source, the file, and ends with an advice.
    """
    problem = rule(content)
    if problem is not None:
        place, value = problem
        told = "is missing or null" if value is None else f"is {shown(value)}"
        raise UsageError(f"{source}: {place or 'it'} {told}, which cannot be; {advice}.")
