"""Where the closer models of a report say less than is asked, to stand beside its first line."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from cqdd_design.report.ink.numbers import significant, with_unit
from cqdd_design.report.input import ReportInput


class Shortfall(NamedTuple):
    """What is asked and not reached, with its units; the model; the section that shows it."""

    what: str
    found: str
    asked: str
    model: str
    section: str

    @property
    def sentence(self) -> str:
        """All of it in one, as a warning."""
        return f"{self.what}: {self.found} of the {self.asked} asked ({self.model})."


def shortfalls(results: ReportInput) -> tuple[Shortfall, ...]:
    """Requirements that contact equilibrium, life, ensemble or test bench find not to be met."""
    return (*_torques(results), *_lives(results), *_ensemble(results), *_bench(results))


def _torques(results: ReportInput) -> Iterator[Shortfall]:
    """The least limit of each load."""
    for load in ("peak", "continuous"):
        limits = [one for one in results.planetary.cycloid if one.load == load]
        least = min(limits, key=lambda one: one.torque_capacity, default=None)
        if least is not None and not least.holds:
            yield Shortfall(
                f"{least.part}: {least.title}",
                with_unit(least.torque_capacity, "N*m", 3),
                with_unit(least.torque, "N*m"),
                least.model,
                "planetary",
            )


def _lives(results: ReportInput) -> Iterator[Shortfall]:
    if results.contact is None:
        return
    life = results.contact.life
    asked = with_unit(life.required_hours, "h")
    for part in life.parts:
        if not part.lasts(life.required_hours):
            yield Shortfall(
                f"life of the {part.part}",
                "unknown" if part.hours is None else with_unit(part.hours, "h", 3),
                asked,
                "fatigue over the duty, by the contact equilibrium",
                "life",
            )
    cam = life.cam
    unknown = cam.hours is None and cam.speed > 0.0
    if unknown or (cam.set_hours is not None and cam.set_hours < life.required_hours):
        yield Shortfall(
            "life of the cam bearings together",
            "unknown" if cam.set_hours is None else with_unit(cam.set_hours, "h", 3),
            asked,
            "basic rating life over the duty, by the contact equilibrium",
            "life",
        )
    for runner in life.runners:
        if not runner.lasts(life.required_hours):
            yield Shortfall(
                f"life of the {runner.name} on their pins",
                "unknown" if runner.set_hours is None else with_unit(runner.set_hours, "h", 3),
                asked,
                "basic rating life over the duty, by the contact equilibrium",
                "life",
            )


def _ensemble(results: ReportInput) -> Iterator[Shortfall]:
    """What part errors make of it: gearboxes that bind, and pressures that do not last."""
    drawn = results.tolerance
    if drawn is None or not len(drawn.values):
        return
    model = f"{len(drawn.values)} gearboxes drawn from the tolerances"
    bind = drawn.beyond()["unloaded_torque_Nm"]
    if bind > 0.0:
        yield Shortfall(
            "toleranced gearboxes that do not bind without load",
            f"{100.0 * (1.0 - bind):.1f}\u202f%",
            "100\u202f%",
            model,
            "tolerances",
        )
    reserve = drawn.pressure_reserve()
    if reserve is not None and reserve["p50"] < 1.0:
        yield Shortfall(
            "reserve of pressure at the required hours, median of toleranced gearboxes",
            significant(reserve["p50"], 3),
            "1",
            model,
            "tolerances",
        )


def _bench(results: ReportInput) -> Iterator[Shortfall]:
    if results.bench is None:
        return
    bench, requirements = results.bench[1], results.design.requirements
    for name, asked in (
        ("peak_torque", requirements.peak_torque),
        ("continuous_torque", requirements.continuous_torque),
    ):
        found = bench.value(name)
        if found is not None and found < asked:
            yield Shortfall(
                f"{name.replace('_', ' ')} of motor and driver",
                with_unit(found, "N*m", 3),
                with_unit(asked, "N*m"),
                "test bench",
                "bench",
            )
