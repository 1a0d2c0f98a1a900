"""From a design to the actuator's parameters: catalogue, geometry, contact, losses, mass.

What the design and the catalogue do not say is assumed by a stated rule and marked in `origins`.
Masses and inertias are closed forms of the solids (`Machine.inertia`). `inertia` measures the same
from meshes, which takes ten seconds and more, and agrees within 6e-5 (tested).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from cqdd_design.actuator.bench.unknowns import apply_factors
from cqdd_design.actuator.friction import STRIBECK_SPEED, friction_parameters, load_shares
from cqdd_design.actuator.parameters import (
    ActuatorParameters,
    DriveParameters,
    GearParameters,
    MotorParameters,
    ThermalParameters,
)
from cqdd_design.actuator.specimen import AS_DRAWN, Specimen
from cqdd_design.actuator.transmission import USUAL_LEAST, Transmission, transmission
from cqdd_design.catalog.motors import DRAG, Motor
from cqdd_design.design import Design
from cqdd_design.errors import DesignError, GeometryError
from cqdd_design.geometry.limits import rounded_down
from cqdd_design.machine import Machine
from cqdd_design.machine.cooling import cooled_network, two_nodes
from cqdd_design.machine.thermal_parts import COPPER_HEAT, WINDING_SHARE
from cqdd_design.solids.inertia import GROUPS, GearboxInertia, rotor_scope
from cqdd_design.units import SMALL_LENGTH, TORQUE, format_quantity

ELECTRICAL_TIME = 1e-3
"""L/R where the catalogue has no inductance, s: common for large flat motors."""
POLE_PAIRS = 21
PERIODS_PER_POLE_PAIR = 12
"""Of cogging in a turn, where the catalogue has no slots: lcm of 6 k slots and 7 k poles."""
ROTOR_SHARE, ROTOR_RADIUS_SHARE = 0.3, 0.95
"""Rotor of an unknown motor: a ring of this share of its mass at this share of its radius."""
METAL_HEAT = 600.0
"""Specific heat of steel with aluminium, J/(kg K)."""
THERMAL_RESISTANCE = 1.2
"""Winding to ambient where neither the design nor drawn parts tell it, K/W: a common joint's."""
WINDING_RESISTANCE_SHARE = 1.0 / 3.0
"""Of the whole thermal resistance, between winding and housing."""
DERATING_SPAN = 20.0
"""Kelvins below the winding's most, from which the driver lowers the current."""
DAMPING_RATIO = 0.03
"""Of the motor swinging on the gearbox's stiffness: greased steel joints, 0.01 to 0.05."""


@dataclass(frozen=True)
class _Split:
    """Inertias of one machine, kg m^2: at the crank without the rotor, and at the output."""

    input: float
    output: float


def actuator_parameters(
    machine: Machine, specimen: Specimen = AS_DRAWN, *, supply_voltage: float | None = None
) -> ActuatorParameters:
    """Parameters of the actuator that a machine makes.

    Parameters
    ----------
    machine : Machine
        Of the specimen's motor.
    specimen : Specimen
        Its gearbox is drawn from the design's tolerances, its unknowns multiplied.
    supply_voltage : float, optional
        V; default that of the design.

    Returns
    -------
    ActuatorParameters
        With the origin of every value.

    Raises
    ------
    DesignError
        When the motor's data do not make a machine, a limit can never bind, or the gearbox has no
        equilibrium or no solids.
    """
    design, inertia = machine.design, machine.inertia
    motor, drive, origins = motor_and_drive(machine, specimen, supply_voltage=supply_voltage)
    torque = design.requirements.continuous_torque
    found = transmission(machine.contact, design, torque, seed=specimen.seed)
    split = _split(inertia)
    gear = _gear(design, found, split, motor.rotor_inertia, specimen.seed, origins)
    _refuse_binding(machine)
    friction = friction_parameters(
        machine.losses,
        torque,
        design.requirements.input_speed,
        peak=design.requirements.peak_torque,
        drag=motor.dry_drag,
        cogging=motor.cogging_amplitude,
    )
    for name in ("motor_coulomb", "output_coulomb", "load_forward", "load_backward"):
        origins[f"friction.{name}"] = (
            f"computed: losses of the gearbox at {torque:g} N*m, and its backdrive torque"
        )
    origins["friction.load_knee"] = (
        "assumed: above the continuous torque by half, or by a third of the way to the peak, and "
        "no less than the static backdrive torque"
    )
    peak = design.requirements.peak_torque
    origins["friction.load_growth"] = (
        f"computed: losses of the gearbox at {peak:g} N*m"
        if friction.load_growth
        else f"computed: none up to {peak:g} N*m, the losses of the gearbox need none"
    )
    speed = design.requirements.input_speed
    for name in ("motor_viscous", "output_viscous"):
        origins[f"friction.{name}"] = (
            f"computed: drag of bearings and grease up to {speed:.4g} rad/s"
        )
    origins["friction.stribeck_extra"] = "computed: static over dynamic backdrive torque"
    origins["friction.stribeck_speed"] = (
        f"assumed: {STRIBECK_SPEED:g} rad/s of the motor"
        if machine.losses.film is None
        else f"computed: nearest to the films' friction up to {speed:.4g} rad/s"
    )
    origins["friction.bristle_deflection"] = "assumed"
    origins["friction.bristle_damping"] = "assumed: none"
    thermal = _thermal(machine, origins)
    origins["mass"] = f"computed: solids in closed form; {inertia.mass_scope}"
    origins["gear.output_inertia"] = "computed: solids in closed form"
    origins["gear.input_inertia"] = f"computed: solids in closed form; {inertia.crank_scope}"
    computed = ActuatorParameters(
        name=design.name,
        motor=motor,
        drive=drive,
        thermal=thermal,
        friction=friction,
        gear=gear,
        mass=inertia.mass,
        origins=origins,
        seed=specimen.seed,
    )
    return apply_factors(computed, specimen.factors)


def motor_and_drive(
    machine: Machine, specimen: Specimen = AS_DRAWN, *, supply_voltage: float | None = None
) -> tuple[MotorParameters, DriveParameters, dict[str, str]]:
    """Motor and drive alone, and the origins of their values; see `actuator_parameters`.

    Raises
    ------
    DesignError
        When the motor's data do not make a machine, or a limit can never bind.
    """
    origins: dict[str, str] = {}
    motor = _motor(machine.motor, machine.inertia, origins)
    return motor, _drive(machine.design, motor, supply_voltage, origins), origins


def _refuse_binding(machine: Machine) -> None:
    """Refuse a gearbox whose friction cannot be put as shares of what it carries."""
    design = machine.design
    asked, reducer = design.requirements, design.reducer
    *shares, _ = load_shares(machine.losses, asked.continuous_torque, asked.input_speed)
    if min(shares) >= 0.0:
        return
    hole, teeth = reducer.output_pins.hole_clearance, reducer.modification.equidistant
    tightest = next(one for one in machine.analysis.checks if one.id == "FIT-PIN-HOLE")
    cure = f"{tightest.remedy}, or more" if tightest.status == "fail" else "raise one of them"
    raise DesignError(
        f"the gearbox binds: with output_pins.hole_clearance {format_quantity(hole, SMALL_LENGTH)} "
        f"and modification.equidistant {format_quantity(teeth, SMALL_LENGTH)} pins or teeth press "
        "on one another without any torque, and rub more than at the continuous torque, "
        f"{format_quantity(asked.continuous_torque, TORQUE)}, so that its losses cannot be put as "
        f"friction; {cure}, until the parts have play."
    )


def _split(inertia: GearboxInertia) -> _Split:
    """What turns with the carrier counts at the output, all else that moves at the crank."""
    own = {*GROUPS["carrier"], "output bearing"}
    output = sum(part.reflected for part in inertia.parts if part.name in own)
    return _Split(
        input=inertia.gearbox_reflected - output,
        output=output * inertia.ratio**2,
    )


def _motor(row: Motor, inertia: GearboxInertia, origins: dict[str, str]) -> MotorParameters:
    for key, value in (
        ("torque_constant", row.torque_constant),
        ("resistance", row.line_resistance),
    ):
        if not value:
            raise DesignError(
                f"the {key.replace('_', ' ')} of {row.name} is not known, and a simulation "
                f"needs it; give {key} in [motor] or with --motor-file, or name a motor that "
                "has one, such as 'CubeMars RO100 KV55'."
            )
    assert row.torque_constant is not None
    assert row.line_resistance is not None
    constant, resistance = row.torque_constant, row.line_resistance
    by_speed = "1/KV in SI" if row.speed_constant else "as printed"
    constant_from = row.origin("speed_constant" if row.speed_constant else "")
    origins["motor.torque_constant"] = f"{constant_from}, {by_speed}"
    origins["motor.resistance"] = f"{row.origin('line_resistance')}, line to line"
    inductance, pairs = row.line_inductance, row.pole_pairs
    origins["motor.inductance"] = f"{row.origin('line_inductance')}, line to line"
    if inductance is None:
        inductance = ELECTRICAL_TIME * resistance
        origins["motor.inductance"] = f"assumed: L/R of {1e3 * ELECTRICAL_TIME:g} ms"
    origins["motor.pole_pairs"] = row.origin("pole_pairs")
    if pairs is None:
        pairs = POLE_PAIRS
        origins["motor.pole_pairs"] = "assumed"
    origins["motor.reference_temperature"] = "assumed: the catalogue's values hold at 25 degC"
    for key, value in (("rated_torque", row.rated_torque), ("peak_torque", row.peak_torque)):
        origins[f"motor.{key}"] = row.origin(key) if value else "missing"
    return MotorParameters(
        torque_constant=constant,
        resistance=resistance,
        inductance=inductance,
        rotor_inertia=_rotor_inertia(row, inertia, origins),
        pole_pairs=pairs,
        rated_torque=row.rated_torque or math.nan,
        peak_torque=row.peak_torque or math.nan,
        **_drag(row, pairs, origins),
    )


def _drag(row: Motor, pole_pairs: int, origins: dict[str, str]) -> dict[str, Any]:
    """What the motor alone takes to turn, and its cogging; 0 where the catalogue gives none."""
    found: dict[str, Any] = {}
    for key in (*DRAG, "cogging_amplitude"):
        value = getattr(row, key)
        found[key] = value or 0.0
        origins[f"motor.{key}"] = _drag_origin(row, key)
    if row.cogging_order is None:
        found["cogging_order"] = PERIODS_PER_POLE_PAIR * pole_pairs
        origins["motor.cogging_order"] = (
            f"assumed: {PERIODS_PER_POLE_PAIR} for each pole pair, as with 6 slots on 7 poles"
        )
    else:
        found["cogging_order"] = row.cogging_order
        origins["motor.cogging_order"] = row.origin("cogging_order")
    return found


def _drag_origin(row: Motor, key: str) -> str:
    if getattr(row, key) is None:
        whose = "the catalogue gives none" if row.based_on or not row.stated else "nothing gives it"
        return f"assumed: 0, {whose}"
    told = row.origin(key)
    source = row.drag_source if key in DRAG else row.cogging_source
    return f"{told}; {source}" if told.startswith("catalogue") else told


def _rotor_inertia(row: Motor, inertia: GearboxInertia, origins: dict[str, str]) -> float:
    drawn = inertia.rotor_drawn
    if row.rotor_inertia is not None:
        origins["motor.rotor_inertia"] = f"{row.origin('rotor_inertia')}, {rotor_scope(row)}"
        return row.rotor_inertia
    if drawn > 0.0:
        origins["motor.rotor_inertia"] = f"computed: solids of the rotor, {rotor_scope(row)}"
        return drawn
    if row.mass is None or row.outer_diameter is None:
        raise DesignError(
            f"neither rotor inertia nor mass and diameter of {row.name} are known; give "
            "rotor_inertia in [motor] or with --motor-file, or name a motor that has it, such as "
            "'CubeMars RO100 KV55'."
        )
    origins["motor.rotor_inertia"] = (
        f"assumed: ring of {100.0 * ROTOR_SHARE:g} % of the motor's mass near its outside diameter"
    )
    radius = 0.5 * ROTOR_RADIUS_SHARE * row.outer_diameter
    return ROTOR_SHARE * row.mass * radius**2


def _drive(
    design: Design, motor: MotorParameters, supply: float | None, origins: dict[str, str]
) -> DriveParameters:
    voltage = design.motor.voltage if supply is None else supply
    given = "design" if "motor.voltage" not in design.assumed else "assumed: default of the design"
    origins["drive.supply_voltage"] = given if supply is None else "given"
    limit = design.motor.current_limit
    origins["drive.current_limit"] = "design"
    most = voltage / motor.resistance if voltage > 0.0 else math.inf
    if limit > most:
        if "motor.current_limit" not in design.assumed:
            raise DesignError(
                f"motor.current_limit {limit:g} A never binds: {voltage:g} V drive no more than "
                f"{most:.4g} A through {motor.resistance:g} ohm; lower it to "
                f"{rounded_down(most):g} A, or "
                "raise the voltage."
            )
        limit = most
        origins["drive.current_limit"] = "computed: stall current, below the design's default"
    for key in ("current_bandwidth", "control_rate", "encoder_bits", "position_gain"):
        origins[f"drive.{key}"] = "design"
    origins["drive.velocity_gain"] = "design"
    for key in ("current_bandwidth", "control_rate", "encoder_bits"):
        if f"drive.{key}" in design.assumed:
            origins[f"drive.{key}"] = "assumed: default of the design"
    origins["drive.delay"] = "assumed: a twentieth of a period of the current loop"
    drive = design.drive
    return DriveParameters(
        supply_voltage=voltage,
        current_limit=limit,
        current_bandwidth=drive.current_bandwidth,
        delay=0.05 / drive.current_bandwidth,
        control_rate=drive.control_rate,
        encoder_bits=drive.encoder_bits,
        position_gain=drive.position_gain,
        velocity_gain=drive.velocity_gain,
    )


def _gear(
    design: Design,
    found: Transmission,
    split: _Split,
    rotor_inertia: float,
    seed: int | None,
    origins: dict[str, str],
) -> GearParameters:
    parts = "perfect parts" if seed is None else f"gearbox drawn with seed {seed}"
    for key in ("error_orders", "error_cosine", "error_sine", "stiffness", "backlash"):
        origins[f"gear.{key}"] = f"computed: contact equilibrium of {parts}, both senses"
    for key in ("stiffness_cosine", "stiffness_sine", "stiffening"):
        origins[f"gear.{key}"] = origins["gear.stiffness"]
    if found.least_windup > USUAL_LEAST:
        kept = (
            f"; windup kept above {100.0 * found.least_windup:.3g} % of its mean, as the backlash "
            "varies by more over the turn"
        )
        for key in ("stiffness_cosine", "stiffness_sine"):
            origins[f"gear.{key}"] += kept
    origins["gear.error_torque"] = "design: continuous torque"
    origins["gear.ratio"] = "design: fixed ring, output against the motor"
    origins["gear.damping"] = (
        f"assumed: damping ratio {DAMPING_RATIO:g} with the motor's inertia, output held"
    )
    felt = {key: value for key, value in vars(found).items() if key != "least_windup"}
    swinging = design.reducer.ratio**2 * (rotor_inertia + split.input)
    return GearParameters(
        ratio=-float(design.reducer.ratio),
        input_inertia=split.input,
        output_inertia=split.output,
        damping=2.0 * DAMPING_RATIO * math.sqrt(found.stiffness * swinging),
        **felt,
    )


def _thermal(machine: Machine, origins: dict[str, str]) -> ThermalParameters:
    """Winding and housing of the machine's thermal network; by shares where it has none."""
    most = machine.motor.winding_most
    origins["thermal.ambient"] = "design: environment.ambient"
    origins["thermal.derating_begins"] = "assumed"
    stated = "winding_limit" in machine.motor.stated
    origins["thermal.most"] = machine.motor.origin("winding_limit") if stated else "assumed"
    limits = {
        "ambient": machine.design.environment.ambient,
        "derating_begins": most - DERATING_SPAN,
        "most": most,
    }
    try:
        found = two_nodes(cooled_network(machine), most)
    except (DesignError, GeometryError) as error:
        return _thermal_by_shares(machine, limits, error.message, origins)
    cooling = machine.cooling
    way = f"{cooling.key} (stated)" if cooling.value else "still air round the drawn parts"
    for key in ("winding_to_housing", "housing_to_ambient"):
        origins[f"thermal.{key}"] = f"computed: thermal network of the parts, {way}"
    for key in ("winding_capacity", "housing_capacity"):
        origins[f"thermal.{key}"] = "computed: thermal network of the parts"
    return ThermalParameters(**found._asdict(), **limits)


def _thermal_by_shares(
    machine: Machine, limits: dict[str, float], why: str, origins: dict[str, str]
) -> ThermalParameters:
    row, mass, cooling = machine.motor, machine.inertia.mass, machine.cooling
    whole = cooling.value or THERMAL_RESISTANCE
    motor_mass = row.mass if row.mass is not None else 0.4 * mass
    winding = WINDING_SHARE * motor_mass
    share = WINDING_RESISTANCE_SHARE
    said = f"{cooling.key} (stated)" if cooling.value else f"{whole:g} K/W"
    for key in ("winding_to_housing", "housing_to_ambient"):
        origins[f"thermal.{key}"] = f"assumed: {said} split 1 to 2; {why.rstrip('.')}"
    origins["thermal.winding_capacity"] = (
        f"assumed: copper of {100.0 * WINDING_SHARE:g} % of the motor's mass"
    )
    origins["thermal.housing_capacity"] = (
        f"assumed: the rest of the mass at {METAL_HEAT:g} J/(kg K)"
    )
    return ThermalParameters(
        winding_to_housing=share * whole,
        housing_to_ambient=(1.0 - share) * whole,
        winding_capacity=winding * COPPER_HEAT,
        housing_capacity=max(mass - winding, 0.5 * mass) * METAL_HEAT,
        **limits,
    )
