"""MJCF for MuJoCo 4: the actuator as ``<dcmotor>``, ripple and backlash with it.

Two files. ``<name>-test.xml`` is a single joint that loads by itself; ``<name>.xml`` holds default
classes, to include into a robot, and says in its head which lines each joint needs. Both are made
of the same classes:

- ``<name>``: joint without backlash, and the motor commanded in volts.
- ``<name>-torque``, ``<name>-impedance``: the motor commanded in torque, or to an angle.
- ``<name>-ripple-K``: one passive dcmotor for each harmonic of the ripple torque.
- ``<name>-output-friction``: LuGre friction of the output side, a passive dcmotor.
- ``<name>-play``, ``<name>-play-degree``: second, coaxial hinge of the backlash.

Attributes of dcmotor: MuJoCo 4.0 XML reference, actuator/dcmotor, and its technical note "DC Motor
Model". Damping, armature and LuGre stand at the motor's side and are carried through the gear by
MuJoCo: inertia and damping by gear^2, torque by gear.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from cqdd_design.exporting.simulators.mjcf_classes import (
    HOST_STEP,
    MjcfActuator,
    default_classes,
    remarks,
    time_step,
)
from cqdd_design.exporting.simulators.stated import DEAD_MASS, effort_overload, mass_remark
from cqdd_design.exporting.simulators.xml_text import comment, element, identifier, number, numbers
from cqdd_design.files import WrittenFile, write_atomically

if TYPE_CHECKING:
    from cqdd_design.exporting.job import ExportJob

_UNTOUCHED = {"contype": "0", "conaffinity": "0"}


def export_mjcf(job: ExportJob) -> tuple[WrittenFile, ...]:
    """Write ``<name>-test.xml``, which loads by itself, and ``<name>.xml``, to be included."""
    model = MjcfActuator(
        job.actuator,
        job.design.file_name,
        design_sha256=job.design.sha256,
        beyond=effort_overload(job),
    )
    return (
        write_atomically(job.path("-test.xml"), model_text(model), "mjcf"),
        write_atomically(job.path(".xml"), fragment_text(model), "mjcf"),
    )


def model_text(model: MjcfActuator) -> str:
    """Return the test model as XML."""
    parameters, name, play = model.parameters, model.name, model.play
    inertia = model.side.output_inertia
    body = element(
        "body",
        {"name": "output"},
        *joint_lines(name, name, play=play),
        element(
            "inertial",
            {
                "pos": "0 0 0",
                "mass": DEAD_MASS,
                "diaginertia": numbers(0.6 * inertia, 0.6 * inertia, inertia),
            },
        ),
        element("geom", {"type": "cylinder", "size": "0.02 0.01", "mass": 0.0, **_UNTOUCHED}),
        element(
            "geom",
            {"type": "box", "size": "0.01 0.002 0.011", "pos": "0.015 0 0", "mass": 0.0}
            | _UNTOUCHED,
        ),
    )
    housing = element(
        "body",
        {"name": "housing"},
        element(
            "geom",
            {"type": "cylinder", "size": "0.05 0.01", "pos": "0 0 -0.025", **_UNTOUCHED}
            | {"mass": parameters.mass},
        ),
        body,
    )
    sections = [
        element("compiler", {"angle": "radian"}),
        element(
            "option",
            {"timestep": time_step(parameters), "integrator": "implicitfast", "gravity": "0 0 0"},
        ),
        element("default", {}, *default_classes(model, alone=True)),
        element("worldbody", {}, housing),
    ]
    if play:
        sections.append(element("tendon", {}, *tendon_lines(name)))
    sections.append(element("actuator", {}, *actuator_lines(model, name)))
    kind = "tendon" if play else "joint"
    where = {kind: f"{name}-output" if play else name}
    sections.append(
        element(
            "sensor",
            {},
            element(f"{kind}pos", {"name": "angle", **where}),
            element(f"{kind}vel", {"name": "speed", **where}),
            element("actuatorfrc", {"name": "motor-torque", "actuator": name}),
        )
    )
    head = [f"{name}: test model of one actuator for MuJoCo 4.", "", mass_remark(parameters), ""]
    return (
        f"{comment([*head, *remarks(model, alone=True)])}\n"
        + element("mujoco", {"model": name}, *sections)
        + "\n"
    )


def fragment_text(model: MjcfActuator) -> str:
    """Return the classes to be included, with the lines that each joint needs in the head."""
    name = model.name
    head = [f"{name}: classes of an actuator for MuJoCo 4, to be included into a robot.", ""]
    rigid = replace(model, backlash=False)
    how = [
        "How to include it, for a joint named hip. In the robot's file:",
        "",
        f'  <include file="{name}.xml"/>',
        "",
        "In the link that the actuator drives:",
        "",
        *(f"  {line}" for line in joint_lines(name, "hip", play=False)),
        "",
        "In <actuator>, with class "
        f"{name}-torque or {name}-impedance in the first line to command torque or angle:",
        "",
        *(f"  {line}" for line in actuator_lines(rigid, "hip")),
        "",
        "Commands are at the motor's side in the drive's sense: volts; N m of the motor "
        f"({number(model.side.reduction)} times as much at the joint); for impedance the "
        "angle and speed of the motor, that is the joint's times "
        f"{number(model.side.reduction)}, and a torque fed forward.",
        "",
    ]
    if model.parameters.gear.backlash > 0.0:
        how += [
            "With backlash the link has two coaxial hinges, the actuator on the first. The inertia "
            f"of the output side, {number(model.side.output_inertia)} kg m^2 about the axis, then "
            "belongs into the link's inertial, since it turns with both:",
            "",
            *(f"  {line}" for line in joint_lines(name, "hip", play=True)),
            "",
            f"(class {name}-play-degree where the robot's compiler does not say angle=radian), in "
            "<tendon>:",
            "",
            *(f"  {line}" for text in tendon_lines("hip") for line in text.splitlines()),
            "",
            'and in the line of the output friction tendon="hip-output" for joint="hip". The '
            "stiffness of the play's ends is the transmission's for the output side alone; with a "
            "heavy link it comes out higher, as MuJoCo scales limits with inertia.",
            "",
        ]
    how += [
        f"Friction and the play's ends are set for steps up to {number(HOST_STEP)} s and, with "
        "backlash, for links no less inert than the actuator itself, "
        f"{number(model.side.reflected_inertia)} kg m^2 about the axis. Lighter ones want shorter "
        "steps, and so does a motor that its peak torque brings to full speed within two.",
        "",
    ]
    text = comment([*head, *how, *remarks(model, alone=False)])
    classes = element("default", {}, *default_classes(model, alone=False))
    return f"{text}\n{element('mujoco', {}, classes)}\n"


def joint_lines(name: str, joint: str, *, play: bool) -> tuple[str, ...]:
    """Hinges of a joint whose actuator is of class `name`."""
    name = identifier(name)
    if not play:
        return (element("joint", {"name": joint, "class": name}),)
    return (
        element("joint", {"name": joint, "axis": "0 0 1"}),
        element("joint", {"name": f"{joint}-play", "class": f"{name}-play"}),
    )


def tendon_lines(joint: str) -> tuple[str, ...]:
    """The angle of the output, which is the sum of both hinges, as a tendon."""
    return (
        element(
            "fixed",
            {"name": f"{joint}-output"},
            element("joint", {"joint": joint, "coef": "1"}),
            element("joint", {"joint": f"{joint}-play", "coef": "1"}),
        ),
    )


def actuator_lines(model: MjcfActuator, joint: str) -> tuple[str, ...]:
    """Actuators of one joint: the motor, then what is passive."""
    on_joint = {"joint": joint}
    found = [("", on_joint)]
    if model.output_friction:
        on_output = {"tendon": f"{joint}-output"} if model.play else on_joint
        found.append(("-output-friction", on_output))
    found += [(f"-ripple-{one.order}", on_joint) for one in model.harmonics]
    return tuple(
        element("dcmotor", {"name": joint + ending, "class": model.name + ending, **place})
        for ending, place in found
    )
