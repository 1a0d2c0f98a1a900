"""The actuator in the report: torque over speed with its limits, efficiency, parameters."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from cqdd_design.actuator.bench import BenchResult
from cqdd_design.actuator.motor import no_load_speed
from cqdd_design.actuator.operating import (
    DRIVER,
    HEAT,
    PEAK,
    VOLTAGE,
    Judgement,
    envelope_torque,
    held_torque,
    holds_itself,
    judge,
    output_torque,
    torque_from_current,
)
from cqdd_design.actuator.parameters import ActuatorParameters, FloatArray
from cqdd_design.actuator.thermal import runaway_current, steady_state
from cqdd_design.design import Requirements
from cqdd_design.report.actuator.actuator_rows import ParameterRow, counted, parameter_rows
from cqdd_design.report.actuator.bench_charts import Mark
from cqdd_design.report.actuator.bench_figures import efficiency_maps
from cqdd_design.report.ink.axes import Labels, Panel, legend, legend_rows, linear_axis
from cqdd_design.report.ink.numbers import with_unit
from cqdd_design.report.ink.svg import Figure, points_of, polyline

_RPM = 30.0 / math.pi
_WIDTH, _LEFT, _RIGHT = 760.0, 60.0, 18.0
OVERLOADS = (10.0, 60.0)
"""Times of the overload lines, s."""


@dataclass(frozen=True)
class Asked:
    """An operating point of the requirements.

    Attributes
    ----------
    name : str
    torque, speed : float
        At the output, sizes, N m and rad/s.
    generating : bool
        Whether the output drives the motor there.
    found : Judgement
    sentence : str
    """

    name: str
    torque: float
    speed: float
    generating: bool
    found: Judgement
    sentence: str


@dataclass(frozen=True)
class ActuatorView:
    """What the section shows.

    Attributes
    ----------
    lead : str
    envelope : Figure
    points : tuple of Asked
    duty : str
        A sentence on the heat of the duty cycle; empty without one.
    efficiency : tuple of Figure
    parameters : tuple of (group, rows)
    counted : str
        How many parameters come from where.
    """

    lead: str
    envelope: Figure
    points: tuple[Asked, ...]
    duty: str
    efficiency: tuple[Figure, ...]
    parameters: tuple[tuple[str, tuple[ParameterRow, ...]], ...]
    counted: str


def actuator_view(
    parameters: ActuatorParameters, bench: BenchResult, requirements: Requirements
) -> ActuatorView:
    """Values of the section.

    Parameters
    ----------
    parameters : ActuatorParameters
    bench : BenchResult
        Of the same actuator.
    requirements : Requirements
        Its operating points are judged.
    """
    points = asked_points(parameters, requirements)
    motor, drive, thermal = parameters.motor, parameters.drive, parameters.thermal
    whole = motor.torque_constant * drive.current_limit * abs(parameters.gear.ratio)
    lead = (
        f"Torque at the output with the gearbox's friction taken off, on "
        f"{with_unit(drive.supply_voltage, 'V')} with at most "
        f"{with_unit(drive.current_limit, 'A')}: without friction the driver's limit would be "
        f"{with_unit(whole, 'N*m', 3)}. Heat by two thermal nodes in "
        f"{with_unit(thermal.ambient, 'deg')}C, the winding at most at "
        f"{with_unit(thermal.most, 'deg')}C, copper in the winding, friction and iron in the "
        "housing."
    )
    holds = holds_itself(parameters)
    if holds:
        lead += " The gearbox holds itself: no power comes back from the output."
    grid = next((m for m in bench.metrics if m.name == "efficiency_peak" and m.trace), None)
    return ActuatorView(
        lead=lead,
        envelope=envelope_figure(parameters, points),
        points=points,
        duty=_duty_heat(parameters, requirements),
        efficiency=() if grid is None else efficiency_maps(grid, driving_only=holds),
        parameters=parameter_rows(parameters),
        counted=counted(parameters),
    )


def asked_points(parameters: ActuatorParameters, requirements: Requirements) -> tuple[Asked, ...]:
    """Peak torque at standstill, continuous torque at the input speed, every step of the duty."""
    n = abs(parameters.gear.ratio)
    turning = requirements.input_speed / n
    found = [
        _asked(parameters, "peak torque", requirements.peak_torque, 0.0, lasting=False, hot=False),
        _asked(
            parameters,
            "continuous torque",
            requirements.continuous_torque,
            turning,
            lasting=True,
            hot=True,
        ),
    ]
    for k, step in enumerate(requirements.duty, 1):
        drives = step.torque * step.speed >= 0.0
        torque = abs(step.torque) * (1.0 if drives else -1.0)
        found.append(
            _asked(parameters, f"duty {k}", torque, abs(step.speed), lasting=False, hot=True)
        )
    return tuple(found)


_LIMITS = {
    DRIVER: "the driver's current",
    VOLTAGE: "the supply voltage",
    PEAK: "the motor's peak torque",
    HEAT: "heat",
}


def _asked(
    parameters: ActuatorParameters,
    name: str,
    torque: float,
    speed: float,
    *,
    lasting: bool,
    hot: bool,
) -> Asked:
    found = judge(parameters, torque, speed, lasting=lasting, hot=hot)
    at = f"at {with_unit(speed * _RPM, 'rpm')}" if speed > 0.0 else "at standstill"
    how = ", generating," if torque < 0.0 else ""
    head = f"{with_unit(abs(torque), 'N*m')} {at}{how}"
    takes = (
        f"{with_unit(abs(found.need.current), 'A', 3)} of "
        f"{with_unit(parameters.drive.current_limit, 'A', 3)} and "
        f"{with_unit(abs(found.need.voltage), 'V', 3)} of "
        f"{with_unit(parameters.drive.supply_voltage, 'V', 3)}"
    )
    words = [_LIMITS[limit] for limit in found.binding]
    lasts = duration(found.lasts)
    if found.inside:
        kept = "for ever" if math.isinf(found.lasts) else f"for {lasts} from cold"
        sentence = f"{head} are inside: {takes}; they can be held {kept}."
    else:
        binds = f"{' and '.join(words)} {'bind' if len(words) > 1 else 'binds'}"
        sentence = f"{head} are outside, as {binds}: they take {takes}."
        if torque > 0.0:
            ever = " for ever" if lasting else ""
            sentence += f" {with_unit(found.most, 'N*m', 3)} is the most there{ever}."
        if found.lasts > 0.0:
            sentence += f" From cold they can be held for {lasts}."
    return Asked(name, abs(torque), speed, torque < 0.0, found, sentence)


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
    """Where the winding settles over the duty cycle, by its mean losses."""
    if not requirements.duty:
        return ""
    most = parameters.thermal.most
    squares = heat = 0.0
    for step in requirements.duty:
        drives = step.torque * step.speed >= 0.0
        torque = abs(step.torque) * (1.0 if drives else -1.0)
        need = judge(parameters, torque, abs(step.speed), lasting=False, hot=True).need
        squares += step.share * need.current**2
        heat += step.share * need.heat
    current = math.sqrt(squares)
    head = f"Over the duty cycle the current is {with_unit(current, 'A', 3)} r.m.s.: "
    if current >= runaway_current(parameters.motor, parameters.thermal):
        return f"{head}the winding would heat without end, so that heat binds."
    winding, _ = steady_state(parameters.motor, parameters.thermal, current, heat)
    verdict = "within" if winding <= most else "above, so that heat binds,"
    return (
        f"{head}the winding would settle at {with_unit(winding, 'deg', 3)}C, {verdict} its limit "
        f"of {with_unit(most, 'deg')}C."
    )


@dataclass(frozen=True)
class EnvelopeCurve:
    """One curve of the envelope: output speeds in rad/s, torques in N m, name and style."""

    label: str
    speed: FloatArray
    torque: FloatArray
    class_: str


def envelope_curves(parameters: ActuatorParameters, top: float) -> tuple[EnvelopeCurve, ...]:
    """What the figure draws up to an output speed, rad/s; torques above zero only.

    Heat lines follow voltage, driver or motor where these bind first, and are left out where they
    always do.
    """
    thermal = parameters.thermal
    slow = parameters.friction.stribeck_speed / abs(parameters.gear.ratio)
    speed = np.unique(np.r_[np.linspace(0.0, top, 180), slow * np.linspace(0.0, 3.0, 16)])
    cold = envelope_torque(parameters, speed, thermal.ambient)
    hot = envelope_torque(parameters, speed, thermal.most)
    found = [
        _kept(f"winding at {with_unit(thermal.ambient, 'deg')}C", speed, cold, "series-1"),
        _kept(f"winding at {with_unit(thermal.most, 'deg')}C", speed, hot, "series-2"),
    ]
    bound = np.maximum(cold, hot)
    if math.isfinite(parameters.motor.peak_torque):
        bound = np.minimum(bound, output_torque(parameters, parameters.motor.peak_torque, speed))
    coarse = np.unique(np.r_[0.0, slow * np.array([0.5, 1.0, 1.5, 2.0]), np.linspace(0.0, top, 40)])
    for seconds, class_ in ((math.inf, "held"), *((t, f"held-{t:.0f}") for t in OVERLOADS[::-1])):
        torque = held_torque(parameters, coarse, seconds)
        level = np.interp(coarse, speed, bound)
        # A heat limit at the driver's own limit says nothing.
        if not np.any(torque < 0.999 * level):
            continue
        name = "for ever" if math.isinf(seconds) else f"{with_unit(seconds, 's')} from cold"
        torque = np.minimum(np.interp(speed, coarse, torque), bound)
        found.append(_kept(name, speed, torque, class_))
    return tuple(found)


def _kept(label: str, speed: FloatArray, torque: FloatArray, class_: str) -> EnvelopeCurve:
    """A curve up to where it meets zero."""
    below = np.flatnonzero(torque <= 0.0)
    if not below.size or below[0] == 0:
        return EnvelopeCurve(label, speed, np.maximum(torque, 0.0), class_)
    k = int(below[0])
    share = float(torque[k - 1] / (torque[k - 1] - torque[k]))
    at = float(speed[k - 1] + share * (speed[k] - speed[k - 1]))
    return EnvelopeCurve(label, np.r_[speed[:k], at], np.r_[torque[:k], 0.0], class_)


def envelope_figure(parameters: ActuatorParameters, points: tuple[Asked, ...]) -> Figure:
    """Torque over speed at the output with every limit and the points asked for."""
    motor, thermal, drive = parameters.motor, parameters.thermal, parameters.drive
    friction, n = parameters.friction, abs(parameters.gear.ratio)
    fastest = no_load_speed(
        motor,
        drive.supply_voltage,
        temperature=thermal.most,
        drag=friction.motor_coulomb + friction.output_coulomb / n,
        viscous=friction.motor_viscous + friction.output_viscous / n**2,
    )
    top = 1.04 * max(fastest / n, *(point.speed for point in points))
    curves = envelope_curves(parameters, top)
    driver = float(
        torque_from_current(parameters, drive.current_limit, 0.5 * top, thermal.ambient)[0]
    )
    levels = [(f"driver's limit, {with_unit(driver, 'N*m', 3)}", driver)]
    if math.isfinite(motor.peak_torque):
        peak = float(output_torque(parameters, motor.peak_torque, 0.5 * top))
        levels.append((f"motor's peak by its catalogue, {with_unit(peak, 'N*m', 3)}", peak))
    entries = [(curve.label, f"curve {curve.class_}") for curve in curves]
    begin = 14.0 + 17.0 * legend_rows(entries, _LEFT, _WIDTH)
    most = max(
        *(float(curve.torque.max()) for curve in curves),
        *(point.torque for point in points),
        *(level for _, level in levels),
    )
    panel = Panel(
        "envelope",
        linear_axis(0.0, top * _RPM, "output speed, rpm", most=9, tight=True),
        linear_axis(0.0, 1.05 * most, "output torque, N·m", most=7),
        _LEFT,
        begin,
        _WIDTH - _LEFT - _RIGHT,
        330.0,
    )
    labels = Labels(panel.left + 2.0, panel.top, panel.right, panel.bottom)
    body = panel.frame()
    held = next((curve for curve in curves if curve.class_ == "held"), None)
    if held is not None:
        xs, ys = panel.places(held.speed * _RPM, held.torque)
        corners = [*points_of(xs, ys), (float(xs[-1]), panel.bottom), (float(xs[0]), panel.bottom)]
        body.append(polyline(corners, "held-area", closed=True))
    body += [panel.curve(c.speed * _RPM, c.torque, c.class_) for c in curves[::-1]]
    for curve in curves:
        labels.avoid_curve(panel, curve.speed * _RPM, curve.torque)
    for _, level in levels:
        body.append(panel.across(level))
        y = panel.place(0.0, level)[1]
        labels.avoid([panel.left, panel.right], [y, y])
    marks = [Mark(p.speed * _RPM, p.torque, p.name, _dot(p)) for p in points]
    for mark in marks:
        at = panel.place(mark.x, mark.y)
        labels.avoid([at[0], at[0] + 1.0], [at[1], at[1]])
    for mark in marks:
        at = panel.place(mark.x, mark.y)
        body.append(panel.dot(mark.x, mark.y, mark.class_))
        body.append(labels.place(at, mark.label, "legend"))
    for name, level in levels:
        place = panel.place(0.72 * panel.x.high, level)
        body.append(labels.place(place, name, "limit-label"))
    body.append(legend([(c.label, c.class_) for c in curves], _LEFT, _WIDTH, 14.0))
    generating = any(point.generating for point in points)
    inside = [p.name for p in points if p.found.inside]
    outside = [p.name for p in points if not p.found.inside]
    told = "; ".join(
        f"{', '.join(names)} {where}"
        for names, where in ((inside, "inside"), (outside, "outside"))
        if names
    )
    return Figure(
        "envelope",
        "Torque over speed",
        f"Output torque over output speed on {with_unit(drive.supply_voltage, 'V')} with the "
        f"limits of driver, motor and heat. Points of the requirements: {told}.",
        _WIDTH,
        panel.bottom + 43.0,
        "".join(body),
        "The motor driving. Filled points lie inside, hollow ones outside; the requirements name "
        "no speed for the peak torque, so it stands at standstill, where breakaway takes its "
        "share. Lines of heat follow another limit where it binds first."
        + (" Points where the output drives stand by their size." if generating else ""),
    )


def _dot(point: Asked) -> str:
    return "dot inside" if point.found.inside else "dot outside"
