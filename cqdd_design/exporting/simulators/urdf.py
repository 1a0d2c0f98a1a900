"""URDF of one actuator: joint with limits and friction, transmission, inertia of the output side.

A URDF joint knows no inertia of a rotor. It stands in the transmission as ``drake:rotor_inertia``
and ``drake:gear_ratio`` (Drake, "Multibody: supported URDF and SDFormat extensions"), which Drake
reflects as inertia times ratio squared; other clients ignore both and need the reflected inertia
set by hand as armature. The links carry what turns with them: the housing's link the whole mass,
the output's link the inertia of the output side alone.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cqdd_design.actuator.joint_side import JointSide, joint_side
from cqdd_design.exporting.simulators.stated import (
    DEAD_MASS,
    effort_limit,
    effort_overload,
    mass_remark,
    overload_remark,
    peak_limit,
    provenance,
)
from cqdd_design.exporting.simulators.xml_text import comment, element, identifier, number
from cqdd_design.files import WrittenFile, write_atomically

if TYPE_CHECKING:
    from cqdd_design.actuator.parameters import ActuatorParameters
    from cqdd_design.exporting.job import ExportJob
    from cqdd_design.machine.overload import Overload

DRAKE = "http://drake.mit.edu"
"""Namespace of Drake's elements."""


def export_urdf(job: ExportJob) -> tuple[WrittenFile, ...]:
    """Write ``<name>.urdf``."""
    text = urdf_text(
        job.actuator,
        job.design.file_name,
        design_sha256=job.design.sha256,
        beyond=effort_overload(job),
    )
    return (write_atomically(job.path(".urdf"), text, "urdf"),)


def urdf_text(
    parameters: ActuatorParameters,
    name: str,
    *,
    design_sha256: str = "not given",
    beyond: Overload | None = None,
) -> str:
    """Return the URDF: links ``housing`` and ``output``, between them joint ``<name>``.

    With `beyond`, what the gearbox does not carry of the effort limit, it says so.
    """
    name = identifier(name)
    side = joint_side(parameters)
    spread = parameters.mass * _SLENDER
    joint = element(
        "joint",
        {"name": name, "type": "continuous"},
        element("origin", {"xyz": "0 0 0", "rpy": "0 0 0"}),
        element("parent", {"link": "housing"}),
        element("child", {"link": "output"}),
        element("axis", {"xyz": "0 0 1"}),
        element("limit", {"effort": effort_limit(parameters), "velocity": side.no_load_speed}),
        element("dynamics", {"damping": side.viscous, "friction": side.coulomb}),
    )
    return (
        '<?xml version="1.0"?>\n'
        + comment(_remarks(parameters, side, name, design_sha256, beyond))
        + "\n"
        + element(
            "robot",
            {"name": name, "xmlns:drake": DRAKE},
            _link("housing", parameters.mass, (spread, spread, spread)),
            _link("output", DEAD_MASS, (0.6 * side.output_inertia,) * 2 + (side.output_inertia,)),
            joint,
            _transmission(parameters, side, name),
        )
        + "\n"
    )


_SLENDER = 1e-3
"""Inertia over mass of the housing, m^2: a body of 32 mm radius of gyration. It is fixed in a
robot of one joint; within another robot the solids' own inertia belongs here."""


def _link(name: str, mass: float, inertia: tuple[float, ...]) -> str:
    about_x, about_y, about_z = inertia
    diagonal = {"ixx": about_x, "ixy": 0.0, "ixz": 0.0, "iyy": about_y, "iyz": 0.0, "izz": about_z}
    return element(
        "link",
        {"name": name},
        element(
            "inertial",
            {},
            element("origin", {"xyz": "0 0 0", "rpy": "0 0 0"}),
            element("mass", {"value": mass}),
            element("inertia", diagonal),
        ),
    )


def _transmission(parameters: ActuatorParameters, side: JointSide, name: str) -> str:
    reduction = number(side.reduction)
    return element(
        "transmission",
        {"name": f"{name}-transmission"},
        "<type>transmission_interface/SimpleTransmission</type>",
        element(
            "joint",
            {"name": name},
            "<hardwareInterface>hardware_interface/EffortJointInterface</hardwareInterface>",
        ),
        element(
            "actuator",
            {"name": f"{name}-motor"},
            "<hardwareInterface>hardware_interface/EffortJointInterface</hardwareInterface>",
            f"<mechanicalReduction>{reduction}</mechanicalReduction>",
            element("drake:rotor_inertia", {"value": parameters.motor_side_inertia}),
            element("drake:gear_ratio", {"value": side.reduction}),
        ),
    )


def _remarks(
    parameters: ActuatorParameters,
    side: JointSide,
    name: str,
    design_sha256: str,
    beyond: Overload | None,
) -> list[str]:
    friction = parameters.friction
    sense = "against" if side.crank_sense < 0 else "with"
    return [
        f"{name}: one actuator as URDF. Written by {provenance(design_sha256)}. SI units.",
        "",
        "Sense: positive effort turns the joint positive. The reduction is written positive, "
        f"{number(side.reduction)}; the gearbox's own signed ratio is "
        f"{number(parameters.gear.ratio)}, so the crank turns {sense} the joint, and the drive's "
        "wiring makes up for it.",
        "",
        f"limit: effort is what the stalled output gives at {peak_limit(parameters)}, after all "
        f"friction, of {number(side.peak_torque)} N m without losses. The current holds up to "
        f"{number(side.corner_speed)} rad/s at "
        f"{number(parameters.drive.supply_voltage)} V and falls to none at velocity, the no-load "
        "speed with friction. URDF cannot say so. A client that takes off dynamics' friction as "
        f"well takes its {number(side.coulomb)} N m twice.",
        "",
        *([overload_remark(beyond), ""] if beyond else []),
        "dynamics: Coulomb and viscous friction of both sides at the joint. Not here, because URDF "
        f"has no place for it: breakaway of {number(side.breakaway)} N m, friction that grows with "
        f"load ({number(friction.load_forward)} of the torque when the motor drives, "
        f"{number(friction.load_backward)} when the output drives, {number(friction.load_growth)} "
        f"of itself more above {number(friction.load_knee)} N m), backlash of "
        f"{number(parameters.gear.backlash)} rad, stiffness, ripple, heat.",
        "",
        mass_remark(parameters),
        "",
        "Inertia: the output link has that of the output side, "
        f"{number(side.output_inertia)} kg m^2. Rotor and crank, "
        f"{number(parameters.motor_side_inertia)} kg m^2 at the motor or "
        f"{number(side.motor_inertia)} kg m^2 at the joint, are in no link: Drake takes them from "
        "the transmission (it warns that it leaves mechanicalReduction and friction aside), "
        "elsewhere set the joint's armature to the latter. The housing's inertia "
        "is that of a body of 32 mm radius of gyration, without effect on the joint.",
    ]
