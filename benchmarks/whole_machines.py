"""Sized machines of every kind: nothing left out, nothing in the way, all of it held and drawn.

    python benchmarks/whole_machines.py [--rows 84] [--first 1] [--angles 7]

Every row is a requirement: a ratio of 6 to 40, one to three discs, and one of ten outrunners whose
rings are 45 to 150 mm; then nine have an inrunner behind rings of 52 to 95 mm, and nine an
outrunner behind rings of 45 to 130 mm, which do not go into its stator or do not fill it. It is
sized by the screen (`quick`), and its ring is then made solid, conjugate or of pins. Where this is
refused the row is the sentence. Otherwise the machine is resolved, and looked at

- for parts that are left out: the motor's, and those of what the design asks for;
- for solids that run into each other through a revolution of the output;
- for the order in which it is put together, and keys that reach its screws;
- for what holds every part, shoulders, walls and axial play as drawn;
- for its mass against the sum of its parts, 1e-9;
- for the sheets of all made parts and of the assembly: text on text, on thick lines, off the page.

Eight of the motors are of no catalogue: they are CubeMars' RO100 scaled to other rings, lengths by
the factor, torque and mass by its cube, inertia by its fifth power.
"""

from __future__ import annotations

import argparse
import math
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(REPOSITORY / "tests" / "oracles"))

import numpy as np  # noqa: E402
from legible import faults  # noqa: E402

import cqdd_design as cq  # noqa: E402
from cqdd_design.catalog import find_motor  # noqa: E402
from cqdd_design.design import Design  # noqa: E402
from cqdd_design.errors import CqddError  # noqa: E402
from cqdd_design.exporting.job import ExportJob  # noqa: E402
from cqdd_design.exporting.sheets.canvas import render  # noqa: E402
from cqdd_design.exporting.sheets.sheet_files import sheets_of  # noqa: E402
from cqdd_design.machine import Machine, resolve  # noqa: E402
from cqdd_design.solids.clearances import output_revolution  # noqa: E402
from cqdd_design.solids.interference import (  # noqa: E402
    Overlap,
    boxes_meet,
    closer_look,
    overlap_of,
    posed_manifold,
)
from cqdd_design.solids.mesh import DISPLAY, FINE, surface_slack  # noqa: E402
from cqdd_design.solids.tool_access import tool_access  # noqa: E402
from cqdd_design.verdict.retention_lines import retention_lines  # noqa: E402

LIKE = "CubeMars RO100 KV55"
RINGS = (45.0, 52.0, 60.0, 72.0, 70.0, 82.0, 95.0, 110.0, 130.0, 150.0)
"""Largest ring of every motor, mm; the two of 72 and 70 mm are of the catalogue."""
CATALOGUE = {72.0: LIKE, 70.0: "CubeMars RO100 Lite KV55"}
KINDS = ("solid", "conjugate", "pinwheel")
OUTRUNNER_ROWS, INRUNNER_ROWS = 66, 9
INRUNNERS = ("CubeMars RI100 KV105", "CubeMars RI80 V2.0 KV75")
BEHIND = (52.0, 72.0, 95.0)
"""Rings before these, mm."""
ASTRIDE = (45.0, 95.0, 130.0)
"""Rings before an outrunner of the catalogue, each sized with the motor that fits it, mm."""
MOTOR_PARTS = {
    "motor stator", "motor rotor", "motor cover", "encoder magnet", "encoder board",
}  # fmt: skip


@dataclass(frozen=True)
class Row:
    """What is asked for.

    Attributes
    ----------
    ring : float
        Largest diameter, mm.
    inrunner : str
        Of the catalogue, that stands behind the gearbox; empty where an outrunner is round it.
    behind : str
        Outrunner of the catalogue that takes that one's place, and stands behind.
    """

    number: int
    ratio: int
    ring: float
    discs: int
    kind: str
    inrunner: str = ""
    behind: str = ""

    def __str__(self) -> str:
        """In the columns of the table."""
        return (
            f"{self.number:3d}  {self.ratio:5d}  {self.ring:7.4g}  {self.discs:5d}  {self.kind:9s}"
        )


def rows(count: int) -> Iterator[Row]:
    """Rows in which every outrunner meets every kind of ring and number of discs; others behind."""
    yield from _with_outrunners(count)
    for i in range(OUTRUNNER_ROWS, count):
        ratio, number = 6 + (i * 13) % 35, i - OUTRUNNER_ROWS
        place, kind = number % 3, KINDS[(number // 3) % 3]
        if number < INRUNNER_ROWS:
            yield Row(i + 1, ratio, BEHIND[place], 1 + place, kind, INRUNNERS[number % 2])
        else:
            yield Row(i + 1, ratio, ASTRIDE[place], 1 + place, kind, behind=LIKE)


def _with_outrunners(count: int) -> Iterator[Row]:
    for i in range(min(count, OUTRUNNER_ROWS)):
        yield Row(
            i + 1,
            6 + (i * 13) % 35,
            RINGS[i % len(RINGS)],
            1 + (i + i // 10) % 3,
            KINDS[(i // 10 + i // 30 + i % 10) % 3],
        )


GEARED = ("disc", "ring", "shoulder screw", "dowel pin", "pin sleeve", "carrier column")
"""Parts between which gaps are a few micrometres."""


def motor_file(ring: float, folder: Path) -> Path:
    """The catalogue's motor at the scale of a ring, written as a user would."""
    like, k = find_motor(LIKE), ring / 72.0
    lengths = (
        "outer_diameter", "length", "bore_diameter", "gap_diameter", "stack_length",
        "rotor_length", "slot_depth",
    )  # fmt: skip
    text = [
        f'name = "outrunner for {ring:g} mm"',
        *(f'{key} = "{getattr(like, key) * 1e3 * k:.6g} mm"' for key in lengths),
        f'mass = "{like.mass * k**3:.6g} kg"',
        f'rotor_inertia = "{like.rotor_inertia * k**5:.6g} kg*m^2"',
        f'rated_torque = "{like.rated_torque * k**3:.6g} N*m"',
        f'peak_torque = "{like.peak_torque * k**3:.6g} N*m"',
        f'torque_constant = "{like.torque_constant * k:.6g} N*m/A"',
        f'resistance = "{like.line_resistance / k:.6g} ohm"',
        f'rated_current = "{like.rated_current * k**2:.6g} A"',
        f'peak_current = "{like.peak_current * k**2:.6g} A"',
        f"pole_pairs = {like.pole_pairs}",
    ]
    path = folder / f"{ring:g}.toml"
    path.write_text("\n".join(text) + "\n", encoding="utf-8")
    return path


def designed(row: Row, folder: Path) -> Design:
    """The design of a row; CqddError where it is refused."""
    known = row.inrunner or CATALOGUE.get(row.ring)
    scale = row.ring / 72.0
    sized = cq.size(
        row.ratio,
        motor=known,
        motor_file=None if known else motor_file(row.ring, folder),
        quick=True,
        outer_diameter=f"{row.ring:g} mm",
        length=f"{24.0 * max(scale, 0.75):.4g} mm",
        disc_count=row.discs,
        peak_torque=f"{8.0 * scale**3 * math.sqrt(row.discs):.4g} N*m",
        continuous_torque=f"{2.0 * scale**3 * math.sqrt(row.discs):.4g} N*m",
        input_speed=f"{1200.0 / max(scale, 1.0):.4g} rpm",
    )
    motor = {"motor": {"name": row.behind}} if row.behind else {}
    return sized.design.replacing({"reducer.ring_type": row.kind, **motor})


def resolved(design: Design) -> Machine:
    """The machine of a design.

    Where pins have no pocket, the eccentricity is lowered and the pins are made thicker, as the
    refusal says, until they have one.
    """
    if design.reducer.ring_type != "pinwheel":
        return _with_parts(design)
    first: CqddError | None = None
    for thicker in (1.0, 1.25, 1.5, 2.0):
        for less in (1.0, 0.8, 0.6, 0.45):
            change = {
                "reducer.ring_pin_diameter": thicker * design.reducer.ring_pin_diameter,
                "reducer.eccentricity": less * design.reducer.eccentricity,
            }
            try:
                return _with_parts(design.replacing(change))
            except CqddError as error:
                first = first or error
    assert first is not None
    raise first


def _with_parts(design: Design) -> Machine:
    machine = resolve(design)
    _ = machine.parts
    return machine


def left_out(machine: Machine) -> Iterator[str]:
    """Parts that are missing."""
    names = {part.name for part in machine.parts}
    if machine.layout.motor_end is None:
        yield f"left out: the motor, {machine.layout.motor_missing}"
        return
    carried = "rotor hub" if machine.layout.inrunner else "rotor bell"
    wanted = MOTOR_PARTS | {
        carried,
        "housing",
        "ring",
        "eccentric shaft",
        "carrier plate",
        "output cover",
    }
    reducer = machine.design.reducer
    if reducer.output_pins.support == "both":
        wanted |= {"carrier cap"}
    if reducer.ring_type == "pinwheel":
        wanted |= {"ring pin"}
    for name in sorted(wanted - names):
        yield f"left out: {name}"
    discs = sum(len(p.instances) for p in machine.parts if p.name.split()[0] == "disc")
    if discs != reducer.disc_count:
        yield f"left out: {reducer.disc_count - discs} discs"


def collisions(machine: Machine, angles: int) -> dict[tuple[str, str], Overlap]:
    """The thickest overlap of parts that run into each other, as `check --assembly` finds them.

    What gears is meshed as finely as there, the rest as coarsely as for viewers.
    """
    design = machine.design
    pieces = [(part, piece) for part in machine.parts for piece in part.instances]
    finely = {part: FINE if part.name.startswith(GEARED) else DISPLAY for part in machine.parts}
    worst: dict[tuple[str, str], Overlap] = {}
    for number, angle in enumerate(output_revolution(design, angles).tolist()):
        meshed = [(part, piece.pose(design, angle), finely[part]) for part, piece in pieces]
        posed = [posed_manifold(*one) for one in meshed]
        boxes = np.array([solid.bounding_box() for solid in posed])
        for i, j in combinations(range(len(pieces)), 2):
            (one, first), (other, second) = pieces[i], pieces[j]
            if (first.body == second.body and number) or not boxes_meet(boxes[i], boxes[j]):
                continue
            shared = overlap_of(posed[i], posed[j])
            if shared is None:
                continue
            slack = surface_slack(one, finely[one]) + surface_slack(other, finely[other])
            found = closer_look(
                Overlap(first.name, second.name, angle, *shared, slack), [meshed[i], meshed[j]]
            )
            key = (one.name, other.name)
            if found.collides and (key not in worst or found.thickness > worst[key].thickness):
                worst[key] = found
    return worst


def found_in(machine: Machine, angles: int) -> Iterator[str]:
    """Sentences on what is wrong with a machine."""
    yield from left_out(machine)
    design, parts = machine.design, machine.parts
    for (first, second), one in collisions(machine, angles).items():
        yield f"collision: {first} and {second}, {1e6 * one.thickness:.3g} um"
    keys, whole = tool_access(design, parts)
    if not whole:
        yield "assembly: no order in which every part reaches its place"
    for key in keys:
        if not key.reaches:
            yield f"tool: {key.told}"
    for line in retention_lines(machine):
        # Axial play knows no temperatures here: what is not known is left to the verdict.
        if line.status == "fail":
            yield f"{line.id}: {line.substituted}; {line.remedy}"
    sums = sum(part.mass * part.count for part in parts)
    whole_mass = machine.inertia.total.mass
    if abs(whole_mass / sums - 1.0) > 1e-9:
        yield f"mass: {whole_mass:.12g} kg, the parts' sum {sums:.12g} kg"
    with tempfile.TemporaryDirectory() as folder:
        job = ExportJob(machine, Path(folder), lambda _: None)
        for number, _, sheet in sheets_of(job):
            for fault in faults(render(sheet)):
                yield f"sheet {number.removeprefix(design.name + '-')}: {fault}"


def looked_at(row: Row, angles: int, folder: Path) -> tuple[str, list[str]]:
    """What became of a row, and what is wrong with it."""
    try:
        machine = resolved(designed(row, folder))
    except CqddError as error:
        return "refused", [error.message]
    wrong = list(found_in(machine, angles))
    count = sum(part.count for part in machine.parts)
    return f"{count} pieces", wrong


def main() -> None:
    """Read the arguments and print a row for every requirement."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--rows", type=int, default=84, help="how many")
    parser.add_argument("--first", type=int, default=1, help="number of the first that is done")
    parser.add_argument("--angles", type=int, default=7, help="of the crank, looked at")
    options = parser.parse_args()
    if not 1 <= options.first <= options.rows:
        parser.error(f"--first {options.first}: there are rows 1 to {options.rows} (--rows)")
    told: Counter[str] = Counter()
    print("row  ratio  ring mm  discs  kind       seconds  found")
    with tempfile.TemporaryDirectory() as folder:
        for row in rows(options.rows):
            if row.number < options.first:
                continue
            began = time.process_time()
            what, wrong = looked_at(row, options.angles, Path(folder))
            told["refused" if what == "refused" else "wrong" if wrong else "clean"] += 1
            print(f"{row}  {time.process_time() - began:7.1f}  {what}", flush=True)
            for one in wrong:
                print(f"       {one}", flush=True)
    print(", ".join(f"{count} {name}" for name, count in sorted(told.items())))


if __name__ == "__main__":
    main()
