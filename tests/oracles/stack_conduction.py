"""Heat in the drawn stack by finite differences: axisymmetric, every part by its own cells.

A second road to the temperatures of :mod:`cqdd_design.machine.temperatures`. Housing, ring, discs,
bearings, shaft and carrier are fields over radius and height with the conductivity of their
material, in their drawn places; heat is spread over each part, joints and surfaces are boundary
conditions with the same published figures, since no field knows them. The motor's parts, which lie
outside the stack, stay bodies of one temperature.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import spsolve

from cqdd_design.catalog.materials import find_material
from cqdd_design.gearbox.heat.surfaces import outside_conductance
from cqdd_design.machine import Machine
from cqdd_design.machine.heat_nodes import NODES, Node
from cqdd_design.machine.temperatures import MachineTemperatures
from cqdd_design.machine.thermal_parts import conductances


@dataclass(frozen=True)
class Field:
    """A turned part: rectangles (inner, outer, bottom, top) in m, and its conductivity."""

    node: Node
    conductivity: float
    rectangles: tuple[tuple[float, float, float, float], ...]


def fields(machine: Machine) -> tuple[Field, ...]:
    """Parts of the stack as turned bodies."""
    layout, design = machine.layout, machine.design
    pack, shaft, carrier, housing = layout.pack, layout.shaft, layout.carrier, layout.housing
    motor = layout.motor
    assert motor is not None
    metal, ring, disc = (
        find_material(name).conductivity or 0.0
        for name in (
            design.housing.material,
            design.reducer.ring_material,
            design.reducer.disc_material,
        )
    )
    steel, n, e = disc, pack.disc_count, pack.eccentricity
    cam = 0.5 * pack.cam.bearing.outer_diameter
    bore = 0.5 * pack.cam.bearing.bore_diameter
    reach = pack.reach - e
    bottom = motor.cover_floor - motor.cover_wall
    tube = (pack.ring_radius, housing.register_radius, housing.bottom, pack.top)
    house = (
        tube,
        (
            0.5 * shaft.support.bearing.outer_diameter,
            pack.ring_radius,
            housing.bottom,
            shaft.lower_seat_top,
        ),
        (
            housing.register_radius,
            housing.flange_radius,
            housing.flange_bottom,
            housing.cover_flange_top,
        ),
        (
            0.5 * carrier.output.bearing.outer_diameter,
            housing.register_radius,
            pack.top,
            housing.cover_flange_top,
        ),
        (motor.cover_inner, motor.cover_outer, bottom, housing.flange_bottom),
        (housing.register_radius, motor.cover_outer, housing.flange_bottom, motor.flange_top),
        (0.0, motor.cover_outer, bottom, motor.cover_floor),
    )
    plate = (
        (
            0.5 * shaft.support.bearing.outer_diameter,
            carrier.shoulder_radius,
            carrier.plate_bottom,
            carrier.bearing_bottom,
        ),
        (
            0.5 * shaft.support.bearing.outer_diameter,
            0.5 * carrier.output.bearing.bore_diameter,
            carrier.bearing_bottom,
            carrier.plate_top,
        ),
    )
    return (
        Field("housing", metal, house),
        Field("ring", ring, ((pack.reach, pack.ring_radius, 0.0, pack.top),)),
        *(
            Field(
                "disc",
                disc,
                ((cam, reach, pack.disc_bottom(d), pack.disc_bottom(d) + pack.disc_thickness),),
            )
            for d in range(n)
        ),
        Field("shaft", steel, ((shaft.bore_radius, bore - e, shaft.bottom, shaft.top),)),
        Field("carrier", metal, plate),
    )


class _Cells:
    """Cells of one field on a grid of its own edges, refined to about `size`."""

    def __init__(self, field: Field, size: float) -> None:
        radii = sorted({r for one in field.rectangles for r in one[:2]})
        heights = sorted({z for one in field.rectangles for z in one[2:]})
        self.r, self.z = (_refined(edges, size) for edges in (radii, heights))
        rm, zm = (0.5 * (x[1:] + x[:-1]) for x in (self.r, self.z))
        inside = np.zeros((len(rm), len(zm)), dtype=bool)
        for inner, outer, low, top in field.rectangles:
            inside |= ((rm > inner) & (rm < outer))[:, None] & ((zm > low) & (zm < top))[None]
        self.inside, self.rm, self.k = inside, rm, field.conductivity
        self.number = np.where(inside, np.cumsum(inside).reshape(inside.shape) - 1, -1)
        self.count = int(inside.sum())
        ring = np.pi * (self.r[1:] ** 2 - self.r[:-1] ** 2)
        self.volume = (ring[:, None] * np.diff(self.z)[None])[inside]

    def links(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Pairs of neighbouring cells and their conductances."""
        i, j, g = [], [], []
        dr, dz = np.diff(self.r), np.diff(self.z)
        for a in range(len(dr) - 1):
            both = self.inside[a] & self.inside[a + 1]
            i += list(self.number[a][both])
            j += list(self.number[a + 1][both])
            across = 2.0 * np.pi * self.k * dz / np.log(self.rm[a + 1] / self.rm[a])
            g += list(across[both])
        area = np.pi * (self.r[1:] ** 2 - self.r[:-1] ** 2)
        for b in range(len(dz) - 1):
            both = self.inside[:, b] & self.inside[:, b + 1]
            i += list(self.number[:, b][both])
            j += list(self.number[:, b + 1][both])
            g += list((self.k * area / (0.5 * (dz[b] + dz[b + 1])))[both])
        return np.array(i), np.array(j), np.array(g)

    def near(self, inner: float, outer: float, low: float, top: float) -> np.ndarray:
        """Cells in a rectangle, or the nearest ones to it, with shares by volume."""
        zm = 0.5 * (self.z[1:] + self.z[:-1])
        r, z = np.meshgrid(self.rm, zm, indexing="ij")
        r, z = r[self.inside], z[self.inside]
        far = np.hypot(
            np.maximum(np.maximum(inner - r, r - outer), 0.0),
            np.maximum(np.maximum(low - z, z - top), 0.0),
        )
        chosen = far <= far.min() + 1e-9
        return np.where(chosen, self.volume, 0.0) / self.volume[chosen].sum()


def _refined(edges: list[float], size: float) -> np.ndarray:
    found = [edges[0]]
    for a, b in pairwise(edges):
        steps = max(int(np.ceil((b - a) / size)), 1)
        found += list(a + (b - a) * np.arange(1, steps + 1) / steps)
    return np.array(found)


def stack_temperatures(found: MachineTemperatures, size: float = 1e-3) -> dict[str, float]:
    """Mean temperatures of parts, deg C, with the network's surfaces at its own steady state."""
    machine = found.machine
    layout = machine.layout
    assert layout.motor is not None
    told = conductances(machine, layout)
    pack, shaft, carrier, housing = layout.pack, layout.shaft, layout.carrier, layout.housing
    parts = fields(machine)
    cells = [_Cells(one, size) for one in parts]
    lumps: tuple[Node, ...] = ("winding", "stator", "rotor")
    first = np.cumsum([0, *(c.count for c in cells)])
    total = int(first[-1]) + len(lumps)
    row, col, val = [], [], []
    rhs = np.zeros(total)
    rise_of = found.duty.heat.at(found.steady)

    def join(u: np.ndarray, v: np.ndarray, g: float) -> None:
        """A conductance between two places, each spread over cells with shares (they sum to 1)."""
        for a, b, sign in ((u, u, 1.0), (v, v, 1.0), (u, v, -1.0), (v, u, -1.0)):
            ia, ib = np.flatnonzero(a), np.flatnonzero(b)
            if a is b:
                # A boundary condition acts on every cell by itself.
                row.extend(ia), col.extend(ia), val.extend(g * a[ia])
            else:
                grid = np.meshgrid(ia, ib, indexing="ij")
                row.extend(grid[0].ravel()), col.extend(grid[1].ravel())
                val.extend((sign * g * a[grid[0]] * b[grid[1]]).ravel())

    def place(which: int, where: tuple[float, float, float, float]) -> np.ndarray:
        full = np.zeros(total)
        full[first[which] : first[which + 1]] = cells[which].near(*where)
        return full

    def lump(node: Node) -> np.ndarray:
        full = np.zeros(total)
        full[int(first[-1]) + lumps.index(node)] = 1.0
        return full

    for which, (part, c) in enumerate(zip(parts, cells, strict=True)):
        i, j, g = (x for x in c.links())
        i, j = i + first[which], j + first[which]
        for a, b, s in ((i, i, 1.0), (j, j, 1.0), (i, j, -1.0), (j, i, -1.0)):
            row.extend(a), col.extend(b), val.extend(s * g)
        same = sum(1 for one in parts if one.node == part.node)
        heat = rise_of[NODES.index(part.node)] / same
        rhs[first[which] : first[which + 1]] += heat * c.volume / c.volume.sum()
    for node in lumps:
        rhs[np.flatnonzero(lump(node))] += rise_of[NODES.index(node)]
    number = {node: [k for k, one in enumerate(parts) if one.node == node] for node in NODES}
    house, ring, axis, out = (number[n][0] for n in ("housing", "ring", "shaft", "carrier"))
    discs, p = number["disc"], told.pairs
    cool = found.network.conductance
    register = (
        housing.register_radius,
        housing.register_radius,
        layout.motor.stack_bottom,
        layout.motor.stack_top,
    )
    cover = (
        layout.motor.cover_inner,
        layout.motor.cover_inner,
        layout.motor.cover_floor,
        layout.motor.ring_top,
    )
    seat = 0.5 * shaft.support.bearing.outer_diameter
    lower = (seat, seat, shaft.lower_seat_top - shaft.support.bearing.width, shaft.lower_seat_top)
    upper = (seat, seat, carrier.plate_bottom, carrier.plate_bottom + shaft.support.bearing.width)
    w, s, r = (NODES.index(node) for node in lumps)
    join(lump("winding"), lump("stator"), float(cool[w, s]))
    join(lump("stator"), lump("rotor"), float(cool[s, r]))
    join(lump("stator"), place(house, register), p["stator", "housing"])
    join(lump("rotor"), place(house, cover), p["rotor", "cover"])
    stub = (
        0.0,
        shaft.shoulder_radius,
        shaft.bottom,
        shaft.lower_seat_top - shaft.support.bearing.width,
    )
    join(lump("rotor"), place(axis, stub), p["rotor", "shaft"])
    wall = pack.ring_radius
    join(
        place(house, (wall, wall, 0.0, pack.top)),
        place(ring, (wall, wall, 0.0, pack.top)),
        p["housing", "ring"],
    )
    for d, disc in enumerate(discs):
        low, top = pack.disc_bottom(d), pack.disc_bottom(d) + pack.disc_thickness
        tip, eye = pack.reach - pack.eccentricity, 0.5 * pack.cam.bearing.outer_diameter
        join(
            place(disc, (tip, tip, low, top)),
            place(ring, (pack.reach, pack.reach, low, top)),
            p["ring", "disc"] / len(discs),
        )
        join(
            place(disc, (eye, eye, low, top)),
            place(axis, (0.1, 0.1, low, top)),
            p["disc", "shaft"] / len(discs),
        )
        circle = carrier.pin_circle_radius
        join(
            place(disc, (circle, circle, low, top)),
            place(out, (circle, circle, carrier.plate_bottom, carrier.plate_bottom)),
            p["disc", "carrier"] / len(discs),
        )
    join(place(house, lower), place(axis, (0.1, 0.1, *lower[2:])), p["housing", "shaft"])
    join(place(out, upper), place(axis, (0.1, 0.1, *upper[2:])), p["shaft", "carrier"])
    rim, inner = (
        0.5 * carrier.output.bearing.outer_diameter,
        0.5 * carrier.output.bearing.bore_diameter,
    )
    at = (carrier.bearing_bottom, carrier.bearing_top)
    join(place(house, (rim, rim, *at)), place(out, (inner, inner, *at)), p["housing", "carrier"])
    for index, one in enumerate(told.surfaces):
        g = found.network.cooling * outside_conductance(
            one, float(found.steady[one.node]), found.network.ambient
        )
        if NODES[one.node] == "carrier":
            where, body = (0.0, 1.0, carrier.plate_top, carrier.plate_top), out
        elif index == 0:
            far = layout.motor.cover_outer
            where, body = (far, far, layout.motor.cover_floor, housing.cover_flange_top), house
        elif index == 1:
            floor = layout.motor.cover_floor - layout.motor.cover_wall
            where, body = (0.0, 1.0, floor, floor), house
        else:
            where, body = (0.0, 1.0, housing.cover_flange_top, housing.cover_flange_top), house
        share = place(body, where)
        at_cells = np.flatnonzero(share)
        row.extend(at_cells), col.extend(at_cells), val.extend(g * share[at_cells])
    matrix = coo_matrix((val, (row, col)), shape=(total, total)).tocsc()
    rise = spsolve(matrix, rhs)
    means: dict[str, float] = {}
    motor = layout.motor
    floor = motor.cover_floor - motor.cover_wall
    dish = cells[house].near(motor.cover_inner, motor.cover_outer, floor, housing.flange_bottom)
    for node in NODES:
        if node in lumps:
            means[node] = float(rise[np.flatnonzero(lump(node))][0])
            continue
        if node in ("cover", "housing"):
            whole = rise[first[house] : first[house + 1]]
            share = dish if node == "cover" else np.where(dish > 0.0, 0.0, cells[house].volume)
            means[node] = float(whole @ share / share.sum())
            continue
        own = [(rise[first[k] : first[k + 1]], cells[k].volume) for k in number[node]]
        means[node] = float(sum(t @ v for t, v in own) / sum(v.sum() for _, v in own))
    return {node: value + found.network.ambient for node, value in means.items()}
