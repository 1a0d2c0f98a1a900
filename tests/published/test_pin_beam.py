"""An output pin between plate and cap against the closed forms of beams.

Deflections, reactions and end stiffnesses of beams under one force: Young and Budynas, Roark's
Formulas for Stress and Strain, 7th ed. (2002), table 8.1, cases 1a (cantilever), 1c (fixed and
simply supported) and 1d (fixed); 1e (simply supported). Those are of slender beams: shear and seats
are switched off. With shear, the stiffness of a beam fixed in two walls that move apart is
12 E I/(L^3 (1 + Phi)), Phi = 12 E I k/(G A L^2) (Przemieniecki 1968, eq. 5.119).
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from cqdd_design.gearbox.contact.pin_beam import (
    PinEnd,
    PinSection,
    pin_beam,
    pin_in_stack,
    pin_section,
)

L, EI = 17.5e-3, 2.6
SLENDER = PinSection(bending=EI, shear=math.inf, seat=0.0, seat_length=0.0)
PLACES = np.array([0.11, 0.3, 0.55, 0.83]) * L
ENDS: tuple[PinEnd, ...] = ("clamped", "hinged", "free")
SEATED: list[tuple[PinEnd, PinEnd]] = [("bedded", "bedded"), ("bedded", "free")]


def at_load(a: float, ends: tuple[PinEnd, PinEnd]) -> float:
    """Deflection under a unit force at a from the plate."""
    b = L - a
    return {
        ("clamped", "clamped"): a**3 * b**3 / (3.0 * L**3),
        ("clamped", "hinged"): a**3 * b**2 * (3.0 * a + 4.0 * b) / (12.0 * L**3),
        ("clamped", "free"): a**3 / 3.0,
        ("hinged", "hinged"): a**2 * b**2 / (3.0 * L),
    }[ends] / EI


def at_cap(a: float, ends: tuple[PinEnd, PinEnd]) -> float:
    """Reaction at the cap of a unit force at a from the plate."""
    return {
        ("clamped", "clamped"): a**2 * (a + 3.0 * (L - a)) / L**3,
        ("clamped", "hinged"): a**2 * (3.0 * L - a) / (2.0 * L**3),
        ("clamped", "free"): 0.0,
        ("hinged", "hinged"): a / L,
    }[ends]


ALL_ENDS = [("clamped", end) for end in ENDS] + [("hinged", "hinged")]


@pytest.mark.parametrize("ends", ALL_ENDS)
def test_slender_pins_are_the_beams_of_the_handbook(ends: tuple[PinEnd, PinEnd]) -> None:
    found = pin_beam(PLACES, L, SLENDER, ends)
    for d, a in enumerate(PLACES):
        assert found.influence[d, d] == pytest.approx(at_load(a, ends), rel=1e-12)
        assert found.at_cap[d] == pytest.approx(at_cap(a, ends), rel=1e-12, abs=1e-15)
        assert found.at_plate[d] == pytest.approx(1.0 - at_cap(a, ends), rel=1e-12)
    joint = {"clamped": 12.0, "hinged": 3.0, "free": 0.0}[ends[1]] if ends[0] == "clamped" else 0.0
    assert found.joint == pytest.approx(joint * EI / L**3, rel=1e-12, abs=1e-9)


@pytest.mark.parametrize(("near", "far"), [(0, 1), (0, 3), (1, 2), (2, 3)])
def test_deflection_away_from_the_load(near: int, far: int) -> None:
    """Case 1d: x^2 b^2 (3 a L - 3 a x - b x)/(6 E I L^3) for x before a; case 1a: x^2 (3 a - x)."""
    x, a = PLACES[near], PLACES[far]
    b = L - a
    fixed = x**2 * b**2 * (3.0 * a * L - 3.0 * a * x - b * x) / (6.0 * EI * L**3)
    lone = x**2 * (3.0 * a - x) / (6.0 * EI)
    for cap, expected in (("clamped", fixed), ("free", lone)):
        found = pin_beam(PLACES, L, SLENDER, ("clamped", cap)).influence
        assert found[near, far] == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("ends", ALL_ENDS + SEATED)
def test_forces_of_two_discs_are_exchangeable(ends: tuple[PinEnd, PinEnd]) -> None:
    section = pin_section(4e-3, 205e9, 0.29, 72e9)
    found = pin_beam(PLACES, L, section, ends)
    most = np.abs(found.influence).max()
    assert np.abs(found.influence - found.influence.T).max() < 1e-12 * most
    assert np.linalg.eigvalsh(found.influence).min() > 0.0
    assert found.at_plate + found.at_cap == pytest.approx(1.0, rel=1e-12)
    firm = pin_beam(PLACES, L, section._replace(seat=0.0), ends)
    assert np.all(np.diag(found.influence) > np.diag(firm.influence))


@pytest.mark.parametrize("end", ["clamped", "bedded"])
@pytest.mark.parametrize("seat", [0.0, 5e-9])
def test_a_stocky_pin_between_walls_that_move_apart(end: PinEnd, seat: float) -> None:
    """From the middle of the pin, where no moment is, to a wall: beam, seat and turn in series."""
    section = PinSection(EI, 4e5, seat, 4e-3)
    found = pin_beam(PLACES, L, section, (end, end)).joint
    half = 0.5 * L
    yielded = half**3 / (3.0 * EI) + half / section.shear + seat
    if end == "bedded":
        yielded += 12.0 * seat / section.seat_length**2 * (half + 0.5 * section.seat_length) ** 2
    assert found == pytest.approx(0.5 / yielded, rel=1e-12)
    if seat == 0.0:
        phi = 12.0 * EI / (section.shear * L**2)
        assert found == pytest.approx(12.0 * EI / (L**3 * (1.0 + phi)), rel=1e-12)


@pytest.mark.parametrize("discs", [1, 2, 3])
def test_pins_of_held_plates_on_hinges(discs: int) -> None:
    """a^2 (L-a)^2/(3 E I L) + k a (L-a)/(G A L) + the share of either seat."""
    section = pin_section(4e-3, 205e9, 0.29, 72e9)
    b, s = 8e-3, 0.5e-3
    span = discs * b + (discs + 1) * s
    a = s + 0.5 * b + np.arange(discs) * (b + s)
    rest = span - a
    expected = (
        a**2 * rest**2 / (3.0 * section.bending * span)
        + a * rest / (section.shear * span)
        + section.seat * (a**2 + rest**2) / span**2
    )
    found = pin_in_stack(discs, b, s, section, ("hinged", "hinged"))
    assert np.diag(found.influence) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("disc", [0, 1, 2])
def test_the_seat_of_a_cantilever_is_an_even_elastic_bed(disc: int) -> None:
    """Deflection at a disc by a rigid pin on a bed of springs, solved by numbers, plus the beam."""
    d, b, s = 4e-3, 8e-3, 0.5e-3
    section = pin_section(d, 205e9, 0.29, 70e9)
    found = pin_in_stack(3, b, s, section, ("bedded", "free")).influence[disc, disc]
    arm = s + 0.5 * b + disc * (b + s)
    per_length = 1.0 / (1.0 / 205e9 + 1.0 / 70e9)
    count = 4000
    depth = (np.arange(count) + 0.5) * d / count
    springs = np.full(count, per_length * d / count)
    stiffness = np.array(
        [[springs.sum(), -(springs @ depth)], [-(springs @ depth), springs @ depth**2]]
    )
    moved, turned = np.linalg.solve(stiffness, [1.0, arm])
    beam = arm**3 / (3.0 * section.bending) + arm / section.shear
    assert found == pytest.approx(beam + moved + turned * arm, rel=1e-6)
