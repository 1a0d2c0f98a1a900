"""What a key of results is called in words, and the unit its last part stands for.

Keys carry their unit (``ring_pressure_max_MPa``); people read "greatest ring pressure" in MPa. The
command line and the report take both from here, so that one thing has one name. Units are written
as design files take them (``N*m``, ``kg*m^2``, ``degC``).
"""

from __future__ import annotations

from typing import NamedTuple

AMPLE, AMPLE_MARGIN = "ample", 1000.0
"""What a margin is called that is so great that its digits tell nothing."""

#: Last part of a key, and its unit; of two that fit, the longer one.
UNITS = {
    "Nm_per_arcmin": "N*m/arcmin",
    "Nm_per_rad": "N*m/rad",
    "mm3_per_Nm": "mm^3/(N*m)",
    "K_per_W": "K/W",
    "nm_per_N": "nm/N",
    "rad_per_s": "rad/s",
    "kg_m3": "kg/m^3",
    "um_mK": "um/(m*K)",
    "W_mK": "W/(m*K)",
    "J_kgK": "J/(kg*K)",
    "Nm_A": "N*m/A",
    "Nms_rad": "N*m*s/rad",
    "K_W": "K/W",
    "rpm_V": "rpm/V",
    "mm2_s": "mm^2/s",
    "1_GPa": "1/GPa",
    "MPa_m_s": "MPa*m/s",
    "kgm2": "kg*m^2",
    "kgm": "kg*m",
    "mm2": "mm^2",
    "mm3": "mm^3",
    "arcmin": "arcmin",
    "mrad": "mrad",
    "degC": "degC",
    "GPa": "GPa",
    "MPa": "MPa",
    "ohm": "ohm",
    "rpm": "rpm",
    "deg": "deg",
    "min": "min",
    "Nm": "N*m",
    "um": "um",
    "mm": "mm",
    "kg": "kg",
    "uH": "uH",
    "N": "N",
    "W": "W",
    "J": "J",
    "V": "V",
    "A": "A",
}

#: Keys, without their unit, whose own words do not say enough or not in this order.
PHRASES = {
    "lobe_count": "lobes on the disc",
    "ring_tooth_count": "teeth of the ring",
    "ratio": "ratio (negative: the output turns back)",
    "thinnest_ligament_where": "where it is thinnest",
    "hole_diameter": "output hole diameter",
    "disc_min_convex_radius": "least convex radius of the disc",
    "disc_min_concave_radius": "least concave radius of the disc",
    "ring_min_concave_radius": "least concave radius of the ring",
    "output_pressure_max": "greatest pressure of pins in holes",
    "ring_pressure_max": "greatest pressure at the ring",
    "output_pin_bending_max": "greatest bending stress of output pins",
    "output_pin_force_max": "greatest output pin force",
    "paper_torque_per_pin": "torque of one pin, by the paper",
    "paper_torque_total": "torque of all pins, by the paper",
    "paper_shear": "shear stress, by the paper",
    "shared_torque_capacity": "torque for shear, forces shared by position",
    "bending_torque_capacity": "torque for bending, forces shared so",
    "bending_stress_max": "greatest bending stress, peak torque",
    "bending_stress_continuous": "greatest bending stress, continuous torque",
    "shear_stress_max": "greatest shear stress",
    "bearing_pressure_max": "greatest pressure in the carrier",
    "peak_force_factor": "peak force over that of equal shares",
    "load_peak": "load at the peak torque",
    "load_continuous": "load at the continuous torque",
    "L10h": "basic rating life L10",
    "set_L10h": "basic rating life L10 together",
    "L10h_at_greatest_load": "life L10 at the greatest load",
    "L10h_of_rigid_law": "life L10 at the rigid law's load",
    "friction_tooth": "friction coefficient of teeth",
    "friction_pin": "friction coefficient of pins",
    "backdrives": "can be driven from the output",
    "preload_overlap": "overlap of parts without load",
    "efficiency_forward": "efficiency, driven by the motor",
    "efficiency_backward": "efficiency, driven by the output",
    "loss_torque": "loss of torque, driven by the motor",
    "loss_torque_backward": "loss of torque, driven by the output",
    "transmission_error_pp": "transmission error, peak to peak",
    "transmission_error_unloaded_pp": "transmission error without load, peak to peak",
    "torque_ripple_pp": "torque ripple, peak to peak",
    "unloaded_torque": "torque to turn it without load",
    "preload_force_max": "greatest contact force without load",
    "pressure_reserve": "reserve of pressure at the required hours",
    "cam_approach": "closing of the cam bearing",
    "ring_approach": "closing at the ring",
    "wear_rate_low": "wear rate, at least",
    "wear_rate_high": "wear rate, at most",
    "backdrive_static": "backdrive torque, breakaway",
    "backdrive_dynamic": "backdrive torque, running",
    "no_load_speed": "no-load speed",
    "rated_power": "rated electrical power",
    "efficiency_peak": "greatest efficiency",
    "actuator_inertia": "inertia, at the motor",
    "position_bandwidth_45deg": "position bandwidth, ±45°",
    "position_bandwidth_5deg": "position bandwidth, ±5°",
    "undercut_radius_limit": "largest tooth radius before undercut",
    "uneven_sharing": "most loaded disc over the mean",
    "teeth_in_contact": "ring teeth that carry together",
    "life_hours": "required life",
    "backdrive_load_independent": "of that, losses without load",
    "backdrive_load_share": "loss of torque from the output over its torque",
    "backdrive_static_ratio": "friction at rest over friction turning",
    "backdrive_speed": "output speed of that",
    "load_independent": "of that, without load",
    "winding_to_ambient": "resistance from winding to ambient",
    "hours": "required life",
    "required_hours": "required life",
    "duty_assumed": "duty assumed",
    "lambda": "film thickness over roughness (lambda)",
    "lambda_min": "least film thickness over roughness",
    "friction_by_film": "friction coefficient by the film",
    "asperity_share": "share of load on asperities",
    "thickness": "film thickness",
    "thickness_min": "least film thickness",
    "reciprocity": "error of reciprocity",
    "cycle": "thermal cycle",
    "bore_diameter": "bore",
    "youngs_modulus": "Young's modulus",
    "poisson_ratio": "Poisson's ratio",
    "rms_roughness": "r.m.s. roughness",
}
_TIMES = {"hours": "h", "required_hours": "h", "life_hours": "h", "L10h": "h"} | {
    f"{before}L10h{after}": "h"
    for before, after in (("set_", ""), ("", "_at_greatest_load"), ("", "_of_rigid_law"))
}
_ENDINGS = {"_max": "greatest {}", "_min": "least {}", "_pp": "{}, peak to peak"}
_ESTIMATES = {"_low": ", at least", "_high": ", at most"}


_MEASURED = {
    "continuous_torque": "continuous torque, standing",
    "torque_ripple": "torque ripple, half of peak to peak",
}


class Term(NamedTuple):
    """A quantity in words.

    Attributes
    ----------
    words : str
        In lower case, as in running text.
    unit : str
        Empty where there is none.
    """

    words: str
    unit: str


def term(key: str) -> Term:
    """The words and the unit of a key.

    Parameters
    ----------
    key : str
        One key of results, not a path of them.

    Examples
    --------
    >>> term("ring_force_max_N")
    Term(words='greatest ring force', unit='N')
    >>> term("depth_um_low")
    Term(words='depth, at least', unit='um')
    """
    after = ""
    for ending, words in _ESTIMATES.items():
        if key.endswith(ending):
            key, after = key.removesuffix(ending), words
    name, unit = key, _TIMES.get(key, "")
    for part in sorted(UNITS, key=len, reverse=True):
        if key.endswith(f"_{part}") and key not in PHRASES:
            name, unit = key.removesuffix(f"_{part}"), UNITS[part]
            break
    return Term(_words(name) + after, unit)


def measurement(name: str) -> str:
    """A measurement of the test bench in words: where it is not the gearbox's result of that name.

    Examples
    --------
    >>> measurement("torque_ripple")
    'torque ripple, half of peak to peak'
    >>> measurement("backdrive_static")
    'backdrive torque, breakaway'
    """
    return _MEASURED.get(name) or term(name).words


def hardly(value: float, unit: str) -> str:
    """What stands for a life of less than an hour, whose digits mean nothing; else nothing.

    Every output asks it before it prints a number, so that all say the same; JSON and CSV, which
    are read by programs, keep the number.

    Examples
    --------
    >>> hardly(1.18e-5, "h"), hardly(677.0, "h"), hardly(0.5, "N*m")
    ('under 1', '', '')
    """
    return "under 1" if unit == "h" and 0.0 <= value < 1.0 else ""


def life_text(hours: float, digits: int = 4) -> str:
    """A life in a sentence.

    Examples
    --------
    >>> life_text(677.25), life_text(360814.2, 3), life_text(1.18e-5)
    ('677.2 h', '360814 h', 'under 1 h')
    """
    shown = f"{hours:.{digits}g}"
    if "e" in shown and hours < 1e7:
        shown = f"{hours:.0f}"
    return f"{hardly(hours, 'h') or shown} h"


def _words(name: str) -> str:
    if name in PHRASES:
        return PHRASES[name]
    for ending, form in _ENDINGS.items():
        if name.endswith(ending):
            return form.format(_words(name.removesuffix(ending)))
    return name.replace("_", " ")
