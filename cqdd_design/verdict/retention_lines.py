"""Lines of what keeps its place: every part held along the axis, shoulders beside bearings."""

from __future__ import annotations

from cqdd_design.catalog.bearings import Bearing
from cqdd_design.errors import CatalogError, DesignError, GeometryError
from cqdd_design.gearbox.checks.allowables import LEAST_WALL_BETWEEN_HOLES
from cqdd_design.gearbox.checks.state import build_check
from cqdd_design.machine import Machine
from cqdd_design.machine.heat_nodes import by_node
from cqdd_design.machine.temperatures import MachineTemperatures
from cqdd_design.results import Check
from cqdd_design.solids.axial import AxialStack
from cqdd_design.solids.retention import Retained, Stop
from cqdd_design.solids.walls import Wall, least_walls

_LINES = ("RETENTION-HELD", "RETENTION-SHOULDER", "RETENTION-AXIAL-PLAY", "RETENTION-WALL")
_CURES = {
    "carrier cap": "set carrier.joint to 'clamped' or 'columns', or give the pins room for heads "
    "(fewer or thinner output_pins, or another circle_radius)",
    "carrier column": "give the columns screws (a larger carrier.column_diameter)",
}
_ON_SHAFT = ("shaft bearing", "cam bearing")
_SHOULDER_CURES = {
    "shaft": "a cam bearing with a larger bore, or less eccentricity, leaves higher shoulders",
    "output": "another carrier_bearing.designation, with smaller chamfers or higher rings",
}


def retention_lines(machine: Machine, warm: MachineTemperatures | None = None) -> tuple[Check, ...]:
    """Whether parts are held both ways and with play, shoulders reach bearings, holes have walls.

    Parameters
    ----------
    warm : MachineTemperatures or None
        Where they are not known, axial play is judged as drawn, and not known where that is enough.
    """
    try:
        table, stacks = machine.retention, machine.axial_stacks
    except (CatalogError, GeometryError) as error:
        return tuple(
            build_check(one, None, None, error.message, "see why it is not known") for one in _LINES
        )
    walls = least_walls(machine.parts)
    return (_held(table), _shoulder(table)[0], _play(machine, stacks, warm), _wall(walls))


def shoulder_on_shaft(machine: Machine) -> Check | None:
    """RETENTION-SHOULDER, where a bearing of the shaft decides it."""
    try:
        line, row = _shoulder(machine.retention)
    except (CatalogError, GeometryError):
        return None
    return line if row.startswith(_ON_SHAFT) else None


def _held(table: tuple[Retained, ...]) -> Check:
    free = [(row.name, way) for row in table for way in row.free]
    told = "nothing holds " + ", ".join(f"{name} {way}ward" for name, way in free)
    if not free:
        stopped = [(row, stop) for row in table for stop in (row.up, row.down) if stop.face > 0.0]
        row, most = max(stopped, key=lambda pair: pair[1].play or 0.0)
        told = (
            f"{len(table)} of {len(table)} held both ways, {_by_faces(table)} of them by faces; "
            f"most play: {row.name} to {most.by}, {1e3 * (most.play or 0.0):.3g} mm"
        )
    cure = next((_CURES[name] for name, _ in free if name in _CURES), "see what is beside it")
    return build_check("RETENTION-HELD", float(len(free)), 0.0, told, cure)


def _by_faces(table: tuple[Retained, ...]) -> int:
    return sum(row.up.face > 0.0 and row.down.face > 0.0 for row in table)


def _shoulder(table: tuple[Retained, ...]) -> tuple[Check, str]:
    """The line, and the bearing that decides it."""
    every: list[tuple[Bearing, Retained, Stop]] = [
        (row.bearing, row, stop)
        for row in table
        if row.bearing is not None
        for stop in (row.up, row.down)
        if stop.face > 0.0
    ]
    if not every:
        told = "no bearing stands on a shoulder"
        return build_check("RETENTION-SHOULDER", None, None, told, "see RETENTION-HELD"), ""
    bearing, row, stop = min(every, key=lambda one: one[2].sure / one[0].largest_chamfer)
    least, largest = bearing.largest_fillet, bearing.largest_chamfer
    line = build_check(
        "RETENTION-SHOULDER",
        stop.sure / least,
        largest / least,
        f"{row.name} on {stop.by}: {1e3 * stop.face:.3g} mm as drawn, {1e3 * stop.sure:.3g} mm at "
        f"the limits of its diameter and edge; chamfer of the {bearing.designation} "
        f"{1e3 * least:.3g} to {1e3 * largest:.3g} mm",
        _SHOULDER_CURES["output" if row.name.startswith("output") else "shaft"],
    )
    return line, row.name


def axial_growth(stack: AxialStack, warm: MachineTemperatures) -> tuple[float, float]:
    """What the coldest start and warm parts add to the room of a stack, m: the least of these.

    Raises
    ------
    DesignError
        When the thermal expansion of a part is not known.
    """
    warmed = [by_node(state) for state in warm.states]
    coldest = dict.fromkeys(warmed[0], warm.machine.design.environment.coldest)
    return stack.growth(coldest), min(stack.growth(state) for state in warmed)


def _play(
    machine: Machine, stacks: tuple[AxialStack, ...], warm: MachineTemperatures | None
) -> Check:
    missing, grown = "temperatures are not known", dict.fromkeys(stacks, 0.0)
    if warm is not None:
        try:
            grown = {one: min(0.0, *axial_growth(one, warm)) for one in stacks}
            missing = ""
        except DesignError as error:
            missing = error.message
    left = {one: one.reserve + grown[one] for one in stacks}
    least = min(stacks, key=left.__getitem__)
    told = f"{least.name}: room {_mm(least.worst[0])} to {_mm(least.worst[1])} mm"
    if least.shims is not None and least.kit is not None:
        told += f", packs of {least.shims.designation} leave"
    else:
        told += ", which is the play:"
    told += f" {_mm(least.play[0])} to {_mm(least.play[1])} mm, "
    told += missing or f"heat takes {_mm(0.0 - grown[least])} mm"
    known = not missing or left[least] < 0.0
    lacking = _mm(max(-left[least], 0.0))
    spacing = machine.design.reducer.disc_spacing + max(-left[least], 0.0)
    if not known:
        cure = "see THERMAL-RISE, which says what is not known"
    elif least.kit is None:
        cure = f"raise disc_spacing to {_mm(spacing)} mm, for lengths take {lacking} mm too much"
    else:
        cure = (
            f"a housing.material that grows as steel does, or less heat; {lacking} mm are lacking"
        )
    return build_check(
        "RETENTION-AXIAL-PLAY",
        1e3 * left[least] if known else None,
        0.0,
        told,
        cure,
    )


def _mm(value: float) -> str:
    return f"{1e3 * value:.3g}"


def _wall(walls: tuple[Wall, ...]) -> Check:
    limits = {wall: wall.least or LEAST_WALL_BETWEEN_HOLES for wall in walls}
    least = min(walls, key=lambda one: one.thickness / limits[one])
    return build_check(
        "RETENTION-WALL",
        1e3 * least.thickness,
        1e3 * limits[least],
        f"{least.part}: {1e3 * least.thickness:.3g} mm between {least.between}",
        "a larger ring, or fewer or thinner output_pins, leave more room",
        # Holes that run into each other are no thin wall.
        severity="fail" if least.thickness <= 0.0 else None,
    )
