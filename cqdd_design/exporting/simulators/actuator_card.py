"""Actuator card: every parameter at the motor and at the joint, and what each client calls it.

As YAML for programs and as Markdown for people, from the same rows. Through a gear of n torque goes
times n, speed and angle over n, inertia, damping and stiffness times n^2.
`data/card.csv` holds the rows and what clients call them, `data/clients.toml` the clients and their
settings.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from cqdd_design.actuator.joint_side import JointSide, joint_side
from cqdd_design.actuator.motor import motor_constants
from cqdd_design.exporting.simulators.card_clients import client_settings, clients
from cqdd_design.exporting.simulators.card_rows import Quantity, quantities
from cqdd_design.exporting.simulators.stated import effort_overload, overload_remark, provenance
from cqdd_design.exporting.simulators.yaml_text import yaml_text
from cqdd_design.files import WrittenFile, write_atomically

if TYPE_CHECKING:
    from cqdd_design.actuator.parameters import ActuatorParameters
    from cqdd_design.exporting.job import ExportJob
    from cqdd_design.machine.overload import Overload

FORMAT = 1
"""Of the YAML's keys."""


@dataclass(frozen=True, eq=False)
class Card:
    """An actuator's card before it is written.

    Attributes
    ----------
    ratio : float
        Signed.
    constants : mapping of str to float
        See `motor_constants`.
    harmonics : mapping
        Of kinematic error and stiffness: orders in a turn of the output, and coefficients.
    settings : mapping
        Client to configuration to setting to value.
    ambient : float
        deg C, at which K, resistance and what follows from them hold.
    beyond : Overload or None
        What the gearbox does not carry of the effort limit.
    """

    name: str
    design_sha256: str
    side: JointSide
    ratio: float
    constants: Mapping[str, float]
    rows: tuple[Quantity, ...]
    harmonics: Mapping[str, object]
    settings: Mapping[str, Mapping[str, Mapping[str, object]]]
    ambient: float
    beyond: Overload | None = None


def export_card(job: ExportJob) -> tuple[WrittenFile, ...]:
    """Write ``<name>-card.yaml`` and ``<name>-card.md``."""
    card = actuator_card(
        job.actuator,
        job.design.file_name,
        design_sha256=job.design.sha256,
        beyond=effort_overload(job),
    )
    return (
        write_atomically(job.path("-card.yaml"), card_yaml(card), "card"),
        write_atomically(job.path("-card.md"), card_markdown(card), "card"),
    )


def actuator_card(
    parameters: ActuatorParameters,
    name: str,
    *,
    design_sha256: str = "not given",
    beyond: Overload | None = None,
) -> Card:
    """Return the card of an actuator."""
    side = joint_side(parameters)
    return Card(
        name=name,
        design_sha256=design_sha256,
        side=side,
        ratio=parameters.gear.ratio,
        constants=motor_constants(side.motor_constant),
        rows=quantities(parameters, side),
        harmonics=_harmonics(parameters),
        settings=client_settings(parameters, side),
        ambient=parameters.thermal.ambient,
        beyond=beyond,
    )


def card_yaml(card: Card) -> str:
    """Return the card as YAML."""
    heading = f"# Actuator card of {card.name}. Written by {provenance(card.design_sha256)}.\n"
    told = {
        client.key: {
            "name": client.title,
            "version": client.version,
            "checked": client.checked,
            "settings": {key: dict(part) for key, part in card.settings[client.key].items()},
            "not_expressed": client.missing,
        }
        for client in clients()
    }
    document = {
        "format": FORMAT,
        "name": card.name,
        "design_sha256": card.design_sha256,
        "sense": {
            "positive_command": "positive motion of the joint",
            "signed_ratio": card.ratio,
            "reduction": card.side.reduction,
            "crank": "against the joint" if card.side.crank_sense < 0 else "with the joint",
        },
        "conventions": {key: text for key, text in _conventions(card)},
        **({"gearbox": card.beyond.to_dict()} if card.beyond else {}),
        "parameters": {
            row.key: {name: value for name, value in vars(row).items() if name != "key"}
            for row in card.rows
        },
        "harmonics": dict(card.harmonics),
        "clients": told,
    }
    return heading + yaml_text(document)


def card_markdown(card: Card) -> str:
    """Return the card as Markdown."""
    lines = [
        f"# Actuator card: {card.name}",
        "",
        f"Written by {provenance(card.design_sha256)}.",
        "",
        "## Conventions",
        "",
        *(
            f"- **{key.replace('_', ' ').capitalize()}.** {text}"
            for key, text in _conventions(card)
        ),
        "",
        "## Parameters",
        "",
        "| parameter | at the motor | at the joint | unit | reflection | from |",
        "|---|--:|--:|---|---|---|",
    ]
    for row in card.rows:
        sides = (_shown(row.motor), _shown(row.joint))
        cells = (row.title, *sides, row.unit, row.reflection, row.origin)
        lines.append(f"| {' | '.join(map(_cell, cells))} |")
    lines += ["", "## What clients call it", ""]
    titles = [client.title for client in clients()]
    lines += [f"| parameter | {' | '.join(titles)} |", "|---" * (len(titles) + 1) + "|"]
    for row in card.rows:
        if row.clients:
            told = [row.clients.get(client.key, "") for client in clients()]
            lines.append(f"| {_cell(row.title)} | {' | '.join(map(_cell, told))} |")
    for client in clients():
        lines += ["", f"## {client.title}", "", f"Version {client.version}; {client.checked}.", ""]
        for key, part in card.settings[client.key].items():
            lines += [f"`{key}`", "", "| setting | value |", "|---|--:|"]
            lines += [f"| `{name}` | {_cell(_shown(value))} |" for name, value in part.items()]
            lines.append("")
        lines.append(f"Not expressed: {client.missing}.")
    return "\n".join(lines) + "\n"


def _conventions(card: Card) -> tuple[tuple[str, str], ...]:
    side, n = card.side, f"{card.side.reduction:g}"
    inertia = next(row for row in card.rows if row.key == "motor_side_inertia")
    effort = next(row for row in card.rows if row.key == "effort_limit")
    sense = "against" if side.crank_sense < 0 else "with"
    return (
        (
            "sense",
            "A positive command turns the joint positive in every client. The gearbox's signed "
            f"ratio is {card.ratio:g}, so the crank turns {sense} the joint and the drive's wiring "
            f"makes up for it; clients get the reduction {n}, never a negative one.",
        ),
        (
            "torque_constant",
            "K is that of the equivalent DC machine, v = R i + L di/dt + K w and torque = K i with "
            "one K in N m/A = V s/rad; R and L are line to line, the current that of a line in "
            "six-step operation. Of the same motor, with sinusoidal back-EMF, over the q-axis "
            f"current of field-oriented control: {card.constants['torque_per_peak']:.6g} N m/A "
            f"with its peak, {card.constants['torque_per_rms']:.6g} with its r.m.s. value. Convert "
            "before comparing.",
        ),
        (
            "temperature",
            f"K, resistance and what follows from them hold at {card.ambient:g} degC around the "
            "actuator (environment.ambient), motor cold; the continuous torque at the winding's "
            "limit.",
        ),
        (
            "reflection",
            f"With n = {n}: torque and K times n; angle and speed over n; inertia, damping and "
            f"stiffness times n^2 = {side.reduction**2:g}. For instance {inertia.motor:.6g} kg m^2 "
            f"of rotor and crank are {inertia.motor:.6g} x {side.reduction**2:g} = "
            f"{inertia.joint:.6g} kg m^2 at the joint; with {side.output_inertia:.6g} of the "
            f"output side the joint feels {side.reflected_inertia:.6g}.",
        ),
        (
            "effort",
            "Settings that limit effort, force or torque hold what a stalled output gives after "
            f"all friction, {effort.joint:.6g} N m, not the {side.peak_torque:.6g} N m that "
            "motor and drive allow: friction under load keeps the difference. A client that takes "
            "Coulomb friction off as well takes its part twice.",
        ),
        *((("gearbox", overload_remark(card.beyond)),) if card.beyond else ()),
        (
            "armature",
            "Settings named armature hold rotor and crank only, as the output side's "
            f"{side.output_inertia:.6g} kg m^2 belong into the driven link's inertia; where they "
            f"are not in it set {side.reflected_inertia:.6g}. A learned torque has all of it, and "
            "friction and damping, in itself: with a network of `torque export` set armature, "
            "friction and damping of the joint to 0.",
        ),
    )


def _harmonics(parameters: ActuatorParameters) -> dict[str, object]:
    gear = parameters.gear
    series = {
        "kinematic_error_cosine_rad": gear.error_cosine,
        "kinematic_error_sine_rad": gear.error_sine,
        "stiffness_cosine": gear.stiffness_cosine,
        "stiffness_sine": gear.stiffness_sine,
    }
    orders = [int(order) for order in gear.error_orders]
    return {"orders": orders} | {key: [float(v) for v in one] for key, one in series.items()}


def _shown(value: object) -> str:
    if value is None or (isinstance(value, float) and not math.isfinite(value)):
        return ""
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _cell(text: str) -> str:
    return text.replace("|", "\\|")
