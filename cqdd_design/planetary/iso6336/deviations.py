"""Tolerances of ISO 1328-1:2013, which ISO 6336-1 takes its tooth deviations from.

Each is the class-5 formula times sqrt(2)^(A - 5) for flank tolerance class A, unrounded. Valid for
5 to 1000 teeth, d 5 to 15000 mm, m_n 0.5 to 70 mm, b 4 to 1200 mm, classes 1 to 11 (clause 1).
"""

from __future__ import annotations

import math

from cqdd_design.errors import UsageError


def _step(accuracy_class: int) -> float:
    if not 1 <= accuracy_class <= 11:
        raise UsageError(
            f"accuracy class: {accuracy_class} is outside ISO 1328-1, which has classes 1 to 11; "
            "ground gears reach 5, good hobbed ones 7."
        )
    return math.sqrt(2.0) ** (accuracy_class - 5)


def single_pitch(module: float, diameter: float, accuracy_class: int) -> float:
    """Single pitch tolerance f_pT in m, eq. 5: (0.001 d + 0.4 m_n + 5) um at class 5, d, m_n in mm.

    Parameters
    ----------
    module, diameter : float
        m_n and reference diameter d in m; the sign of d is ignored.
    accuracy_class : int
        1 (best) to 11.

    Examples
    --------
    >>> round(single_pitch(1e-3, 12e-3, 5) * 1e6, 3)
    5.412
    """
    millimetres = 0.001 * abs(diameter) * 1e3 + 0.4 * module * 1e3 + 5.0
    return millimetres * _step(accuracy_class) * 1e-6


def profile_form(module: float, accuracy_class: int) -> float:
    """Profile form tolerance f_falphaT in m, eq. 8: (0.55 m_n + 5) um at class 5, m_n in mm."""
    return (0.55 * module * 1e3 + 5.0) * _step(accuracy_class) * 1e-6


def helix_slope(diameter: float, face_width: float, accuracy_class: int) -> float:
    """Helix slope tolerance f_HbetaT in m, eq. 10: (0.05 sqrt(d) + 0.35 sqrt(b) + 4) um at class 5.

    Parameters
    ----------
    diameter, face_width : float
        d and b in m (in mm inside the formula).
    accuracy_class : int
        1 (best) to 11.
    """
    root_sum = 0.05 * math.sqrt(abs(diameter) * 1e3) + 0.35 * math.sqrt(face_width * 1e3)
    return (root_sum + 4.0) * _step(accuracy_class) * 1e-6
