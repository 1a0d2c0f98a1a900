"""How the machine comes apart, tried: every step moves something along the axis past all the rest.

A piece that moves sweeps the prism under its shape; it can leave where that prism meets no material
of what is still in place. Screws leave on the side of their heads, and what they are screwed into
waits for them; nuts leave along their threads. Where no single thing can move, a unit does: one
thing with all that it pushes before it, such as the carrier with discs and shaft, which is put
together on the bench (Wilson and Latombe 1994, blocking graphs). Columns, pins and their sleeves
leave as soon as they can: put in any earlier they would have nothing to stand in. Pins that cannot
before their ring leave with it. What is bonded into a part that comes in later, as magnets into
their bell, and weights on it, leaves with it and is a unit too. So does a cam bearing with the disc
that it is pressed into: once it is on its lobe, the force would run through its balls. Put together
is the same backwards.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Literal, NamedTuple, TypeAlias

import numpy as np

from cqdd_design.geometry.contours import FloatArray, PlanarPart
from cqdd_design.solids.counterweights import NAMES as WEIGHTS
from cqdd_design.solids.disassembly import disassembly_order
from cqdd_design.solids.features.kinds import AxialThread, Joint
from cqdd_design.solids.layers import Layer
from cqdd_design.solids.stations import Station, stations

if TYPE_CHECKING:
    from manifold3d import CrossSection

    from cqdd_design.design import Design
    from cqdd_design.solids.part import Part

_SAG = 5e-7
"""Of the polygons that stand for contours, m."""
_TOUCH = 0.3
"""Areas of overlap below this are seats that touch, mm^2."""
_GROWN = 0.05
"""By which a thread is wider than its drill at least, and less than a clearance hole's gap, mm."""
_DOT = 1e-3
"""Side of the square that tells whether the axis runs in material, mm."""
_EDGE = 1e-4
"""Radii that overlap by less touch, mm."""
_LEVEL = 1e-7
"""Heights closer than this are one, m."""
_IN_POCKETS = {"ring pin", "ring roller", "ring needle cage"}
"""Parts that a ring holds in its pockets."""
_ON_COVER = {"encoder board", "encoder screw"}
"""Parts that go with the motor cover."""
_MAGNET = "encoder magnet"
Way = Literal["up", "down"]


@dataclass(frozen=True, eq=False)
class Step:
    """Something that leaves along the axis.

    Attributes
    ----------
    moved : tuple of Station
        One, or all of a unit.
    way : {"up", "down"}
        ``up`` is towards the output.
    unit : str
        Name of the unit that it is taken from on the bench, or nothing.
    """

    moved: tuple[Station, ...]
    way: Way
    unit: str = ""

    @property
    def is_unit(self) -> bool:
        """Whether several parts move as one."""
        return len(self.moved) > 1


def posed_layers(part: Part, pose: FloatArray) -> list[Layer]:
    """Layers of a piece where it stands, m; poses turn about the axis or turn a piece over."""
    turn = math.atan2(float(pose[1, 0]), float(pose[0, 0]))
    over, lift = bool(pose[2, 2] < 0.0), float(pose[2, 3])
    found = []
    for layer in part.shape.layers:
        shape: PlanarPart = layer.shape.transformed(turn, pose[:2, 3], mirror=over)
        low, high = (-layer.top, -layer.bottom) if over else (layer.bottom, layer.top)
        found.append(Layer(shape, low + lift, high + lift))
    return found


def taken_apart(design: Design, parts: Sequence[Part]) -> tuple[tuple[Step, ...], bool]:
    """Steps in which a machine comes apart, and whether all of it does.

    Returns
    -------
    steps : tuple of Step
        In their order; those of a unit on the bench follow the step in which it left.
    whole : bool
        Whether nothing was left that could not move.
    """
    found = stations(parts)
    order = disassembly_order(found)
    middle = len(order) / 2.0
    outward = sorted(range(len(order)), key=lambda place: -abs(place - middle))
    things = [_Thing(design, found[order[place]]) for place in outward]
    things.sort(key=lambda thing: not thing.is_loose)
    return _take(things, "", _bonds(things))


def _bonds(things: Sequence[_Thing]) -> _Bonds:
    """Rotor and stator of a motor with what carries them, balance weights with their bell.

    Cam bearings with their discs.

    A stator goes with the housing that it is bonded on, the encoder's magnet with its shaft, pins
    with the ring in whose pockets they stand; these may leave it, but it does not leave them. So
    with the motor cover and the encoder's board: taken off first, it is put on last, when bell and
    magnet have been set from the face that it closes.
    """
    bonds: _Bonds = {}
    turned = {"rotor bell", "rotor hub"}
    belled = any(one.station.part.name in turned for one in things)
    for host in things:
        if host.station.body.kind == "disc" and host.station.part.source == "make":
            pressed = host.station.name.replace("disc", "cam bearing")
            inside = [one for one in things if one.station.name == pressed]
            bonds.setdefault(id(host), []).extend(inside)
            for bearing in inside:
                bonds.setdefault(id(bearing), []).append(host)
        if host.station.part.name == "ring":
            bonds[id(host)] = [one for one in things if one.station.part.name in _IN_POCKETS]
        if host.station.part.name == "motor cover" and belled:
            bonds[id(host)] = [one for one in things if one.station.part.name in _ON_COVER]
        for joint in host.station.part.features:
            if not isinstance(joint, Joint) or joint.kind != "bonded":
                continue
            for guest in things:
                name = guest.station.part.name
                bought = name.startswith("motor ") or name == _MAGNET
                if name == joint.to and (bought or host.station.part.name in WEIGHTS):
                    bonds.setdefault(id(host), []).append(guest)
                    if host.station.part.name != "housing" and name != _MAGNET:
                        bonds.setdefault(id(guest), []).append(host)
    return bonds


def unit_name(step: Step) -> str:
    """Name of the unit that leaves in a step: that of its largest part, made ones first."""
    largest = max(step.moved, key=lambda one: (one.part.source == "make", one.part.shape.volume))
    return f"unit of the {largest.name}"


def _take(things: list[_Thing], unit: str, bonds: _Bonds) -> tuple[tuple[Step, ...], bool]:
    left = list(things)
    steps: list[Step] = []
    while len(left) > 1:
        # What is left last may be one bond.
        split = _next(left, bonds) or _next_unit(left, bonds) or _next(left, {})
        if split is None:
            return tuple(steps), False
        group, way = split
        left = [thing for thing in left if thing not in group]
        steps.append(Step(tuple(thing.station for thing in group), way, unit))
        if len(group) == 1:
            continue
        # On the bench bonds come after what they hold is in its place, and a stator after what a
        # key has to reach past it.
        group.sort(key=lambda thing: thing.station.part.name != "motor stator")
        inner, whole = _take(group, unit_name(steps[-1]), {})
        steps += inner
        if not whole:
            return tuple(steps), False
    steps += [Step((thing.station,), "up", unit) for thing in left]
    return tuple(steps), True


def _next(left: Sequence[_Thing], bonds: _Bonds) -> tuple[list[_Thing], Way] | None:
    for thing in left:
        group = _bonded([thing], left, bonds)
        if len(group) == len(left):
            continue
        staying = [other for other in left if other not in group]
        for way in thing.ways:
            if all(one.passes(other, way) for one in group for other in staying):
                return group, way
    return None


def _bonded(group: list[_Thing], left: Sequence[_Thing], bonds: _Bonds) -> list[_Thing]:
    """Things with what is bonded to them, and to that."""
    found = list(group)
    for one in found:
        found += [o for o in bonds.get(id(one), []) if o in left and o not in found]
    return found


def _next_unit(left: Sequence[_Thing], bonds: _Bonds) -> tuple[list[_Thing], Way] | None:
    """The fewest things that leave together: one, all that it pushes before it, and so on."""
    ways: tuple[Way, Way] = ("up", "down")
    best: tuple[list[_Thing], Way] | None = None
    for thing, way in itertools.product(left, ways):
        group = _bonded([thing], left, bonds)
        fresh = list(group)
        while fresh:
            mover = fresh.pop()
            pushed = [o for o in left if o not in group and not mover.passes(o, way, free=True)]
            pushed = [o for o in _bonded(pushed, left, bonds) if o not in group]
            group += pushed
            fresh += pushed
        if len(group) < len(left) and (best is None or len(group) < len(best[0])):
            best = group, way
    return best


class _Flat(NamedTuple):
    """A shape (mm), between which radii about the axis its corners lie, and the box about it."""

    material: CrossSection
    inner: float
    outer: float
    box: tuple[float, float, float, float]

    def grown(self, by: float) -> _Flat:
        """The shape with this much (mm) more all round."""
        material = self.material.offset(by)
        return _Flat(material, self.inner - by, self.outer + by, material.bounds())


def _near(one: _Flat, other: _Flat) -> bool:
    """Whether two shapes may have more than an edge in common."""
    if one.inner > other.outer - _EDGE or other.inner > one.outer - _EDGE:
        return False
    (a, b, c, d), (e, f, g, h) = one.box, other.box
    return a < g and e < c and b < h and f < d


class _Thing:
    """A station where it stands, as polygons between heights."""

    def __init__(self, design: Design, station: Station) -> None:
        self.station = station
        self._design = design
        self._known: dict[tuple[int, Way, bool], bool] = {}
        self._shared: dict[tuple[int, int, int], float] = {}
        self._held: dict[int, bool] = {}

    @cached_property
    def prisms(self) -> list[tuple[float, float, _Flat]]:
        """Bottom and top (m) and shape (mm) of its material."""
        from manifold3d import CrossSection, FillRule

        part = self.station.part
        pieces = [posed_layers(part, p.pose(self._design)) for p in self.station.pieces]
        found = []
        for layers in zip(*pieces, strict=True):
            loops = [loop for layer in layers for loop in _loops(layer.shape)]
            shape = CrossSection(loops, FillRule.EvenOdd)
            radii = np.hypot(*np.concatenate(loops).T)
            hollow = (shape ^ CrossSection.square((_DOT, _DOT), True)).area() == 0.0
            inner = float(radii.min()) if hollow else 0.0
            flat = _Flat(shape, inner, float(radii.max()), shape.bounds())
            found.append((layers[0].bottom, layers[0].top, flat))
        return found

    @cached_property
    def is_screw(self) -> bool:
        """Whether it is a fastener with a head."""
        return self.station.off_axis and self._head is not None

    @property
    def is_loose(self) -> bool:
        """Whether it stands off the axis without a head: a column, a pin or its sleeve."""
        return self.station.off_axis and self._head is None

    @cached_property
    def _head(self) -> Way | None:
        part = self.station.part
        layers = sorted(part.shape.layers, key=lambda layer: layer.bottom)
        ends = [float(np.hypot(*one.shape.outer.sample(1e-5).T).max()) for one in layers]
        if len(layers) < 2 or abs(ends[0] - ends[-1]) < 1e-6 or part.source != "buy":
            return None
        up = (ends[-1] > ends[0]) == (self.station.pieces[0].placement[2, 2] > 0.0)
        return "up" if up else "down"

    @property
    def ways(self) -> tuple[Way, ...]:
        """In which it may leave."""
        if self._head is not None and self.station.off_axis:
            return (self._head,)
        return ("up", "down")

    def holds(self, other: _Thing) -> bool:
        """Whether a screw sits in another thing by its thread, which no clearance hole is near."""
        if not self.is_screw:
            return False
        known = self._held.get(id(other))
        if known is None:
            known = self._held[id(other)] = self._is_screwed_into(other)
        return known

    def _is_screwed_into(self, other: _Thing) -> bool:
        low, high, thread = self._thread
        return any(
            bottom < high - _LEVEL
            and top > low + _LEVEL
            and _near(thread, block)
            and (thread.material ^ block.material).area() > _TOUCH
            for bottom, top, block in other.prisms
        )

    @cached_property
    def _thread(self) -> tuple[float, float, _Flat]:
        """The end of a screw's shank, as wide as its thread."""
        far = min if self._head == "up" else max
        low, high, shank = far(self.prisms, key=lambda prism: prism[0])
        return low, high, shank.grown(_GROWN)

    def passes(self, other: _Thing, way: Way, *, free: bool = False) -> bool:
        """Whether it can leave past another thing that stays.

        `free`: of a unit, of which a screw may sit in nothing that stays.
        """
        key = (id(other), way, free)
        if key not in self._known:
            if self.is_screw and self.holds(other):
                self._known[key] = not free
            elif other.is_screw and other.holds(self):
                self._known[key] = False
            else:
                self._known[key] = not self._meets(other, way)
        return self._known[key]

    @cached_property
    def _threads(self) -> dict[str, AxialThread]:
        features = self.station.part.features
        return {one.designation: one for one in features if isinstance(one, AxialThread)}

    def _screwed(self, other: _Thing) -> float:
        """Area of the ring in which the threads of a nut and its bolt overlap, mm^2."""
        shared = self._threads.keys() & other._threads.keys()
        if not shared:
            return 0.0
        pair = [thing._threads[name] for name in sorted(shared) for thing in (self, other)]
        core, outside = min(t.core for t in pair), max(t.thread for t in pair)
        return 0.25e6 * math.pi * (outside**2 - core**2)

    def _meets(self, other: _Thing, way: Way) -> bool:
        """Whether what it sweeps on its way meets another thing's material."""
        free = _TOUCH + 1.01 * self._screwed(other)
        return any(
            (high > bottom + _LEVEL if way == "up" else low < top - _LEVEL)
            and self._area(i, other, j) > free
            for i, (bottom, top, _) in enumerate(self.prisms)
            for j, (low, high, _) in enumerate(other.prisms)
        )

    def _area(self, own: int, other: _Thing, its: int) -> float:
        """Area that a shape and one of another thing have in common, mm^2."""
        key = (own, id(other), its)
        if key not in self._shared:
            one, two = self.prisms[own][2], other.prisms[its][2]
            shared = (one.material ^ two.material).area() if _near(one, two) else 0.0
            self._shared[key] = other._shared[its, id(self), own] = shared
        return self._shared[key]


_Bonds: TypeAlias = dict[int, list[_Thing]]
"""By the id of a thing, the others that are bonded to it."""


def material_of(shape: PlanarPart, sag: float) -> CrossSection:
    """A shape as polygons that stay within a sag (m) of it, mm."""
    from manifold3d import CrossSection, FillRule

    return CrossSection(list(_loops(shape, sag)), FillRule.EvenOdd)


def _loops(shape: PlanarPart, sag: float = _SAG) -> Iterable[FloatArray]:
    for contour in (shape.outer, *shape.holes):
        yield contour.sample(sag) * 1e3
