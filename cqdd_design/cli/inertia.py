"""``cqdd-design inertia``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

from cqdd_design.cli.options import (
    DesignFile,
    NamedMotor,
    OwnMotor,
    parse_positive,
    quantity_option,
)
from cqdd_design.cli.session import Output, read_design, read_specimen
from cqdd_design.cli.tables import number, table, told

if TYPE_CHECKING:
    from cqdd_design.roads.inertia import InertiaAndBalance


def inertia(
    out: Output,
    design: DesignFile,
    speed: Annotated[str | None, quantity_option('Input speed, as in "1286 rpm".')] = None,
    motor: NamedMotor = None,
    motor_file: OwnMotor = None,
) -> None:
    """Masses of the parts, balance, inertia at the motor."""
    from cqdd_design.roads.inertia import INERTIA_STAGES
    from cqdd_design.roads.inertia import inertia as weighed
    from cqdd_design.units import SPEED

    asked = parse_positive("--speed", speed, SPEED)
    loaded = read_design(out, design, motor, motor_file)
    specimen = read_specimen(
        out,
        loaded,
    )
    found = weighed(loaded, specimen, speed=asked, progress=out.stages(INERTIA_STAGES))
    out.say(*_lines(found))
    out.warn(*found.warnings)
    out.document(found.to_dict(), design=loaded)


def _lines(found: InertiaAndBalance) -> list[str]:
    from cqdd_design.solids.inertia import rotor_scope

    parts = [
        [
            part.name,
            str(part.count),
            number(1e3 * part.properties.mass),
            number(1e9 * part.volume),
            number(1e9 * part.exact_volume),
            number(1e6 * part.reflected),
            part.material,
        ]
        for part in found.bodies.inertia.parts
    ]
    head = ["part", "pieces", "g each", "mm^3 mesh", "mm^3 exact", "at input kg*mm^2", "material"]
    balance = [
        [
            f"{count} disc" + ("s" if count > 1 else ""),
            number(1e6 * one.static_unbalance),
            number(1e9 * one.couple_unbalance),
            number(one.shaking_force),
            number(one.shaking_moment),
        ]
        for count, one in found.bodies.balance.items()
    ]
    balance_head = ["balance", "static g*mm", "couple g*mm^2", "force N", "moment N*m"]
    total = found.bodies.inertia
    inertias = total.group_inertias
    groups = [
        [name, number(1e3 * mass), _known(inertias[name], 1e6)]
        for name, mass in total.group_masses.items()
    ]
    group_head = ["group", "g", "at input kg*mm^2"]
    rotor = _known(total.rotor_inertia, 1e6)
    return [
        table(parts, head=head, right=(1, 2, 3, 4, 5)),
        "",
        table(groups, head=group_head, right=(1, 2)),
        "",
        f"total mass                 {_known(total.whole_mass)} kg",
        f"torque density             {_known(found.torque_density)} N*m/kg",
        f"rotor of {total.motor.name}, {rotor_scope(total.motor)}: {rotor} kg*mm^2",
        f"reflected to the input     {_known(total.reflected_input, 1e6)} kg*mm^2",
        f"reflected to the output    {_known(total.reflected_output)} kg*m^2",
        "",
        told(
            [
                ("total mass", total.mass_scope),
                ("torque density", found.torque_density_scope),
                ("reflected", total.inertia_scope),
            ]
        ),
        "",
        table(balance, head=balance_head, right=(1, 2, 3, 4)),
        f"the paper's rule asks for {found.paper_disc_count} discs",
    ]


def _known(value: float | None, factor: float = 1.0) -> str:
    return "unknown" if value is None else number(factor * value)
