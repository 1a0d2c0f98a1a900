"""Words and symbols for the keys of a design file, and for the paper's own symbols."""

from __future__ import annotations

from dataclasses import dataclass

from cqdd_design.terms import term


@dataclass(frozen=True)
class Label:
    """How a quantity is called in the report.

    Attributes
    ----------
    words : str
        As in running text.
    symbol : str
        With ``_`` before an index; empty where the report uses none.
    """

    words: str
    symbol: str = ""


#: Headings of the tables of a design file.
GROUPS = {
    "requirements": "Requirements",
    "requirements.duty_columns": "Columns of the duty's file",
    "reducer": "Reducer",
    "reducer.modification": "Profile modification",
    "reducer.output_pins": "Output pins",
    "reducer.cam_bearing": "Cam bearing",
    "reducer.support_bearing": "Shaft bearings",
    "reducer.carrier": "Carrier",
    "reducer.carrier_bearing": "Carrier bearing",
    "reducer.ring": "Ring",
    "reducer.friction": "Friction",
    "reducer.finish": "Finish",
    "reducer.balance": "Balance",
    "motor": "Motor",
    "drive": "Drive",
    "housing": "Housing",
    "environment": "Surroundings",
    "tolerances": "Tolerances (standard deviations)",
    "edm": "Wire EDM",
}

#: Keys whose own last word does not say enough.
_LABELS = {
    "requirements.ratio": Label("ratio", "n"),
    "requirements.peak_torque": Label("peak torque at the output", "T_peak"),
    "requirements.continuous_torque": Label("continuous torque at the output", "T_continuous"),
    "requirements.continuous_speed": Label("input speed of the continuous torque"),
    "requirements.speed_at_peak": Label("output speed up to which the peak torque is reached"),
    "requirements.life": Label("life"),
    "requirements.shock_speed": Label("output speed into a rigid stop"),
    "requirements.bore": Label("bore through the middle"),
    "requirements.mass": Label("mass of the actuator, at most"),
    "requirements.reflected_inertia": Label("inertia felt at the output, at most"),
    "requirements.backlash": Label("backlash, at most"),
    "requirements.lost_motion": Label("lost motion, at most"),
    "requirements.stiffness": Label("stiffness at the output, at least"),
    "requirements.efficiency": Label("efficiency, at least"),
    "requirements.surface_temperature": Label("temperature outside, at most"),
    "requirements.external_moment": Label("moment that tilts the output from outside"),
    "requirements.external_axial": Label("force along the output's axis from outside"),
    "requirements.external_radial": Label("force across it"),
    "requirements.voltage": Label("supply voltage"),
    "requirements.current": Label("motor current, at most"),
    "requirements.yield": Label("share of toleranced gearboxes that meet all"),
    "requirements.outer_diameter": Label("space for the ring, diameter"),
    "requirements.length": Label("space for the disc pack, length"),
    "requirements.motor": Label("motor asked for"),
    "requirements.disc_count": Label("discs asked for"),
    "requirements.disc_material": Label("disc material asked for"),
    "requirements.ring_material": Label("ring material asked for"),
    "requirements.pin_material": Label("pin material asked for"),
    "requirements.duty": Label("duty at the output"),
    "requirements.duty_file": Label("duty over time, file"),
    "reducer.ratio": Label(term("lobe_count").words, "n"),
    "reducer.ring_pitch_radius": Label("ring pitch radius", "R"),
    "reducer.eccentricity": Label("eccentricity", "e"),
    "reducer.ring_pin_diameter": Label("diameter of ring teeth", "2r"),
    "reducer.ring_type": Label("kind of ring"),
    "reducer.disc_count": Label("discs", "D"),
    "reducer.disc_thickness": Label("disc thickness", "b"),
    "reducer.disc_spacing": Label("gap between discs", "s"),
    "reducer.modification.equidistant": Label("equidistant: gap at every tooth"),
    "reducer.modification.rotation": Label("rotation of each flank"),
    "reducer.output_pins.count": Label("output pins", "N_w"),
    "reducer.output_pins.diameter": Label("pin diameter", "d"),
    "reducer.output_pins.circle_radius": Label("radius of the pin circle", "R_w"),
    "reducer.output_pins.sleeve_diameter": Label("sleeve diameter (0: no sleeve)"),
    "reducer.output_pins.sleeve": Label("sleeves turn on"),
    "reducer.output_pins.sleeve_play": Label("play of a sleeve on its pin, diameter"),
    "reducer.output_pins.hole_clearance": Label("hole clearance on the diameter"),
    "reducer.output_pins.hole_clocking": Label("first hole from the valley on +x"),
    "reducer.output_pins.support": Label("pins held at"),
    "reducer.output_pins.material": Label("pin material"),
    "reducer.cam_bearing.designation": Label("cam bearing"),
    "reducer.cam_bearing.radial_clearance": Label("radial clearance (total play)"),
    "reducer.carrier.material": Label("carrier material (auto: the housing's)"),
    "reducer.carrier.joint": Label("plate and cap joined by"),
    "reducer.carrier.column_count": Label("columns between plate and cap"),
    "reducer.carrier.column_diameter": Label("column diameter (0: no columns)"),
    "reducer.carrier_bearing.stiffness": Label("radial stiffness (0: rigid)"),
    "reducer.ring.outer_diameter": Label("ring outside diameter", "D_ring"),
    "reducer.ring.relief_clearance": Label("relief past the lobe tips"),
    "reducer.ring.roller_diameter": Label("roller diameter (0: no rollers)"),
    "reducer.ring.roller": Label("rollers turn on"),
    "reducer.ring.roller_play": Label("play of a roller on its pin, diameter"),
    "reducer.friction.tooth": Label("coefficient at the teeth"),
    "reducer.friction.pin": Label("coefficient at the pins"),
    "reducer.friction.seals": Label("seals of support and output bearings"),
    "reducer.finish.disc": Label("flanks and holes of the discs made by"),
    "reducer.finish.ring": Label("ring teeth made by"),
    "reducer.finish.pin": Label("output pins made by"),
    "motor.name": Label("motor"),
    "motor.voltage": Label("supply voltage", "U"),
    "motor.current_limit": Label("current limit of the driver"),
    "drive.current_bandwidth": Label("current loop bandwidth"),
    "drive.encoder_bits": Label("encoder on the motor shaft, bits"),
    "drive.position_gain": Label("position gain at the output"),
    "drive.velocity_gain": Label("velocity gain at the output"),
    "drive.thermal_resistance": Label("winding to ambient"),
    "housing.material": Label("housing material"),
    "environment.ambient": Label("air round the actuator"),
    "environment.coldest": Label("coldest start"),
    "edm.profile_tolerance": Label("files follow the exact curve within"),
    "printing.hole_error": Label("printed holes measured less drawn and shrunk"),
    "printing.outside_error": Label("printed outsides measured less drawn and shrunk"),
    "printing.shrinkage": Label("shrinkage of printed parts"),
    "printing.material": Label("plastic of the test coupon"),
    "printing.others": Label("what coupons of other plastics showed"),
}


def label_of(key: str) -> Label:
    """Words and symbol of a dotted key; an unknown key is its own last word.

    Examples
    --------
    >>> label_of("reducer.eccentricity").symbol, label_of("reducer.new_key").words
    ('e', 'new key')
    """
    return _LABELS.get(key, Label(key.rpartition(".")[2].replace("_", " ")))
