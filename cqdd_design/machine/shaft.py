"""What the plane contact problem leaves out of a machine: how far its shaft bends and things tilt.

Not in the equilibrium but bounded from its forces, at the heights and diameters of the layout.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cqdd_design.catalog.bearings import shaft_material
from cqdd_design.catalog.materials import Material, find_material
from cqdd_design.gearbox.cam_bearing import rolling_element
from cqdd_design.gearbox.contact import laws
from cqdd_design.gearbox.contact.laws import CamSpring
from cqdd_design.gearbox.contact.solved import ContactSweep
from cqdd_design.gearbox.shaft_bending import (
    ShaftBeam,
    ShaftSection,
    edge_load_factor,
    shaft_beam,
)
from cqdd_design.geometry.contours import ComplexArray, FloatArray
from cqdd_design.machine.machine import Machine
from cqdd_design.solids.layout import PackLayout, ShaftLayout
from cqdd_design.solids.rotating import eccentric_shaft

MODEL = (
    "Not in the contact equilibrium, but bounded from its forces.",
    "shaft: stepped beam with shear, sections as drawn, on knife edges in the middle of its "
    "support bearings; core: the same if lobes and collars stiffened nothing",
    "support: the shaft straight, the balls of its bearings without play, their seats rigid; "
    "unknown for bushes",
    "edge_closing: slopes of core and supports added up, times the disc's thickness, as if a disc "
    "followed its crank, which a row of balls hardly makes it do; edge_load_factor: of the line "
    "load at the busiest tooth",
    "Each cam bearing is in the middle of its disc, so that these forces tilt no disc.",
    "carrier_tilting_moment: of pins and upper support about the middle of the output bearing; "
    "carrier_tilt: unknown, because the catalogue has neither that bearing's tilting stiffness "
    "nor its play",
)
"""What the figures mean, as the JSON tells it."""


@dataclass(frozen=True)
class ShaftBending:
    """Greatest values over crank angle, discs and both senses of torque.

    Attributes
    ----------
    deflection, slope : float
        Of the shaft at a disc, m and rad, sections as drawn.
    core_deflection, core_slope : float
        With its round core alone.
    support_load : (float, float)
        On the shaft's bearings at the housing's and at the output's end, N.
    support_rating : float or None
        Their basic static rating, N; None for bushes.
    support_deflection, support_slope : float or None
        Of a straight shaft as these bearings yield; None where they are bushes.
    cam_approach : float
        Of a cam bearing, which the equilibrium has and these motions are in series with, m.
    edge_closing : float or None
        Difference in closing over a disc's thickness, m; None with bushes.
    ring_approach : float
        Of the tooth contact with the greatest force, m.
    carrier_moment : float
        That tilts the carrier in its output bearing, N m.
    follows : bool
        Whether the cam bearings roll on rollers, which hold a disc to its crank.
    """

    deflection: float
    slope: float
    core_deflection: float
    core_slope: float
    support_load: tuple[float, float]
    support_rating: float | None
    support_deflection: float | None
    support_slope: float | None
    cam_approach: float
    edge_closing: float | None
    ring_approach: float
    carrier_moment: float
    follows: bool

    @property
    def edge_load_factor(self) -> float | None:
        """Greatest load along that tooth contact over its mean; None where it is not known."""
        if self.edge_closing is None or self.ring_approach <= 0.0:
            return None
        return edge_load_factor(self.edge_closing, self.ring_approach)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Of support bearings beyond their rating, and lines that may leave one end."""
        return (*self._overloaded(), *self._uneven())

    def _overloaded(self) -> tuple[str, ...]:
        most, rating = max(self.support_load), self.support_rating
        if rating is None or most <= rating:
            return ()
        return (
            f"a support bearing of the shaft carries {most:.0f} N, more than its static rating of "
            f"{rating:.0f} N, and takes dents (SUPPORT-STATIC): lower the torque, or leave "
            "room for larger support bearings (a cam bearing with a larger bore).",
        )

    def _uneven(self) -> tuple[str, ...]:
        closing, factor = self.edge_closing, self.edge_load_factor
        if closing is None or factor is None or closing <= 2.0 * self.ring_approach:
            return ()
        who = (
            "rollers make a disc follow the slope of its shaft, and its teeth may"
            if self.follows
            else "if a disc followed the slope of its shaft, which a row of balls hardly makes it "
            "do, its teeth would"
        )
        return (
            f"{who} close by {closing * 1e6:.3g} um more at one face than at the other, over twice "
            f"the {self.ring_approach * 1e6:.3g} um by which the busiest tooth approaches. The "
            "load would leave one end of the line, and the pressure there be "
            f"{math.sqrt(factor):.2f} of what is told. A "
            "cam bearing with a larger bore leaves room for a thicker shaft in larger bearings; "
            "thinner discs close more evenly.",
        )

    def to_dict(self) -> dict[str, object]:
        """The JSON form (``bending``)."""
        return {
            "shaft_deflection_um": 1e6 * self.deflection,
            "shaft_slope_mrad": 1e3 * self.slope,
            "core_deflection_um": 1e6 * self.core_deflection,
            "core_slope_mrad": 1e3 * self.core_slope,
            "support_load_N": list(self.support_load),
            "support_static_rating_N": self.support_rating,
            "support_deflection_um": _scaled(1e6, self.support_deflection),
            "support_slope_mrad": _scaled(1e3, self.support_slope),
            "cam_approach_um": 1e6 * self.cam_approach,
            "edge_closing_um": _scaled(1e6, self.edge_closing),
            "ring_approach_um": 1e6 * self.ring_approach,
            "edge_load_factor": self.edge_load_factor,
            "carrier_tilting_moment_Nm": self.carrier_moment,
            "carrier_tilt_mrad": None,
            "model": list(MODEL),
        }


def _scaled(scale: float, value: float | None) -> float | None:
    return None if value is None else scale * value


def shaft_bending(machine: Machine, sweeps: Sequence[ContactSweep]) -> ShaftBending:
    """Bound what shaft, carrier and discs of a machine bend and tilt under contact equilibria.

    Parameters
    ----------
    sweeps : sequence of ContactSweep
        Of this machine, one at least.

    Raises
    ------
    GeometryError
        When the machine cannot be laid out, so that no height along its axis is known.
    """
    pack, shaft, carrier = machine.layout.pack, machine.layout.shaft, machine.layout.carrier
    steel = find_material(shaft_material(pack.cam.bearing))
    at, edges = disc_heights(pack), knife_edges(shaft)
    drawn = shaft_beam(drawn_sections(pack, shaft, steel), edges, at)
    core = shaft_beam(core_sections(shaft, steel), edges, at)

    pushed = -np.concatenate([_complex(one.cam_force) for one in sweeps])
    shares = np.column_stack([1.0 - drawn.on_upper, drawn.on_upper])
    carried = np.asarray(pushed @ shares, dtype=complex)
    sunk, turned = _supports_yield(shaft, drawn, carried)
    core_slope = _greatest(pushed @ core.rotation.T)

    middle = carrier.bearing_bottom + 0.5 * carrier.output.bearing.width
    on_pins = -np.concatenate([_complex(one.pin_load.sum(axis=2)) for one in sweeps])
    tilting = on_pins @ (at - middle) + carried[:, 1] * (edges[1] - middle)
    return ShaftBending(
        deflection=_greatest(pushed @ drawn.deflection.T),
        slope=_greatest(pushed @ drawn.rotation.T),
        core_deflection=_greatest(pushed @ core.deflection.T),
        core_slope=core_slope,
        support_load=(_greatest(carried[:, 0]), _greatest(carried[:, 1])),
        support_rating=None
        if shaft.support.source == "bush"
        else shaft.support.bearing.static_rating,
        support_deflection=sunk,
        support_slope=turned,
        cam_approach=float(_yield(sweeps[0].model.cam, np.abs(pushed)).max()),
        edge_closing=None if turned is None else (core_slope + turned) * pack.disc_thickness,
        ring_approach=max(_ring_approach(one) for one in sweeps),
        carrier_moment=_greatest(tilting),
        follows=rolling_element(pack.cam.bearing) == "roller",
    )


def _ring_approach(sweep: ContactSweep) -> float:
    coefficient = sweep.model.ring_coefficient(sweep.ring_equivalent_radius)
    return float(laws.approach(sweep.model.ring_law, coefficient, 0.0, sweep.ring_force).max())


def disc_heights(pack: PackLayout) -> FloatArray:
    """Heights of the discs' middles, (D,), m.

    The contact model counts discs from the carrier plate, the layout from the other end.
    """
    middles = [pack.disc_bottom(d) + 0.5 * pack.disc_thickness for d in range(pack.disc_count)]
    return np.array(middles[::-1])


def drawn_sections(
    pack: PackLayout, shaft: ShaftLayout, steel: Material
) -> tuple[ShaftSection, ...]:
    """Sections of the shaft as drawn: journals, core, lobes and collars, with its bore.

    A lobe, round the axis of its disc, counts by its lesser second moment. The loose cam of a third
    disc stiffens nothing.
    """
    found = []
    for layer in eccentric_shaft(pack, shaft).layers:
        own = layer.shape.moments().about_centroid()
        least = np.linalg.eigvalsh([[own.xx, own.xy], [own.xy, own.yy]])[0]
        ends = (layer.bottom, layer.top)
        found.append(_section(ends, own.area, float(least), shaft.bore_radius, steel))
    return tuple(found)


def core_sections(shaft: ShaftLayout, steel: Material) -> tuple[ShaftSection, ...]:
    """Sections of the journals and of the round core between them, which lobes stand on."""
    levels = (shaft.bottom, shaft.lower_seat_top, shaft.upper_seat_bottom, shaft.top)
    journal, bore = 0.5 * shaft.support.bearing.bore_diameter, shaft.bore_radius
    return tuple(
        _section(
            (bottom, top),
            math.pi * (radius**2 - bore**2),
            0.25 * math.pi * (radius**4 - bore**4),
            bore,
            steel,
        )
        for (bottom, top), radius in zip(
            itertools.pairwise(levels), (journal, shaft.shoulder_radius, journal), strict=True
        )
    )


def _section(
    ends: tuple[float, float], area: float, second: float, bore: float, steel: Material
) -> ShaftSection:
    """With the shear coefficient of a hollow round section (Cowper 1966)."""
    inner = bore**2 / (area / math.pi + bore**2)
    nu, wide = steel.poisson_ratio, (1.0 + inner) ** 2
    coefficient = ((7.0 + 6.0 * nu) * wide + (20.0 + 12.0 * nu) * inner) / (6.0 * (1.0 + nu) * wide)
    shear_modulus = steel.youngs_modulus / (2.0 * (1.0 + nu))
    return ShaftSection(*ends, steel.youngs_modulus * second, shear_modulus * area / coefficient)


def knife_edges(shaft: ShaftLayout) -> tuple[float, float]:
    """Heights of the middles of the shaft's two bearings, m."""
    half = 0.5 * shaft.support.bearing.width
    return shaft.lower_seat_top - half, shaft.upper_seat_bottom + half


def _supports_yield(
    shaft: ShaftLayout, beam: ShaftBeam, carried: ComplexArray
) -> tuple[float | None, float | None]:
    """Greatest motion at a disc (m) and turn (rad) of a straight shaft in its two bearings."""
    if shaft.support.source == "bush":
        return None, None
    load = np.abs(carried)
    given = _yield(laws.cam_spring(shaft.support.bearing, 0.0), load)
    lower, upper = np.moveaxis(given * carried / np.where(load > 0.0, load, 1.0), -1, 0)
    turn = (upper - lower) / beam.span
    at_disc = lower[:, None] + turn[:, None] * (beam.on_upper * beam.span)
    return _greatest(at_disc), _greatest(turn)


def _yield(spring: CamSpring, load: FloatArray) -> FloatArray:
    return np.asarray((load / spring.stiffness) ** (1.0 / spring.exponent))


def _complex(vectors: FloatArray) -> ComplexArray:
    return np.asarray(vectors[..., 0] + 1j * vectors[..., 1])


def _greatest(values: FloatArray | ComplexArray) -> float:
    return float(np.abs(values).max())
