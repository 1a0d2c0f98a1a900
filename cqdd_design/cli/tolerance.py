"""``cqdd-design tolerance``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

from cqdd_design.cli.options import (
    DesignFile,
    NamedMotor,
    OwnMotor,
    option,
    parse_option,
    parse_positive,
    quantity_option,
)
from cqdd_design.cli.session import INTERRUPTED_WITH_RESULTS, Output, read_design
from cqdd_design.cli.tables import folded, number, table
from cqdd_design.terms import term

if TYPE_CHECKING:
    from cqdd_design.gearbox.tolerance.run import ToleranceResult

_MOST_SAMPLES = 10_000_000
_RANKED = 4


def tolerance(
    out: Output,
    design: DesignFile,
    samples: Annotated[int, option("N", "Gearboxes to draw.", min=1, max=_MOST_SAMPLES)] = 1000,
    angles: Annotated[
        int | None,
        option(
            "N",
            "Crank angles over the output turn; default about 1000, two to eight a tooth.",
            min=8,
        ),
    ] = None,
    seed: Annotated[int, option("N", "Of the random draws.", min=0, max=2**64 - 1)] = 0,
    torque: Annotated[
        str | None, quantity_option('Output torque, as in "40 N*m"; default the continuous.')
    ] = None,
    temperature: Annotated[
        str | None,
        quantity_option('Of all parts of the gearbox, as in "60 degC"; default 20 degC, as drawn.'),
    ] = None,
    scheduler: Annotated[
        str | None, option("ADDRESS", "Dask scheduler to work on, as tcp://HOST:8786.")
    ] = None,
    motor: NamedMotor = None,
    motor_file: OwnMotor = None,
) -> int:
    """Toleranced gearboxes over a whole output turn: distributions and ranking."""
    from cqdd_design.roads.tolerance import tolerance as drawn
    from cqdd_design.units import TEMPERATURE, TORQUE

    asked_torque = parse_positive("--torque", torque, TORQUE)
    parts_at = parse_option("--temperature", temperature, TEMPERATURE)
    loaded = read_design(out, design, motor, motor_file)
    if scheduler is None:
        out.compile_ahead(loaded, ensembles=True)
    result = drawn(
        loaded,
        samples=samples,
        torque=asked_torque,
        angles=angles,
        seed=seed,
        temperature=parts_at,
        scheduler=scheduler,
        progress=out.counting("gearboxes"),
    )
    out.say(*_lines(result))
    out.warn(*result.warnings)
    out.document(result.to_dict(), design=loaded)
    return INTERRUPTED_WITH_RESULTS if result.interrupted else 0


def _beside_the_verdict(result: ToleranceResult) -> list[str]:
    """How to draw the gearboxes that the backlash of a verdict is of, where these are others."""
    from cqdd_design.gearbox.checks.allowables import YIELD_SAMPLES

    if (result.asked, result.ensemble.seed) == (YIELD_SAMPLES, 0):
        return []
    return folded(
        f"check, size, bench and report tell the backlash of {YIELD_SAMPLES} gearboxes: "
        f"--samples {YIELD_SAMPLES} --seed 0 draws those"
    )


def _lines(result: ToleranceResult) -> list[str]:
    if not len(result.values):
        return ["no gearbox was finished"]
    statistics = result.statistics()
    columns = ("mean", "std", "p5", "p50", "p95", "p99")
    heads = [f"{name[1:]} %" if name[1:].isdigit() else name for name in columns]
    limits = result.limits
    reserve = result.pressure_reserve()
    shown = statistics | ({"pressure_reserve": reserve} if reserve else {})
    # A reserve is short below 1, everything else beyond its limit.
    known = {name: number(limit) for name, limit in limits.items()} | {"pressure_reserve": "1"}
    rows = [
        [
            f"  {', '.join(part for part in term(name) if part)}",
            *(number(values[column]) for column in columns),
            known.get(name, ""),
        ]
        for name, values in shown.items()
    ]
    lines = [
        *folded(
            f"{len(result.values)} gearboxes over one output turn at "
            f"{number(result.ensemble.torque)} N*m, {result.solves:,} equilibria with friction in "
            f"{result.seconds:.1f} s; 5 % to 99 %: so many of the gearboxes have at most this"
        ),
        *_beside_the_verdict(result),
        "",
        table(rows, head=("", *heads, "limit"), right=tuple(range(1, len(columns) + 2))),
    ]
    if result.sensitivity is None:
        return lines
    ranked = []
    for name in statistics:
        leaders = result.ranking(name)[:_RANKED]
        shares = ", ".join(f"{group} {max(total, 0.0):.0%}" for group, _, total in leaders)
        ranked.append([f"  {term(name).words}", shares])
    return [
        *lines,
        "",
        *folded(
            "which tolerance it comes from (share of the variance, interactions included, so "
            "shares may add up to more than 100 %):"
        ),
        table(ranked),
    ]
