"""What docs/measured.md sets side by side: a thesis' printed actuator, and the toolkit's own.

The records are J. V.'s, "Anti-Backlash Mechanisms for Cost-Effective Cycloidal Drive Robotic
Actuators: Design and Evaluation", MSc thesis, University of Twente (2024), repository
JelmerV/Anti-Backlash-Cycloidal-Actuator, CC BY-SA 4.0. They stand beside the project, never in it;
only what is read off them is printed. Where they are not there, nothing of them is compared.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np

from cqdd_design.actuator.bench.calibrate import Calibration
from cqdd_design.actuator.bench.locked import (
    LockedOutput,
    friction_line,
    locked_output,
)
from cqdd_design.actuator.bench.metric import is_near
from cqdd_design.actuator.bench.readings import FrictionLine, LoopReading, read_friction, read_loop
from cqdd_design.actuator.bench.run import VOLTAGE as VOLTS
from cqdd_design.actuator.bench.run import run_bench
from cqdd_design.actuator.bench.unknowns import UNKNOWNS
from cqdd_design.actuator.build import actuator_parameters, motor_and_drive
from cqdd_design.actuator.parameters import MotorParameters
from cqdd_design.actuator.specimen import AS_DRAWN
from cqdd_design.catalog.materials import find_material
from cqdd_design.catalog.paper import METRICS as PAPER
from cqdd_design.design import load_design
from cqdd_design.errors import ContactError
from cqdd_design.machine import Machine, resolve
from cqdd_design.report.ink.numbers import pretty_unit
from cqdd_design.torque.data.log_files import read_columns

DOCS = Path(__file__).resolve().parent
RECORDS = DOCS.parent.parent / "shared" / "data" / "measured"
DESIGN = DOCS.parent / "designs" / "printed-13.toml"
PLACES = (1, 5, 6)
"""Output positions of the ramps."""
SMALL, LARGE = range(5), range(100, 103)
"""Numbers of a record's cycles: up to 4 N m, and up to 25 or 40."""
SLOWEST = 2.0 * math.pi * 0.1
"""Of the output, rad/s, from which a ramp of speed counts."""


class Specimen(NamedTuple):
    """One build of the actuator, and what the thesis reads off it (nan where it prints nothing)."""

    title: str
    record: str
    material: str
    play: float
    compliance: float
    coulomb: float
    viscous: float

    @property
    def conic(self) -> bool:
        """Whether its disc is the conic one, whose preload the toolkit does not know."""
        return "conic" in self.record


_NONE = math.nan
_PCCF, _ONYX = "PC-CF FDM along layers", "Onyx FDM along layers"
SPECIMENS = (
    Specimen("baseline PC-CF, new", "baseline-pccf-initial", _PCCF, 2.556, 0.084, 1.90, 2.95),
    Specimen("baseline PC-CF, run in", "baseline-pccf-run-in", _PCCF, 2.501, 0.083, 1.58, 1.32),
    Specimen("baseline Onyx, new", "baseline-onyx-initial", _ONYX, *[_NONE] * 4),
    Specimen("baseline Onyx, run in", "baseline-onyx-run-in", _ONYX, *[_NONE] * 4),
    Specimen("conic PC-CF, preload 1", "conic-pccf-preload-1", _PCCF, 0.859, 0.106, 3.73, 1.63),
    Specimen("conic PC-CF, preload 2", "conic-pccf-preload-2", _PCCF, 0.693, 0.100, 5.14, 0.83),
    Specimen("conic PC-CF, preload 3", "conic-pccf-preload-3", _PCCF, 0.552, 0.097, 6.64, 1.28),
    Specimen("conic PC-CF, preload 4", "conic-pccf-preload-4", _PCCF, 0.481, 0.091, 8.88, 2.53),
    Specimen("conic PC-CF, preload 5", "conic-pccf-preload-5", _PCCF, 0.481, 0.094, 9.89, 2.63),
)
"""Play in degrees, compliance in degrees a N m, friction in N m and N m a revolution a second."""
MASS, SPEED, VOLTAGE = 1.35, 120.0, 44.0
"""kg; rpm without load at that voltage."""


def motor_of(machine: Machine) -> MotorParameters:
    """By the catalogue, whose drag is the thesis' own test of the motor alone."""
    return motor_and_drive(machine)[0]


@cache
def loops(record: str, cycles: Sequence[int]) -> tuple[LoopReading, ...]:
    """Readings of a specimen's cycles at every place."""
    found = []
    for place in PLACES:
        table = read_columns(
            RECORDS / f"ramp-{record}-{place}.csv",
            ("POSITION", "TORQUE", "CONTROL_TORQUE", "test_nr"),
        )
        for cycle in cycles:
            own = table["test_nr"] == cycle
            angle = 2.0 * math.pi * table["POSITION"][own]
            found.append(read_loop(table["CONTROL_TORQUE"][own], table["TORQUE"][own], angle))
    return tuple(found)


def mean(found: Sequence[LoopReading], what: str) -> float:
    """Of one reading over loops."""
    return float(np.mean([getattr(one, what) for one in found]))


@cache
def measured_friction() -> FrictionLine:
    """Of the baseline of Onyx without load."""
    table = read_columns(RECORDS / "speed-baseline-onyx.csv", ("VELOCITY", "TORQUE"))
    return read_friction(2.0 * math.pi * table["VELOCITY"], table["TORQUE"], SLOWEST)


@cache
def machine_of(material: str) -> Machine:
    """The printed actuator with disc and ring of a material."""
    design = load_design(DESIGN)
    changes = {"reducer.disc_material": material, "reducer.ring_material": material}
    return resolve(design.replacing(changes))


def solved(machine: Machine, wanted: float) -> LockedOutput:
    """Against a locked output up to a motor's torque, or as far as its equilibrium reaches."""
    motor = motor_of(machine)
    # A motor at `wanted` passes less to the gearbox; where that is out of reach, still less.
    for share in np.arange(1.0, 0.15, -0.05):
        try:
            return locked_output(machine, share * wanted, motor)
        except ContactError:
            continue
    raise SystemExit(f"{machine.design.name} has no equilibrium up to {wanted:g} N m")


@cache
def predicted(material: str) -> LockedOutput:
    """Of the printed actuator of a material, up to the 25 N m of its ramps."""
    return solved(machine_of(material), 25.0)


@cache
def predicted_friction(material: str) -> FrictionLine:
    """Of the printed actuator without load, up to the 2 revolutions a second of its ramp."""
    machine = machine_of(material)
    return friction_line(machine, 4.0 * math.pi, motor_of(machine))


def _off(ours: float, theirs: float) -> str:
    return f"{round(100.0 * (ours / theirs - 1.0)):+d}\u202f%"


def _or_none(value: float, digits: str) -> str:
    return "" if math.isnan(value) else format(value, digits)


def _table(head: str, rows: Sequence[str]) -> str:
    return "\n".join([head, "|---" * (head.count("|") - 1) + "|", *rows])


def read_table() -> str:
    """Every specimen as the thesis reads it, and as the project's own reader does."""
    rows = []
    for one in SPECIMENS:
        small, large = loops(one.record, SMALL), loops(one.record, LARGE)
        play, compliance = math.degrees(mean(small, "play")), mean(large, "compliance")
        rows.append(
            f"| {one.title} | {_or_none(one.play, '.3f')} | {play:.3f} "
            f"| {_or_none(one.compliance, '.3f')} | {math.degrees(compliance):.3f} "
            f"| {1.0 / compliance:.0f} | {mean(large, 'lost'):.2f} |"
        )
    return _table(
        "| specimen | play, deg: thesis | read here | compliance, deg/(N·m): thesis | read here "
        "| stiffness, N·m/rad | lost in a cycle, J |",
        rows,
    )


def largest(found: LockedOutput) -> float:
    """Torque of the greatest cycle that is predicted, N m: whole, and no more than was measured."""
    return float(min(math.floor(found.most), 25))


def loop_table() -> str:
    """The baseline's loops predicted before any fit, beside what was read off the records."""
    rows = []
    for one in SPECIMENS:
        if one.conic:
            continue
        found = predicted(one.material)
        small, large = loops(one.record, SMALL), loops(one.record, LARGE)
        ours, wide = found.read(largest(found)), found.read(4.0)
        for name, unit, theirs, mine in (
            ("play", "deg", math.degrees(mean(small, "play")), math.degrees(wide.play)),
            (
                "stiffness of the loaded branches",
                "N·m/rad",
                1.0 / mean(large, "compliance"),
                ours.stiffness,
            ),
        ):
            off = _off(mine, theirs)
            rows.append(f"| {one.title} | {name}, {unit} | {theirs:.4g} | {mine:.4g} | {off} |")
    return _table("| specimen | what | measured | predicted | off |", rows)


def friction_table() -> str:
    """Friction without load, mass and speed, before any fit."""
    rows = []
    for one in SPECIMENS:
        if one.conic:
            continue
        ours = predicted_friction(one.material)
        read = None if "Onyx" not in one.title else measured_friction()
        if read is not None and "new" in one.title:
            continue
        coulomb = one.coulomb if read is None else read.coulomb
        viscous = one.viscous if read is None else read.viscous_per_turn
        by = "thesis" if read is None else "read here"
        for name, unit, theirs, mine in (
            ("Coulomb", "N·m", coulomb, ours.coulomb),
            ("viscous", "N·m per rev/s", viscous, ours.viscous_per_turn),
        ):
            rows.append(
                f"| {one.title.replace(', run in', '') if read else one.title} | {name}, {unit} "
                f"| {theirs:.3g} ({by}) | {mine:.3g} | {_off(mine, theirs)} |"
            )
    machine = machine_of(_PCCF)
    mass, speed = machine.inertia.mass, no_load_speed(machine)
    rows.append(f"| whole actuator | mass, kg | {MASS} | {mass:.3g} | {_off(mass, MASS)} |")
    rows.append(
        f"| whole actuator | speed without load on {VOLTAGE:g} V, rpm | {SPEED:g} | {speed:.3g} "
        f"| {_off(speed, SPEED)} |"
    )
    return _table("| specimen | what | measured | predicted | off |", rows)


def no_load_speed(machine: Machine) -> float:
    """Of the bench on the thesis' voltage, rpm at the output."""
    from cqdd_design.actuator.bench.steady import no_load_speed as measure
    from cqdd_design.actuator.build import actuator_parameters

    return measure(actuator_parameters(machine), VOLTAGE).value


ACROSS = {
    "reducer.disc_material": "PC-CF FDM across layers",
    "reducer.ring_material": "PC-CF FDM across layers",
    "housing.material": "PC-CF FDM across layers",
    "reducer.cam_bearing.support_stiffness": "4.3 N/um",
}
"""Moduli across the layers of every printed part."""
LOOSE = {"reducer.modification.equidistant": "335 um"}
"""The profile clearance that gives the play of PC-CF."""
VARIATIONS: tuple[tuple[str, dict[str, str]], ...] = (
    ("as predicted", {}),
    (
        "shaft, its bearings and their seats rigid",
        {"reducer.cam_bearing.support_stiffness": "0 N/um"},
    ),
    (
        "moduli across the layers in place of along (2.3 for 4 GPa), supports softer alike",
        ACROSS,
    ),
    ("teeth that rub with 0.10 in place of 0.15", {"reducer.friction.tooth": "0.10"}),
    ("profile clearance of 335 for 50 µm, which gives the measured play", LOOSE),
    ("that clearance, and moduli across the layers", LOOSE | ACROSS),
)
"""Of the PC-CF baseline: what its prediction hangs on."""


def parts_table() -> str:
    """What play and stiffness hang on; each is a change, none is a fit."""
    rows = []
    base = machine_of(_PCCF)
    for words, changes in VARIATIONS:
        told = {key: float(v) if "friction" in key else v for key, v in changes.items()}
        found = solved(base.changed(told), 25.0)
        wide, ours = found.read(4.0), found.read(largest(found))
        elastic = found.torque[-1] / (found.driving[-1] - found.driving[0])
        rows.append(
            f"| {words} | {math.degrees(wide.play):.2f} | {ours.stiffness:.0f} | {elastic:.0f} "
            f"| {largest(found):.0f} |"
        )
    return _table(
        "| PC-CF baseline | play, deg | stiffness of the loaded branches, N·m/rad "
        "| of it elastic | read up to, N·m |",
        rows,
    )


class Twist(NamedTuple):
    """A round part that twists behind the equilibrium, m; `turns` of it a turn of the output."""

    words: str
    outside: float
    inside: float
    length: float
    turns: float = 1.0


TWISTS = (
    Twist("printed shaft, 12 mm solid, 30 mm from the rotor to the cam", 12e-3, 0.0, 30e-3, 13.0),
    Twist("ring and housing wall, 69 to 74 mm, 40 mm to the flange", 74e-3, 69e-3, 40e-3),
    Twist("output ring, 34 to 50 mm, 15 mm to the locking plate", 50e-3, 34e-3, 15e-3),
)


def twist_table() -> str:
    """Compliance of what twists beside the equilibrium, l/(G J), at the output."""
    material = find_material(ACROSS["reducer.disc_material"])
    shear = material.youngs_modulus / (2.0 * (1.0 + material.poisson_ratio))
    measured = mean(loops(SPECIMENS[0].record, LARGE), "compliance")
    rows = []
    for one in TWISTS:
        polar = math.pi / 32.0 * (one.outside**4 - one.inside**4)
        found = one.length / (shear * polar) / one.turns**2
        rows.append(f"| {one.words} | {1e6 * found:.0f} | {100.0 * found / measured:.1f} % |")
    return _table("| part | compliance, µrad/(N·m) | of the measured |", rows)


@cache
def papers_fit() -> Calibration:
    """The paper's actuator fitted to its measured rows; two pages tell it."""
    from cqdd_design.roads.calibrate import calibrate

    return calibrate(load_design(DESIGN.parent / "cqdd-10.toml"))


FILMS = {"reducer.friction.tooth": "film", "reducer.friction.pin": "film"}
"""Friction of the paper's actuator by films of its grease, not the coefficient it states."""


def paper_table() -> str:
    """The paper's bench without any fit, by films, and with three fitted rows."""
    from cqdd_design.roads.bench import bench
    from cqdd_design.roads.calibrate import PAPER_ROWS, calibrate

    paper = load_design(DESIGN.parent / "cqdd-10.toml")
    found = calibrate(paper, to=(*PAPER_ROWS, "torque_bandwidth"))
    films = bench(paper.replacing(FILMS))
    rows: list[str] = []
    near: tuple[list[str], list[str]] = ([], [])
    for row in found.rows:
        if row.measured is None:
            continue
        cells = [f"`{row.name}`", pretty_unit(row.unit), f"{row.measured:.4g}"]
        unfitted = (row.before, films.value(row.name))
        for value in (*unfitted, row.after):
            known = value is not None and math.isfinite(value)
            cells += [f"{value:.3g}", _off(value, row.measured)] if known else ["none", ""]
        rows.append(f"| {' | '.join(cells)} | {row.relation} |")
        if row.relation not in ("predicted", "calibrated"):
            continue
        for value, names in zip(unfitted, near, strict=True):
            if value is not None and is_near(row.unit, value, row.measured):
                names.append(f"`{row.name}`")
    alone, by_films = (", ".join(names) or "none" for names in near)
    fitted = (
        f"`{name}` {UNKNOWNS[name].told(value).replace('*', '·')}"
        for name, value in found.factors.items()
    )
    told = (
        f"Without any fit within 20 % (efficiency: 5 points), given rows apart: {alone}. "
        f"By films: {by_films}. With the fit, of rows that it predicts: "
        f"{', '.join(f'`{row.name}`' for row in found.within)}. Fitted: "
        f"{', '.join(fitted)}."
    )
    head = "| row | unit | paper | no fit | off | films | off | fitted | off | agreement is |"
    return f"{_table(head, rows)}\n\n{told}"


RUBBING = {"reducer.friction.tooth": 0.03, "reducer.friction.pin": 0.03}
FRICTIONLESS = {"reducer.friction.tooth": 0.0, "reducer.friction.pin": 0.0}
NO_DRAG = {"coulomb": 0.0, "viscous": 0.0}


class Change(NamedTuple):
    """Of the paper's actuator, to see what its rows of friction hang on; none is a fit."""

    words: str
    design: Mapping[str, float | str] = {}
    motor: Mapping[str, float] = {}
    voltage: float = VOLTS


PAPER_VARIATIONS = (
    Change("as predicted"),
    Change("teeth and pins by films", FILMS),
    Change("teeth and pins that rub with 0.03 in place of 0.08", RUBBING),
    Change("teeth and pins that do not rub at all", FRICTIONLESS),
    Change("the same on 48 V in place of 24", FRICTIONLESS, voltage=48.0),
    Change("cogging of 55 N·mm peak to peak, not amplitude", motor={"cogging_amplitude": 0.0275}),
    Change("a motor without drag of its own", motor=NO_DRAG),
    Change("0.03, and a motor without drag", RUBBING, NO_DRAG),
    Change("48 V in place of 24", voltage=48.0),
    Change("eccentricity of 2.0 for 1.6 mm", {"reducer.eccentricity": "2.0 mm"}),
    Change("a cap that is clamped on its pins", {"reducer.carrier.joint": "clamped"}),
)


def paper_parts_table() -> str:
    """Efficiency and backdrive torques under changes, none of which is a fit."""
    names = ("efficiency_peak", "backdrive_static", "backdrive_dynamic")
    paper = load_design(DESIGN.parent / "cqdd-10.toml")
    printed = [PAPER[name].value for name in names]
    rows = ["| the paper, measured | " + " | ".join(f"{value:.3g}" for value in printed) + " |"]
    for one in PAPER_VARIATIONS:
        drawn = actuator_parameters(resolve(paper.replacing(dict(one.design))), AS_DRAWN)
        changed = replace(drawn, motor=replace(drawn.motor, **one.motor))
        found = run_bench(changed, only=names, voltage=one.voltage)
        values = [f"{found.value(name):.3g}" for name in names]
        rows.append(f"| {one.words} | {' | '.join(values)} |")
    return _table("| cqdd-10 | efficiency | static backdrive, N·m | dynamic, N·m |", rows)


def published_table(records: Sequence[tuple[dict[str, str], float, object]]) -> str:
    """Published efficiencies of cycloid drives without a fitted coefficient, from the tests."""
    rows = [
        f"| {row['case']} | {float(row['value']):.4f} | {ours:.4f} "
        f"| {100.0 * (ours - float(row['value'])):+.1f} | {row['source']} |"
        for row, ours, _ in records
        if row["group"] == "efficiency by films"
    ]
    return _table("| drive | published | computed | off, points | source |", rows)
