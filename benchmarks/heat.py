"""Losses, temperature rise, the motor's ceiling and a four-point duty beside cycloidgen 8.0.0.

    python benchmarks/heat.py --cycloidgen PYTHON [--write]

Both judge the same three designs in one run, with plain friction of 0.08 and no lubricant film, so
that what differs are the forces and the way heat takes. Differences above 20 % are explained by the
table itself, row by row. `--cycloidgen` names the Python of an environment that has it installed;
`--write` puts the table into docs/benchmarks.md.
"""

from __future__ import annotations

import argparse
import json
import math
import subprocess
import sys
from pathlib import Path

from processes import write_section

from cqdd_design.design import Design, load_design
from cqdd_design.gearbox.heat.network import Heat
from cqdd_design.machine import Machine, resolve
from cqdd_design.machine.duty_heat import duty_cases, duty_heat
from cqdd_design.machine.heat_nodes import NODES
from cqdd_design.machine.thermal_parts import machine_network

REPOSITORY = Path(__file__).resolve().parents[1]
PEER = REPOSITORY / "benchmarks" / "cycloidgen_heat.py"
RPM = math.pi / 30.0
HEADING = "## Losses, heat and the motor's ceiling beside cycloidgen 8.0.0"
WORDS = """\
The same plain friction of 0.08 on both sides, losses of parts as drawn; rises are of the gearbox's
heat alone. The duty has four points: all of the continuous torque at all of the speed for a fifth
of the time, half at all, a quarter at half, and three quarters at a quarter. S/4 is S at 10 N·m and
42 rad/s. What differs by more than a fifth is explained in its row."""
SHARES = ((1.0, 1.0, 0.2), (0.5, 1.0, 0.3), (0.25, 0.5, 0.3), (0.75, 0.25, 0.2))
"""Of continuous torque and output speed, and of the time."""

WHY = {
    "loss_W": "of S at the teeth 99 W here (88 with friction left out of the balance of forces), "
    "70 there by another law of how teeth share; pins 38 and 44, bearings and grease 11 and 6",
    "rise_K": "its 12 W/(m²·K) hold at any rise, natural convection weakens as the rise gets small "
    "(5 to 9 W/(m²·K) with bare metal's radiation); its area is a case round the discs, here it is "
    "that of the drawn motor",
    "motor_required_Nm": "follows from the losses",
    "output_ceiling_Nm": "follows from the losses at the rated current",
    "duty_loss_W": "as the losses at one point",
    "duty_rise_K": "as the rise at one point",
    "duty_rms_motor_Nm": "follows from the losses",
    "duty_peak_motor_Nm": "follows from the losses",
}


def designs() -> list[tuple[str, Design]]:
    """S, the paper's, and S at a part load."""
    folder = REPOSITORY / "designs"
    s, paper = (load_design(folder / name) for name in ("reference-s.toml", "cqdd-10.toml"))
    part = s.replacing({"requirements.continuous_torque": 10.0, "requirements.input_speed": 42.0})
    return [(name, with_duty(one)) for name, one in (("S", s), ("cqdd-10", paper), ("S/4", part))]


def with_duty(design: Design) -> Design:
    """With plain friction and the four points."""
    asked = design.requirements
    speed = asked.input_speed / design.reducer.ratio
    duty = [
        {"torque": t * asked.continuous_torque, "speed": w * speed, "share": share}
        for t, w, share in SHARES
    ]
    plain = {"reducer.friction.tooth": 0.08, "reducer.friction.pin": 0.08}
    return design.replacing({"requirements.duty": duty} | plain)


def given(design: Design, machine: Machine) -> dict[str, object]:
    """The design as cycloidgen takes it, mm."""
    reducer, asked = design.reducer, design.requirements
    row, pins = machine.motor, reducer.output_pins
    n = reducer.ratio
    return {
        "pin_circle_radius": 1e3 * reducer.ring_pitch_radius,
        "pin_radius": 0.5e3 * reducer.ring_pin_diameter,
        "eccentricity": 1e3 * reducer.eccentricity,
        "lobes": n,
        "disc_thickness": 1e3 * reducer.disc_thickness,
        "disc_count": reducer.disc_count,
        "disc_gap": 1e3 * reducer.disc_spacing,
        "output_pin_count": pins.count,
        "output_pin_diameter": 2e3 * machine.contact.pin_contact_radius,
        "output_bolt_circle_radius": 1e3 * pins.circle_radius,
        "center_bore_diameter": 1e3 * machine.cam.outer_diameter,
        "input_shaft_diameter": 1e3 * machine.cam.bore_diameter,
        "profile_clearance": 1e3 * reducer.modification.equidistant,
        "hole_clearance": 1e3 * pins.hole_clearance,
        "disc_material": "Steel 4140 (hardened)",
        "pin_material": "Steel 4140 (hardened)",
        "housing_material": "Aluminium 7075-T6",
        "friction_coefficient": 0.08,
        "ring_pins_integral": True,
        "input_rpm": asked.input_speed / RPM,
        "output_torque_Nm": asked.continuous_torque,
        "ambient_temp_C": design.environment.ambient,
        "motor_kind": "DC or brushless",
        "motor_supply_V": design.motor.voltage,
        "motor_resistance_ohm": row.line_resistance,
        "motor_rated_current_A": row.rated_current,
        "motor_kv_rpm_per_V": (row.speed_constant or 0.0) / RPM,
        "duty": [
            (str(k), one.torque, one.speed / RPM, 100.0 * one.share)
            for k, one in enumerate(asked.duty)
        ],
    }


def ours(machine: Machine) -> dict[str, float]:
    """The same figures here: the gearbox's heat alone, in the still air round the drawn parts."""
    asked, n = machine.design.requirements, machine.design.reducer.ratio
    network, disc = machine_network(machine), NODES.index("disc")
    winding = NODES.index("winding")
    losses, row = machine.losses, machine.motor

    def gearbox_rise(duty: bool) -> tuple[float, float]:
        found = duty_heat(machine, duty_cases(machine, duty=duty))
        watts = found.heat.fixed.copy()
        watts[[winding, NODES.index("stator")]] = 0.0
        steady = network.steady(Heat.constant(watts))
        return found.gearbox, float(steady[disc] - network.ambient)

    def motor(torque: float, speed: float) -> float:
        return (abs(torque) + losses.at(speed, torque).loss_torque) / n

    one, rise = gearbox_rise(False)
    mean, duty_rise = gearbox_rise(True)
    most = (row.torque_constant or 0.0) * (row.rated_current or 0.0)
    low, high = 0.0, n * most
    for _ in range(50):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if motor(middle, asked.input_speed) < most else (low, middle)
    torques = [motor(case.torque, n * case.speed) for case in asked.duty]
    shares = [case.share for case in asked.duty]
    return {
        "loss_W": one,
        "rise_K": rise,
        "motor_required_Nm": motor(asked.continuous_torque, asked.input_speed),
        "output_ceiling_Nm": low,
        "duty_loss_W": mean,
        "duty_rise_K": duty_rise,
        "duty_rms_motor_Nm": math.sqrt(sum(s * t**2 for s, t in zip(shares, torques, strict=True))),
        "duty_peak_motor_Nm": max(torques),
    }


def table(python: str) -> list[str] | str:
    """Lines of the table, or what cycloidgen's side said where it failed."""
    machines = [(name, resolve(design)) for name, design in designs()]
    asked = json.dumps([given(machine.design, machine) for _, machine in machines])
    done = subprocess.run(
        [python, str(PEER)], input=asked, capture_output=True, text=True, check=False
    )
    if done.returncode:
        return done.stderr
    lines = [
        "| design | figure | here | cycloidgen | difference | why |",
        "|---|---|---|---|---|---|",
    ]
    for (name, machine), theirs in zip(machines, json.loads(done.stdout), strict=True):
        for key, value in ours(machine).items():
            off = value / theirs[key] - 1.0
            why = WHY[key] if abs(off) > 0.2 else ""
            lines.append(
                f"| {name} | `{key}` | {value:.3g} | {theirs[key]:.3g} "
                f"| {100.0 * off:+.0f}\u202f% | {why} |"
            )
    return lines


def main() -> int:
    """Print or write the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    parser.add_argument("--cycloidgen", metavar="PYTHON", required=True)
    parser.add_argument("--write", action="store_true")
    asked = parser.parse_args()
    found = table(asked.cycloidgen)
    if isinstance(found, str):
        print(found, file=sys.stderr)
        return 1
    text = "\n".join([*WORDS.splitlines(), "", *found])
    if asked.write:
        write_section("heat", "heat.py", HEADING, text + "\n")
    else:
        print(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
