"""How much more torque a candidate would carry, check by check; all functions broadcast.

A *reserve* is the factor by which both required torques could grow until the check is on its
limit. Forces grow with the torque and Hertz pressures with its root, so the reserve of a stress is
limit/value and that of a pressure (limit/value)^2; 1 is on the limit, as in the checks.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from cqdd_design.gearbox import hertz, output_pins
from cqdd_design.gearbox.bearing_life import life_exponent, load_for_life
from cqdd_design.gearbox.carrier import slender_bending_arm
from cqdd_design.gearbox.checks import allowables
from cqdd_design.gearbox.checks.allowables import UNEVEN_SHARING
from cqdd_design.gearbox.rolling_contacts import sleeve_turn
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.sizing.frame import Frame

RING_CHECKS = ("CONTACT-RING-PEAK", "CONTACT-RING-CONTINUOUS")
NEEDLE_CHECKS = ("SLEEVE-STATIC", "SLEEVE-LIFE")
PIN_CHECKS = (
    "CONTACT-PIN-PEAK",
    "CONTACT-PIN-CONTINUOUS",
    "PIN-PAPER",
    "PIN-SHARED",
    "PIN-SHEAR-PEAK",
    "PIN-BENDING-PEAK",
    "PIN-BENDING-CONTINUOUS",
    "PIN-BEARING-PEAK",
)
CAM_CHECKS = ("BEARING-STATIC", "BEARING-LIFE")


def ring_reserves(
    frame: Frame, pressure_number: ArrayLike, pitch_radius: ArrayLike, thickness: ArrayLike
) -> dict[str, FloatArray]:
    """Reserves of the ring contact.

    Parameters
    ----------
    pressure_number : array_like
        p^ of :class:`~cqdd_design.sizing.stage_tables.StageTables`.
    pitch_radius, thickness : array_like
        R and b in m.
    """
    number = np.asarray(pressure_number, dtype=float)
    radius, b = np.asarray(pitch_radius, dtype=float), np.asarray(thickness, dtype=float)
    scale = UNEVEN_SHARING * frame.disc_torque * frame.ring_modulus / (b * radius * radius)
    squared = scale * number * number
    limits = frame.limits
    return _held_against(
        frame,
        {
            "CONTACT-RING-PEAK": np.asarray(limits.ring_static.value**2 / squared),
            "CONTACT-RING-CONTINUOUS": np.asarray(
                limits.ring_fatigue.value**2 / (squared * frame.continuous_share)
            ),
        },
    )


def _held_against(frame: Frame, found: dict[str, FloatArray]) -> dict[str, FloatArray]:
    """Reserves over those that are needed, by check."""
    return {check: value / frame.needed(check) for check, value in found.items()}


def pin_reserves_per_radius(
    frame: Frame,
    peak_factor: ArrayLike,
    pin_count: ArrayLike,
    diameter: ArrayLike,
    running_radius: ArrayLike,
    hole_radius: ArrayLike,
    thickness: ArrayLike,
) -> dict[str, FloatArray]:
    """Reserves of the output pins over the pin circle radius R_w, to which all are proportional.

    Parameters
    ----------
    peak_factor : array_like
        k of F = k T/(D N_w R_w), from :func:`~cqdd_design.gearbox.rigid.peak_pin_force_factor`.
    pin_count : array_like
        N_w.
    diameter, running_radius, hole_radius, thickness : array_like
        Nominal diameter of the pin, mean radius of what runs in the hole, hole radius and disc
        thickness, m.

    Returns
    -------
    dict
        1/m by check; contact at the pins depends on the hole, the rest only on the pins.
    """
    k, count = np.asarray(peak_factor, dtype=float), np.asarray(pin_count, dtype=float)
    d, b = np.asarray(diameter, dtype=float), np.asarray(thickness, dtype=float)
    limits, share = frame.limits, frame.continuous_share
    # A bare pin counts there with its nominal diameter.
    runner = d if not frame.needles else 2.0 * np.asarray(running_radius, dtype=float)
    # Force of one pin at R_w = 1 m.
    force = k * frame.disc_torque / count
    uneven = UNEVEN_SHARING * force
    relative = hertz.conformal_equivalent_radius(running_radius, hole_radius)
    pressure = hertz.line_contact_pressure(uneven, b, relative, frame.pin_modulus)
    arm = slender_bending_arm(frame.disc_count, b, frame.spacing, frame.pin_ends, k)
    bending = output_pins.bending_stress(uneven, arm, d)
    paper_shear = allowables.PAPER_SHEAR_SHARE * limits.pin_ultimate
    peak = frame.requirements.peak_torque
    found = {
        "CONTACT-PIN-PEAK": (limits.pin_static.value / pressure) ** 2,
        "CONTACT-PIN-CONTINUOUS": (limits.pin_fatigue.value / pressure) ** 2 / share,
        "PIN-PAPER": count * output_pins.single_shear_torque_per_pin(d, paper_shear, 1.0) / peak,
        "PIN-SHARED": np.asarray(math.pi / 4.0 * d * d * paper_shear / force),
        "PIN-SHEAR-PEAK": limits.shear.value / output_pins.shear_stress(uneven, d),
        "PIN-BENDING-PEAK": limits.bending_peak.value / bending,
        "PIN-BENDING-CONTINUOUS": limits.bending_continuous.value / (bending * share),
        "PIN-BEARING-PEAK": limits.bearing.value / output_pins.bearing_pressure(uneven, runner, b),
    }
    return _held_against(frame, found)


def needle_reserves_per_radius(
    frame: Frame,
    peak_factor: ArrayLike,
    pin_count: ArrayLike,
    ratings: tuple[FloatArray, FloatArray],
    sleeve_diameter: ArrayLike,
) -> dict[str, FloatArray]:
    """Reserves of needles inside sleeves over R_w, none where the pins of the frame are bare.

    They turn as at the largest eccentricity there can be: a little more than they do.

    Parameters
    ----------
    peak_factor, pin_count
        As :func:`pin_reserves_per_radius`.
    ratings : tuple of array
        C0 and C of the cage, N, from :meth:`~.bought_parts.PinSize.cage_ratings`.
    sleeve_diameter : array_like
        m.
    """
    if not frame.needles:
        return {}
    k, count = np.asarray(peak_factor, dtype=float), np.asarray(pin_count, dtype=float)
    uneven = UNEVEN_SHARING * k * frame.disc_torque / count
    throw = allowables.SHORTENING_MOST * frame.outer_radius / (frame.lobe_count + 1)
    asked = frame.requirements
    speed = sleeve_turn(frame.lobe_count, throw, sleeve_diameter) * asked.held_speed
    static, dynamic = ratings
    lasting = load_for_life(dynamic, asked.life_hours, speed, life_exponent("roller"))
    found = {
        "SLEEVE-STATIC": static / (allowables.STATIC_SAFETY * uneven),
        "SLEEVE-LIFE": np.asarray(lasting / (uneven * frame.continuous_share)),
    }
    return _held_against(frame, found)


def cam_load(
    frame: Frame,
    pitch_radius: ArrayLike,
    eccentricity: ArrayLike,
    radial_number: ArrayLike,
) -> FloatArray:
    """Largest cam bearing load at the peak torque, N.

    Parameters
    ----------
    pitch_radius, eccentricity : array_like
        R and e in m.
    radial_number : array_like
        Largest radial part over T/R, from `StageTables.cam_radial_peak`.
    """
    torque = frame.disc_torque
    across = torque / (frame.lobe_count * np.asarray(eccentricity, dtype=float))
    radius = np.asarray(pitch_radius, dtype=float)
    along = torque / radius * np.asarray(radial_number, dtype=float)
    return np.asarray(np.hypot(across, along))
