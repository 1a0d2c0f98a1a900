"""The head of the page, and what follows from the values of a design."""

from __future__ import annotations

from cqdd_design.report.ink.numbers import TIMES, millimetres, significant, with_unit
from cqdd_design.report.input import ReportInput
from cqdd_design.report.judgement.duty import duty_text
from cqdd_design.solids.part import overall_size
from cqdd_design.terms import term


def head_facts(results: ReportInput, least_margin: str) -> tuple[tuple[str, str, str], ...]:
    """Name, value and remark of what a reader wants at a glance."""
    design, reducer, bodies = results.design, results.design.reducer, results.bodies
    asked = design.requirements
    duty = duty_text(asked)
    facts = [
        ("Ratio", f"{reducer.ratio} : 1", "ring held, output reversed"),
        (
            "Peak torque",
            with_unit(asked.peak_torque, "N*m"),
            f"duty {duty}" if duty else f"{with_unit(asked.continuous_torque, 'N*m')} continuous",
        ),
        (
            "Envelope",
            f"\u2300 {significant(1e3 * reducer.ring.outer_diameter)} {TIMES} "
            f"{millimetres(reducer.pack_length, 4)}",
            "ring and disc pack",
        ),
        (
            "Discs",
            f"{reducer.disc_count} {TIMES} {millimetres(reducer.disc_thickness, 4)}",
            reducer.disc_material,
        ),
        ("Least margin", least_margin, "1 is on the limit"),
    ]
    if bodies is not None:
        inertia = bodies.inertia
        mass = with_unit(inertia.mass, "kg", 3)
        counted = "with the motor"
        if inertia.motor_by_catalogue is not None:
            counted = "motor by its catalogue, without its cover"
        elif inertia.motor_missing:
            counted = "without the motor"
        facts.insert(4, ("Mass", mass, counted))
        if not inertia.motor_missing:
            diameter, length = overall_size(bodies.parts)
            size = f"\u2300 {significant(1e3 * diameter)} {TIMES} {millimetres(length, 3)}"
            facts.insert(3, ("Actuator", size, "over everything"))
    return tuple(facts)


def derived_values(results: ReportInput) -> tuple[tuple[str, str, str], ...]:
    """Words, symbol and value of what the values of a design lead to."""
    analysis = results.gearbox
    geometry, bearing = analysis.geometry, analysis.cam_bearing.bearing
    thinnest = geometry.ligaments[0]
    area = with_unit(1e6 * geometry.profile_area, "mm^2", 6)
    lengths: tuple[tuple[str, str, float], ...] = (
        (term("undercut_radius_limit_mm").words, "", geometry.undercut_radius_limit),
        (term("disc_min_convex_radius_mm").words, "", geometry.disc_min_convex_radius),
        (term("disc_min_concave_radius_mm").words, "", geometry.disc_min_concave_radius),
        (term("ring_min_concave_radius_mm").words, "", geometry.ring_min_concave_radius),
        (term("hole_diameter_mm").words, "d_hole", geometry.hole_diameter),
        (f"thinnest ligament, {thinnest.where}", "", thinnest.thickness),
        ("length of the lobed outline", "", geometry.profile_perimeter),
        ("free length of the output pins", "L", analysis.output_pins.span),
        (f"bore for the cam bearing {bearing.designation}", "", bearing.outer_diameter),
    )
    if geometry.column_hole_diameter:
        lengths += (("diameter of the holes for columns", "", geometry.column_hole_diameter),)
    shown = [(words, symbol, millimetres(length)) for words, symbol, length in lengths]
    return (
        ("signed ratio, ring held", "i", significant(geometry.ratio)),
        ("shortening coefficient e (n + 1)/R", "K_1", significant(geometry.shortening_coefficient)),
        *shown[:6],
        ("area inside the lobed outline", "", area),
        *shown[6:],
    )
