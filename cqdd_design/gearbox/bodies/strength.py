"""What elastic bodies say of a gearbox: stress of discs and ring, and give of the teeth.

Forces are those of the equilibrium, normal and tangential, in which the bodies are rigid: what the
bodies' own give would change about them is not in it. At every place on an edge the stress is
followed over the period, which the discs' sectors and the ring's teeth run through one after the
other, so that together they tell the turn of each single one.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import get_args

import numpy as np
from numpy.typing import NDArray

from cqdd_design.gearbox.bodies.compliance import ElasticBodies
from cqdd_design.gearbox.bodies.give import ToothGive, tooth_gives
from cqdd_design.gearbox.bodies.one_core import one_core
from cqdd_design.gearbox.bodies.stress import Region, disc_regions, disc_stress, ring_stress
from cqdd_design.gearbox.contact.solved import ContactSweep
from cqdd_design.gearbox.contact.states import NominalStates
from cqdd_design.gearbox.life.fatigue import BROKEN, goodman_reversed
from cqdd_design.geometry.contours import ComplexArray, FloatArray

REGIONS: tuple[Region, ...] = get_args(Region)
"""Of all discs and rings: one with columns between all of its holes lacks ``hole to hole``."""
LIGAMENTS = REGIONS[:6]


@dataclass(frozen=True)
class Peak:
    """Greatest stress of a region over the period.

    Attributes
    ----------
    stress : float
        Along the edge, tension positive, Pa.
    torque : float
        On the carrier, N m.
    crank_angle : float
        rad.
    disc : int
        From 0; of the ring the part that this disc works on.
    place : complex
        In the frame of the part, m.
    """

    region: Region
    stress: float
    torque: float
    crank_angle: float
    disc: int
    place: complex

    def to_dict(self) -> dict[str, object]:
        """The JSON form."""
        return {
            "region": self.region,
            "stress_MPa": self.stress / 1e6,
            "torque_Nm": self.torque,
            "crank_angle_deg": math.degrees(self.crank_angle),
            **_where(self.disc, self.place),
        }


@dataclass(frozen=True)
class Swing:
    """Worst cycle of a region over a turn.

    Attributes
    ----------
    low, high : float
        Its ends, Pa.
    reversed_amplitude : float
        Of the reversed cycle that harms as much by Goodman's line, Pa.
    disc, place
        As in :class:`Peak`.
    """

    region: Region
    low: float
    high: float
    reversed_amplitude: float
    disc: int
    place: complex

    def to_dict(self) -> dict[str, object]:
        """The JSON form."""
        return {
            "region": self.region,
            "low_MPa": self.low / 1e6,
            "high_MPa": self.high / 1e6,
            "reversed_amplitude_MPa": self.reversed_amplitude / 1e6,
            **_where(self.disc, self.place),
        }


def _where(disc: int, place: complex) -> dict[str, object]:
    return {"disc": disc, "point_mm": [1e3 * place.real, 1e3 * place.imag]}


@dataclass(frozen=True, eq=False)
class EdgePicture:
    """Stress along the edges of one disc at one instant.

    Attributes
    ----------
    disc : int
    torque, crank_angle : float
        N m, rad.
    edges : tuple of (array (S,), array (S,))
        Of the lobed outline and of every hole, those for columns last, in order round it: places in
        the frame of the disc (complex, m), and stress there (Pa), nan near a loaded contact.
    points, loads : array (N, 2)
        Of what pushes the disc, its cam last; in the ring's frame, m and N.
    """

    disc: int
    torque: float
    crank_angle: float
    edges: tuple[tuple[ComplexArray, FloatArray], ...]
    points: FloatArray
    loads: FloatArray


@dataclass(frozen=True, eq=False)
class BodyStrength:
    """Stress and give of the elastic bodies.

    Attributes
    ----------
    peaks : tuple of Peak
        Of every region that there is, at the peak torque in both senses.
    swings : tuple of Swing
        Of every region that there is, over a turn at the continuous torque: in the worse sense, or
        from one to the other where the duty has both.
    give, give_free, give_round : ToothGive
        With the bore on the bearing's rolling elements; held by radial springs too soft to matter,
        evenly all round; held round.
    picture : EdgePicture
        At the instant of the greatest stress in a disc.
    reciprocity : float
        Largest difference between the halves of the influence matrices, over their largest entry,
        as they were computed.
    """

    peaks: tuple[Peak, ...]
    swings: tuple[Swing, ...]
    give: ToothGive
    give_free: ToothGive
    give_round: ToothGive
    picture: EdgePicture
    reciprocity: float

    def peak(self, *regions: Region) -> Peak:
        """The greatest of some regions."""
        return max((one for one in self.peaks if one.region in regions), key=_size)

    def swing(self, *regions: Region) -> Swing:
        """The worst of some regions."""
        chosen = [one for one in self.swings if one.region in regions]
        return max(chosen, key=_harm)

    def to_dict(self) -> dict[str, object]:
        """Return the JSON form (``bodies``)."""
        return {
            "tooth_compliance_nm_per_N": 1e9 * self.give.mean,
            "ligament_stress_max_MPa": abs(self.peak(*LIGAMENTS).stress) / 1e6,
            "root_stress_max_MPa": abs(self.peak("root").stress) / 1e6,
            "ring_stress_max_MPa": abs(self.peak("ring").stress) / 1e6,
            "tooth_compliance": {
                "on_bearing": self.give.to_dict(),
                "bore_free": self.give_free.to_dict(),
                "bore_round": self.give_round.to_dict(),
            },
            "reciprocity": self.reciprocity,
            "stress": [one.to_dict() for one in self.peaks],
            "cycles": [one.to_dict() for one in self.swings],
        }


def _size(peak: Peak) -> float:
    return abs(peak.stress)


def _harm(swing: Swing) -> float:
    return swing.reversed_amplitude


@dataclass(frozen=True, eq=False)
class _Edge:
    """Places along the edges of a disc, or of the part of the ring that it works on.

    Attributes
    ----------
    regions : array (S,)
        Of every place.
    places : complex array (S,)
        m.
    orbit : array (S,)
        The same for places that have each other's stress a part of a turn later.
    """

    disc: int
    regions: NDArray[np.str_]
    places: ComplexArray
    orbit: NDArray[np.int64]


@one_core()
def body_strength(
    bodies: ElasticBodies,
    states: NominalStates,
    peak: Sequence[ContactSweep],
    steady: Sequence[ContactSweep],
    *,
    reverses: bool,
    ultimate: tuple[float, float],
) -> BodyStrength:
    """Stress of discs and ring, and give of the teeth.

    Parameters
    ----------
    bodies : ElasticBodies
    states : NominalStates
        Over the common period of both stages.
    peak, steady : sequences of ContactSweep
        At `states`: both senses of the peak torque, and of the continuous one.
    reverses : bool
        Whether the duty has both senses.
    ultimate : (float, float)
        S_u of discs and ring, Pa.
    """
    edges = _edges(bodies)
    loaded = [(sweep, _stresses(bodies, states, sweep)) for sweep in peak]
    turns = [_stresses(bodies, states, sweep) for sweep in steady]
    peaks, swings = [], []
    for region in REGIONS:
        own = [k for k, edge in enumerate(edges) if region in edge.regions]
        if not own:
            continue
        strength = ultimate[1] if region == "ring" else ultimate[0]
        peaks.append(
            max(
                (_peak(edges[k], region, sweep, found[k]) for sweep, found in loaded for k in own),
                key=_size,
            )
        )
        swings.append(
            max(
                (
                    _swing(edges[k], region, [found[k] for found in each], strength)
                    for each in ([turns] if reverses else [[one] for one in turns])
                    for k in own
                ),
                key=_harm,
            )
        )
    disc_peak = max(peaks[:-1], key=_size)
    give, free, held_round = tooth_gives(bodies, states, peak)
    return BodyStrength(
        tuple(peaks),
        tuple(swings),
        give,
        free,
        held_round,
        _picture(bodies, edges, disc_peak, loaded),
        max(body.reciprocity for _, body in (*bodies.discs, bodies.ring)),
    )


def _edges(bodies: ElasticBodies) -> list[_Edge]:
    """Disc and ring of every disc, as :func:`_stresses` has them."""
    ring = bodies.ring[0]
    roots = ring.roots().point
    on_pitch = np.arange(len(roots)) % (len(roots) // ring.tooth_count)
    found = []
    for index, (shape, _) in enumerate(bodies.discs):
        turns = [one.place for one in shape.symmetries()]
        regions, orbit = np.array(disc_regions(shape)), np.min(turns, axis=0)
        found.append(_Edge(index, regions, shape.seen().point, orbit))
        found.append(_Edge(index, np.full(len(roots), "ring"), roots, on_pitch))
    return found


def _stresses(
    bodies: ElasticBodies, states: NominalStates, sweep: ContactSweep
) -> list[FloatArray]:
    """Stress (A, S) along the edges of every disc and of the ring under it, Pa."""
    force, slip = _pushes(sweep)
    teeth = sweep.model.tooth_count
    found = []
    for index, disc in enumerate(bodies.discs):
        own, rubbed = force[:, index], slip[:, index]
        found.append(
            disc_stress(*disc, sweep.model, states, index, own, sweep.cam_force[:, index], rubbed)
        )
        found.append(ring_stress(*bodies.ring, states, index, own[:, :teeth], rubbed[:, :teeth]))
    return found


def _pushes(sweep: ContactSweep) -> tuple[FloatArray, FloatArray]:
    """Normal forces (A, D, C), N, and tangential ones over them; ring teeth first."""
    force = np.concatenate([sweep.ring_force, sweep.pin_force], axis=2)
    along = np.concatenate([sweep.ring_tangential, sweep.pin_tangential], axis=2)
    return force, np.divide(along, force, out=np.zeros(force.shape), where=force > 0.0)


def _peak(edge: _Edge, region: Region, sweep: ContactSweep, stress: FloatArray) -> Peak:
    own = np.flatnonzero(edge.regions == region)
    size = np.nan_to_num(np.abs(stress[:, own]))
    at, column = np.unravel_index(int(size.argmax()), size.shape)
    place = int(own[column])
    return Peak(
        region,
        float(np.nan_to_num(stress[at, place])),
        sweep.torque,
        float(sweep.crank_angle[at]),
        edge.disc,
        complex(edge.places[place]),
    )


def _swing(edge: _Edge, region: Region, turns: Sequence[FloatArray], ultimate: float) -> Swing:
    """The worst cycle of a region, from the least to the greatest stress of all `turns`."""
    low, high = np.full(len(edge.places), np.inf), np.full(len(edge.places), -np.inf)
    for stress in turns:
        # Where a contact is near there is no stress to tell; fmin and fmax pass nan over.
        np.fmin.at(low, edge.orbit, np.fmin.reduce(stress, axis=0))
        np.fmax.at(high, edge.orbit, np.fmax.reduce(stress, axis=0))
    own = np.flatnonzero((edge.regions == region) & (low <= high)[edge.orbit])
    low, high = low[edge.orbit[own]], high[edge.orbit[own]]
    harm = np.minimum(goodman_reversed(low, high, ultimate), BROKEN * ultimate)
    worst = int(harm.argmax())
    place = complex(edge.places[own[worst]])
    return Swing(
        region, float(low[worst]), float(high[worst]), float(harm[worst]), edge.disc, place
    )


def _picture(
    bodies: ElasticBodies,
    edges: Sequence[_Edge],
    peak: Peak,
    loaded: Sequence[tuple[ContactSweep, list[FloatArray]]],
) -> EdgePicture:
    """The disc of a peak at its instant."""
    sweep, stresses = next(one for one in loaded if one[0].torque == peak.torque)
    at = int(np.flatnonzero(sweep.crank_angle == peak.crank_angle)[0])
    shape = bodies.discs[peak.disc][0]
    edge, stress = edges[2 * peak.disc], stresses[2 * peak.disc][at]
    rim = shape.grid.per_lobe * shape.outline.lobe_count
    starts = [0, *range(rim, len(stress) + 1, shape.grid.per_hole)]
    loops = tuple(
        (edge.places[begin:end], stress[begin:end]) for begin, end in itertools.pairwise(starts)
    )
    own = at, peak.disc
    points = [sweep.ring_point[own], sweep.pin_point[own], sweep.disc_centre[own][None]]
    loads = [sweep.ring_load[own], sweep.pin_load[own], sweep.cam_force[own][None]]
    return EdgePicture(
        peak.disc,
        sweep.torque,
        peak.crank_angle,
        loops,
        np.concatenate(points),
        np.concatenate(loads),
    )
