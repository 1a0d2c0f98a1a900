"""Time the actuator in time: steps a second, over parameter sets, beside MuJoCo and scipy.

    python benchmarks/actuator_steps.py [--write]

Everything is measured in one run, after compilation (warm), on the paper's design with one drawn
gearbox: kinematic error and stiffness in 64 orders, backlash, stiffening spring, load-dependent
friction with stick and slip, current loop with delay, thermal network. A step is one implicit step
of the whole actuator. MuJoCo steps the MJCF that `export --to mjcf` writes, many steps to a call of
`mj_step`, in one thread. `--write` puts the result into docs/benchmarks.md. Run it by hand on a
machine that does nothing else.
"""

from __future__ import annotations

import argparse
import itertools
import math
import os
import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from importlib import metadata
from pathlib import Path

import numpy as np
from processes import machine, write_section

from cqdd_design.actuator.build import actuator_parameters
from cqdd_design.actuator.columns import LEDGER, TRACES, Ledger, Signals, Steps, Traces
from cqdd_design.actuator.kernels import stepping as kernel
from cqdd_design.actuator.packing import (
    gear_table,
    kinematic_error,
    pack,
    stiffness_share,
    table_points,
)
from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.actuator.scenario import Command, Constant, Load, Scenario, Sine, Wall
from cqdd_design.actuator.simulate import Work, run_compiled, simulate
from cqdd_design.actuator.specimen import Specimen
from cqdd_design.design import load_design
from cqdd_design.machine import resolve

REPOSITORY = Path(__file__).resolve().parents[1]
DESIGN = REPOSITORY / "designs" / "cqdd-10.toml"
HEADING = "## The actuator in time"
PACKAGES = ("numpy", "scipy", "numba", "mujoco")
STEP, STEPS, GOAL = 2e-5, 500_000, 5e6

VOLTS = 12.0
"""At the motor with its output free: what the exported MJCF is, stepped by both."""
THREADS, ROUNDS = (1, 2, 4), 10

SCENES = {
    "locked": Scenario(Command("torque", Sine(20.0, 2.0)), Load.locked(2e4, 1.0)),
    "pendulum": Scenario(Command("impedance", Sine(1.0, 0.8)), Load.pendulum(2.28, 0.5)),
    "pendulum before a wall": Scenario(
        Command("impedance", Sine(1.0, 0.8)), Load.pendulum(2.28, 0.5, wall=Wall(0.5, 2000.0))
    ),
}


def work_of(sets: list[ActuatorParameters], scene: Scenario, steps: int) -> Work:
    """Arguments of the kernel for some sets, without their range."""
    rows = np.array([pack(one, scene, STEP) for one in sets])
    points = max(table_points(one.gear) for one in sets)
    tables = np.array([gear_table(one.gear, points) for one in sets])
    middle = STEP * (np.arange(steps) + 0.5)
    reference = scene.command.reference.values(middle)[None]
    rate = scene.command.reference.rates(middle)[None]
    none = np.zeros((1, 1))
    signals = Signals(reference, rate, none, none, none)
    traces = Traces(*np.zeros((len(TRACES), len(sets), steps // 50)))
    ledger = Ledger(*np.zeros((len(LEDGER), len(sets))))
    return rows, tables, signals, Steps(STEP, steps, 50), traces, ledger


def seconds_of(call: Callable[[], None]) -> float:
    """Seconds that a call takes."""
    began = time.perf_counter()
    call()
    return time.perf_counter() - began


def kernel_rate(one: ActuatorParameters, scene: Scenario, steps: int, runs: int = 5) -> float:
    """Actuator steps a second of the kernel alone on one core, best of some runs."""
    work = work_of([one], scene, steps)
    return steps / min(seconds_of(lambda: run_compiled(work, 1)) for _ in range(runs))


def plain_rate(one: ActuatorParameters, scene: Scenario, steps: int = 2000) -> float:
    """Steps a second of the numpy twin."""
    began = time.perf_counter()
    simulate(one, scene, steps * STEP, STEP, engine="plain")
    return steps / (time.perf_counter() - began)


def scipy_times(one: ActuatorParameters, seconds: float) -> dict[str, float]:
    """Seconds that scipy takes for the locked actuator; nan where it gives up.

    The equations are the same, gap, stiffening, load-dependent friction and contact that only
    pushes included; dry friction is smoothed to a tanh of 0.1 rad/s at the motor, because a jump
    stops an integrator of smooth equations. Harmonics are tabulated, so that it does not pay for
    their sums.
    """
    from scipy.integrate import solve_ivp

    gear, motor, friction = one.gear, one.motor, one.friction
    n, count = abs(gear.ratio), 16384
    turn = 2.0 * math.pi * n
    grid = turn * np.arange(count + 1) / count
    error, share = kinematic_error(gear, grid), stiffness_share(gear, grid)
    error_slope, share_slope = np.gradient(error, grid), np.gradient(share, grid)
    sensor = SCENES["locked"].load

    def at(values: np.ndarray, angle: float) -> float:
        place = angle / turn % 1.0 * count
        low = int(place)
        return float(values[low] + (place - low) * (values[low + 1] - values[low]))

    def rates(t: float, state: np.ndarray) -> tuple[float, ...]:
        current, angle, speed, out, out_speed = state
        shape = 1.0 / gear.ratio + at(error_slope, angle)
        closing = angle / gear.ratio + at(error, angle) - out
        beyond = math.copysign(max(abs(closing) - 0.5 * gear.backlash, 0.0), closing)
        spring = (
            gear.error_torque
            * (gear.stiffness * abs(beyond) / gear.error_torque) ** gear.stiffening
        )
        torque = at(share, angle) * math.copysign(spring, closing)
        if beyond:
            pushed = torque + gear.damping * (shape * speed - out_speed)
            torque = pushed if pushed * torque > 0.0 else 0.0
        varying = spring * abs(beyond) / (gear.stiffening + 1.0) * at(share_slope, angle)
        slip, out_slip = math.tanh(speed / 0.1), math.tanh(out_speed * n / 0.1)
        level = friction.motor_coulomb + friction.load_forward * abs(torque) / n
        level *= 1.0 + friction.stribeck_extra * math.exp(-((speed / friction.stribeck_speed) ** 2))
        drive = motor.torque_constant * current - friction.motor_viscous * speed - level * slip
        wanted = 20.0 * math.sin(4.0 * math.pi * t) / (gear.ratio * motor.torque_constant)
        held = sensor.sensor_stiffness * out + sensor.sensor_damping * out_speed
        held += friction.output_viscous * out_speed + friction.output_coulomb * out_slip
        return (
            2.0 * math.pi * one.drive.current_bandwidth * (wanted - current),
            speed,
            (drive - shape * torque - varying) / one.motor_side_inertia,
            out_speed,
            (torque - held) / gear.output_inertia,
        )

    first = pack(one, SCENES["locked"], STEP).motor_angle
    found = {}
    for method in ("RK45", "LSODA", "Radau"):
        began = time.perf_counter()
        end = solve_ivp(
            rates, (0.0, seconds), [0.0, first, 0.0, 0.0, 0.0], method, rtol=1e-6, atol=1e-9
        )
        found[method] = time.perf_counter() - began if end.success else math.nan
    return found


def mujoco_rate(one: ActuatorParameters, step: float | None = None, runs: int = 5) -> float:
    """Steps a second of MuJoCo on the exported model, output free; its own step by default."""
    import mujoco

    from cqdd_design.exporting.simulators.mjcf import model_text
    from cqdd_design.exporting.simulators.mjcf_classes import MjcfActuator

    model = mujoco.MjModel.from_xml_string(model_text(MjcfActuator(one, "actuator")))
    if step is not None:
        model.opt.timestep = step
    data = mujoco.MjData(model)
    data.ctrl[0] = VOLTS
    steps, best = 20_000, math.inf
    for _ in range(runs):
        began = time.perf_counter()
        mujoco.mj_step(model, data, nstep=steps)
        best = min(best, time.perf_counter() - began)
    return steps / best


def beside_mujoco(one: ActuatorParameters) -> list[tuple[str, str, str]]:
    """Rows of the same actuator, free at a constant voltage, in MuJoCo and here."""
    import mujoco

    from cqdd_design.exporting.simulators.mjcf_classes import time_step

    free = Scenario(Command("voltage", Constant(VOLTS)), Load.free())
    kernel_rate(one, free, 1000, 1)
    ours, theirs = kernel_rate(one, free, STEPS), mujoco_rate(one, STEP)
    own = time_step(one)
    coarse = mujoco_rate(one, own) * own
    return [
        (
            f"MuJoCo {mujoco.__version__}, `mj_step` of the exported MJCF, one thread, free at "
            f"{VOLTS:g} V, the same step",
            f"{theirs:,.0f} against {ours:,.0f}: {ours / theirs:.0f} times slower",
            "",
        ),
        (
            f"the same, MuJoCo at the file's own step of {1e6 * own:g} \u00b5s, in simulated "
            "seconds a second",
            f"{coarse:,.1f} against {ours * STEP:,.0f}: {ours * STEP / coarse:.1f} times slower",
            "",
        ),
    ]


def beside_scipy(one: ActuatorParameters, seconds: float = 0.25) -> list[tuple[str, str, str]]:
    """Rows of the locked actuator integrated by scipy and here."""
    ours = seconds / STEP / kernel_rate(one, SCENES["locked"], STEPS)
    return [
        (
            f"scipy.integrate.solve_ivp, {method}, rtol 1e-6, {seconds:g} s of the locked "
            "actuator, dry friction smoothed",
            f"{theirs:.2f} s against {1e3 * ours:.2f} ms: {theirs / ours:,.0f} times slower",
            "",
        )
        for method, theirs in scipy_times(one, seconds).items()
    ]


def in_processes(work: Work, number: int) -> None:
    """The same sets shared out to processes that have nothing in common but the machine."""
    ends = [len(work[0]) * i // number for i in range(number + 1)]
    children = []
    for first, last in itertools.pairwise(ends):
        child = os.fork()
        if not child:
            kernel.run_sets(*work, first, last)
            os._exit(0)
        children.append(child)
    for child in children:
        os.waitpid(child, 0)


def over_sets(one: ActuatorParameters) -> list[tuple[str, str, str]]:
    """Rows of many parameter sets on several threads, and on processes as what is to be had.

    The ways take turns, and the best of each counts, so that a neighbour's load falls on all.
    """
    sets = [replace(one, gear=replace(one.gear, backlash=1e-4 * (1 + i % 9))) for i in range(64)]
    rows = []
    for number in (4, 16, 64):
        steps = STEPS * 64 // (5 * number)
        work = work_of(sets[:number], SCENES["pendulum"], steps)
        ways = {
            f"{threads} thread{'s' * (threads > 1)}": partial(run_compiled, work, threads)
            for threads in THREADS
            if threads <= (os.cpu_count() or 1)
        }
        if hasattr(os, "fork"):
            ways[f"{THREADS[-1]} processes"] = partial(in_processes, work, THREADS[-1])
        best = dict.fromkeys(ways, math.inf)
        for _ in range(ROUNDS):
            for name, way in ways.items():
                best[name] = min(best[name], seconds_of(way))
        first = best["1 thread"]
        found = ", ".join(
            f"{name}: {number * steps / least / 1e6:.1f} million ({first / least:.2f})"
            for name, least in best.items()
        )
        rows.append((f"pendulum, {number} parameter sets", found, "linear to 4 cores"))
    return rows


def measure() -> list[tuple[str, str, str]]:
    """Rows of (what, measured, goal)."""
    one = actuator_parameters(resolve(load_design(DESIGN)), Specimen(seed=1))
    rows = []
    for name, scene in SCENES.items():
        kernel_rate(one, scene, 1000, 1)
        rate = kernel_rate(one, scene, STEPS)
        goal = f"at least {GOAL:,.0f}" if "wall" not in name else ""
        rows.append((f"steps a second, one core, {name}", f"{rate:,.0f}", goal))
    slow = plain_rate(one, SCENES["pendulum"])
    fast = kernel_rate(one, SCENES["pendulum"], STEPS)
    return [
        *rows,
        *over_sets(one),
        ("the plain twin in numpy, pendulum", f"{slow:,.0f}: {fast / slow:,.0f} times slower", ""),
        *beside_mujoco(one),
        *beside_scipy(one),
    ]


def main() -> None:
    """Measure and show, or write into the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", action="store_true")
    asked = parser.parse_args()
    rows = measure()
    versions = ", ".join(f"{name} {metadata.version(name)}" for name in PACKAGES)
    lines = [
        "Written by `python benchmarks/actuator_steps.py --write`, in one run, after compilation",
        f"(warm); steps of {1e6 * STEP:g} \u00b5s, one drawn gearbox of `designs/cqdd-10.toml`.",
        "",
        *machine()[:1],
        f"- {versions}",
        "",
        "| what | measured | goal |",
        "|---|---|---|",
        *(f"| {what} | {found} | {goal} |" for what, found, goal in rows),
    ]
    text = "\n".join(lines) + "\n"
    if asked.write:
        write_section("actuator", "actuator_steps.py", HEADING, text)
    else:
        print(text)


if __name__ == "__main__":
    main()
