"""The actuator in the report: torque over speed with its limits, efficiency, parameters."""

from __future__ import annotations

import math

from cqdd_design.actuator.bench import BenchResult
from cqdd_design.actuator.demands import PEAK_AT_SPEED, Demand, asked_points, duty_heat
from cqdd_design.actuator.density import torques_of_drive
from cqdd_design.actuator.envelope import (
    LimitCurve,
    driver_torque,
    limit_curves,
)
from cqdd_design.actuator.joint_side import idle_speed
from cqdd_design.actuator.operating import (
    DRIVER,
    HEAT,
    PEAK,
    VOLTAGE,
    holds_itself,
    output_torque,
)
from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.design import Requirements
from cqdd_design.report.actuator.bench_figures import efficiency_maps
from cqdd_design.report.actuator.parameter_rows import counted, parameter_rows
from cqdd_design.report.ink.axes import BELOW, Legend, Panel, linear_axis
from cqdd_design.report.ink.numbers import RPM, with_unit
from cqdd_design.report.ink.page import Values
from cqdd_design.report.ink.svg import Figure, Words, points_of, polyline

_WIDTH, _LEFT, _RIGHT = 760.0, 60.0, 18.0


def actuator_view(
    parameters: ActuatorParameters, bench: BenchResult, requirements: Requirements
) -> Values:
    """Envelope and parameters; each point is a demand with its sentence.

    Parameters
    ----------
    bench : BenchResult
        Of the same actuator.
    requirements : Requirements
        Its operating points are judged.
    """
    points = asked_points(parameters, requirements)
    drive, thermal = parameters.drive, parameters.thermal
    ratio = abs(parameters.gear.ratio)
    unrubbed = torques_of_drive(parameters.motor, drive, ratio, thermal.ambient)
    lead = (
        f"Torque at the output with the gearbox's friction taken off, on "
        f"{with_unit(drive.supply_voltage, 'V')} with at most "
        f"{with_unit(drive.current_limit, 'A')}: without friction the driver's limit would be "
        f"{with_unit(unrubbed['driver_limited_Nm'], 'N*m', 3)}. Heat by two thermal nodes in "
        f"{with_unit(thermal.ambient, 'degC')}, the winding at most at "
        f"{with_unit(thermal.most, 'degC')}, copper in the winding, friction and iron in the "
        "housing."
    )
    holds = holds_itself(parameters)
    if holds:
        lead += " The gearbox holds itself: no power comes back from the output."
    grid = next((m for m in bench.metrics if m.name == "efficiency_peak" and m.trace), None)
    return {
        "lead": lead,
        "envelope": envelope_figure(parameters, points),
        "points": tuple((point, sentence(parameters, point)) for point in points),
        "duty": _duty_heat(parameters, requirements),
        "efficiency": () if grid is None else efficiency_maps(grid, driving_only=holds),
        "parameters": parameter_rows(parameters),
        "counted": counted(parameters),
    }


_LIMITS = {
    DRIVER: "the driver's current",
    VOLTAGE: "the supply voltage",
    PEAK: "the motor's peak torque",
    HEAT: "heat",
}


def sentence(parameters: ActuatorParameters, point: Demand) -> str:
    """Whether a point lies inside, what it takes, and what binds where it does not."""
    found, drive = point.found, parameters.drive
    at = f"at {with_unit(point.speed * RPM, 'rpm')}" if point.speed > 0.0 else "at standstill"
    how = ", generating," if point.generating else ""
    head = f"{with_unit(point.torque, 'N*m')} {at}{how}"
    takes = (
        f"{with_unit(abs(found.need.current), 'A', 3)} of "
        f"{with_unit(drive.current_limit, 'A', 3)} and "
        f"{with_unit(abs(found.need.voltage), 'V', 3)} of "
        f"{with_unit(drive.supply_voltage, 'V', 3)}"
    )
    lasts = duration(found.lasts)
    if found.inside:
        held = f"they can be held for {lasts} from cold"
        if math.isinf(found.lasts):
            held = "winding and drive hold them for ever, for other parts see THERMAL-RISE"
        return f"{head} are inside: {takes}; {held}."
    words = [_LIMITS[limit] for limit in found.binding]
    binds = f"{' and '.join(words)} {'bind' if len(words) > 1 else 'binds'}"
    told = f"{head} are outside, as {binds}: they take {takes}."
    if point.torque > 0.0 and not point.generating:
        ever = " for ever" if point.lasting else ""
        told += f" {with_unit(found.most, 'N*m', 3)} is the most there{ever}."
    if found.lasts > 0.0:
        told += f" From cold they can be held for {lasts}."
    return told


def duration(seconds: float) -> str:
    r"""A time in words.

    Examples
    --------
    >>> duration(41.2), duration(400.0), duration(9000.0)
    ('41\u202fs', '6.7\u202fmin', '2.5\u202fh')
    """
    if seconds < 120.0:
        return with_unit(seconds, "s", 2)
    if seconds < 7200.0:
        return with_unit(seconds / 60.0, "min", 2)
    return with_unit(seconds / 3600.0, "h", 2)


def _duty_heat(parameters: ActuatorParameters, requirements: Requirements) -> str:
    """A sentence on the heat of the duty cycle; empty without one."""
    found = duty_heat(parameters, requirements)
    if found is None:
        return ""
    most = parameters.thermal.most
    head = f"Over the duty cycle the current is {with_unit(found.current, 'A', 3)} r.m.s.: "
    if math.isinf(found.winding):
        return f"{head}the winding would heat without end, so that heat binds."
    verdict = "within" if found.winding <= most else "above, so that heat binds,"
    return (
        f"{head}by the two nodes of winding and housing the winding would settle at "
        f"{with_unit(found.winding, 'degC', 3)}, {verdict} its limit of {with_unit(most, 'degC')}; "
        "THERMAL-RISE has it by the network of all parts."
    )


def _named(parameters: ActuatorParameters, curve: LimitCurve) -> tuple[str, str]:
    """Name and style of a limit."""
    if not math.isnan(curve.temperature):
        cold = curve.temperature == parameters.thermal.ambient
        name = f"winding at {with_unit(curve.temperature, 'degC')}"
        return name, "series-1" if cold else "series-2"
    if math.isinf(curve.seconds):
        return "for ever", "held"
    return f"{with_unit(curve.seconds, 's')} from cold", f"held-{curve.seconds:.0f}"


def envelope_figure(parameters: ActuatorParameters, points: tuple[Demand, ...]) -> Figure:
    """Torque over speed at the output with every limit and the points asked for."""
    fastest = idle_speed(parameters, parameters.thermal.most)
    top = 1.04 * max(fastest, *(point.speed for point in points))
    curves = limit_curves(parameters, top)
    named = [_named(parameters, curve) for curve in curves]
    driver = driver_torque(parameters, 0.5 * top)
    levels = [(f"driver's limit, {with_unit(driver, 'N*m', 3)}", driver)]
    if math.isfinite(parameters.motor.peak_torque):
        peak = float(output_torque(parameters, parameters.motor.peak_torque, 0.5 * top))
        levels.append((f"motor's peak by its catalogue, {with_unit(peak, 'N*m', 3)}", peak))
    legend = Legend(named, _LEFT, _WIDTH)
    most = max(
        *(float(curve.torque.max()) for curve in curves),
        *(point.torque for point in points),
        *(level for _, level in levels),
    )
    panel = Panel(
        "envelope",
        linear_axis(0.0, top * RPM, "output speed, rpm", most=9, tight=True),
        linear_axis(0.0, 1.05 * most, "output torque, N·m", most=7),
        _LEFT,
        14.0 + legend.height,
        _WIDTH - _LEFT - _RIGHT,
        330.0,
    )
    body = [*panel.frame(), *_curves(panel, curves, named)]
    body += _labelled(panel, curves, points, levels)
    body.append(legend.render())
    told = "; ".join(
        f"{', '.join(names)} {where}"
        for inside, where in ((True, "inside"), (False, "outside"))
        if (names := [point.name for point in points if point.found.inside is inside])
    )
    standing = "the requirements name no speed for the peak torque, so it stands at standstill"
    if any(point.name == PEAK_AT_SPEED for point in points):
        standing = "the peak torque stands at its speed and at standstill"
    words = Words(
        "envelope",
        "Torque over speed",
        "Output torque over output speed on "
        f"{with_unit(parameters.drive.supply_voltage, 'V')} with the limits of driver, motor and "
        f"heat. Points of the requirements: {told}.",
        "The motor driving. Filled points lie inside, hollow ones outside; "
        f"{standing}, where breakaway takes its share. Lines of heat follow another limit where it "
        "binds first."
        + (
            " Points where the output drives stand by their size."
            if any(point.generating for point in points)
            else ""
        ),
    )
    return words.figure(_WIDTH, panel.bottom + BELOW, body)


def _curves(
    panel: Panel, curves: tuple[LimitCurve, ...], named: list[tuple[str, str]]
) -> list[str]:
    """The curves, the first on top, over the area that can be held for ever."""
    drawn = [(curve, class_) for curve, (_, class_) in zip(curves, named, strict=True)]
    body = []
    held = next((curve for curve, class_ in drawn if class_ == "held"), None)
    if held is not None:
        xs, ys = panel.places(held.speed * RPM, held.torque)
        corners = [*points_of(xs, ys), (float(xs[-1]), panel.bottom), (float(xs[0]), panel.bottom)]
        body.append(polyline(corners, "held-area", closed=True))
    return body + [panel.curve(c.speed * RPM, c.torque, class_) for c, class_ in drawn[::-1]]


def _labelled(
    panel: Panel,
    curves: tuple[LimitCurve, ...],
    points: tuple[Demand, ...],
    levels: list[tuple[str, float]],
) -> list[str]:
    """Levels and points with labels that keep clear of each other and of the curves."""
    labels, body = panel.labels(), []
    for curve in curves:
        labels.avoid_curve(panel, curve.speed * RPM, curve.torque)
    for _, level in levels:
        body.append(panel.across(level))
        y = panel.place(0.0, level)[1]
        labels.avoid([panel.left, panel.right], [y, y])
    places = [panel.place(point.speed * RPM, point.torque) for point in points]
    for x, y in places:
        labels.avoid([x, x + 1.0], [y, y])
    for point, place in zip(points, places, strict=True):
        style = "dot inside" if point.found.inside else "dot outside"
        body.append(panel.dot(point.speed * RPM, point.torque, style))
        body.append(labels.place(place, point.name, "legend"))
    for name, level in levels:
        place = panel.place(0.72 * panel.x.high, level)
        body.append(labels.place(place, name, "limit-label"))
    return body
