"""Score the committed torque networks on actuators that are not quite the one they carry.

    python benchmarks/torque_mismatch.py [--episodes N] [--write]

The networks hold the actuator that they were trained on. Here fresh episodes of the same pendulum
(other draws than any of training) run on that actuator, and on ones whose friction independent of
load, whose inertia, whose friction under load, and whose all three are off by 30 %, in every
combination of signs. What a network cannot know it gets wrong: the table says how much of the
difference between networks is left. RMSE of the output torque in N m over all samples, and over
those in which neither voltage nor current limit binds. `--write` puts the table into
docs/torque-estimation.md.
"""

from __future__ import annotations

import argparse
import dataclasses
import itertools
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.files import write_atomically
from cqdd_design.torque.data import pendulum
from cqdd_design.torque.data.episodes import Episode
from cqdd_design.torque.data.sensing import SensorChain
from cqdd_design.torque.evaluation.carried import actuator_of
from cqdd_design.torque.evaluation.estimator import Estimator, network_estimator
from cqdd_design.torque.networks.artefact import read_artefact

REPOSITORY = Path(__file__).resolve().parents[1]
FOLDER = REPOSITORY / "designs" / "cqdd-10-torque"
PAGE = REPOSITORY / "docs" / "torque-estimation.md"
BEGIN, END = (
    "<!-- mismatch: written by benchmarks/torque_mismatch.py -->",
    "<!-- end of mismatch -->",
)
NETWORKS = {
    "streaming PVA-GRU": "streaming/pva-gru-0",
    "`pva-gru`": "pva-gru-0",
    "`physics-gru`": "physics-gru-0",
    "`physics-phase-gru`": "physics-phase-gru-0",
}
OFF = 0.3
ERRORS = ("friction", "inertia", "load friction")
SEED, KIND, SECONDS, SETTLING = 2026, 7, 10.0, 30
"""Of the draws, no kind that `torque generate` knows; s; samples that the windows take to fill."""


def changed(actuator: ActuatorParameters, **factors: float) -> ActuatorParameters:
    """An actuator with friction, inertia and load friction multiplied."""
    dry, heavy, load = (factors.get(name.replace(" ", "_"), 1.0) for name in ERRORS)
    own, motor, gear = actuator.friction, actuator.motor, actuator.gear
    rubbing = ("motor_coulomb", "output_coulomb", "motor_viscous", "output_viscous")
    friction = {name: dry * getattr(own, name) for name in rubbing}
    friction |= {name: load * getattr(own, name) for name in ("load_forward", "load_backward")}
    return dataclasses.replace(
        actuator,
        friction=dataclasses.replace(own, **friction),
        motor=dataclasses.replace(
            motor,
            rotor_inertia=heavy * motor.rotor_inertia,
            iron_loss=dry * motor.iron_loss,
            hysteresis=dry * motor.hysteresis,
        ),
        gear=dataclasses.replace(
            gear,
            input_inertia=heavy * gear.input_inertia,
            output_inertia=heavy * gear.output_inertia,
        ),
    )


def specimens(actuator: ActuatorParameters) -> Iterator[tuple[str, list[ActuatorParameters]]]:
    """What is off, and actuators with every sign of it."""
    yield "as carried", [actuator]
    for wrong in [*((name,) for name in ERRORS), ERRORS]:
        keys = [name.replace(" ", "_") for name in wrong]
        signs = itertools.product((1.0 - OFF, 1.0 + OFF), repeat=len(keys))
        told = f"{' and '.join(wrong) if len(wrong) < 3 else 'all three'} ±{100.0 * OFF:.0f} %"
        yield told, [changed(actuator, **dict(zip(keys, one, strict=True))) for one in signs]


def recorded(actuator: ActuatorParameters, count: int) -> tuple[Episode, ...]:
    """Episodes of an actuator, the same experiments for each."""
    plans = pendulum.draw(count, SEED, KIND, gearbox=0)
    names = [f"fresh-{number:04d}" for number in range(count)]
    chain = SensorChain()
    return pendulum.record(plans, names, {0: actuator}, seconds=SECONDS, chain=chain, seed=SEED)[0]


def rmse(estimator: Estimator, sets: list[tuple[Episode, ...]]) -> tuple[float, float]:
    """Over all samples, and over those that no limit binds; the mean over sets, N m."""
    found = []
    for episodes in sets:
        errors, free = [], []
        for one in episodes:
            off = estimator.estimate(one) - np.asarray(one.columns["torque"], np.float64)
            errors.append(off[SETTLING:])
            free.append(~one.flag("saturated")[SETTLING:])
        error, unbound = np.concatenate(errors), np.concatenate(free)
        found.append([np.sqrt(np.mean(part**2)) for part in (error, error[unbound])])
    whole, apart = np.mean(found, axis=0)
    return float(whole), float(apart)


def table(count: int) -> str:
    """The table as Markdown."""
    artefacts = {name: read_artefact(FOLDER / f"{path}.npz") for name, path in NETWORKS.items()}
    actuator = actuator_of(list(artefacts.values()))
    if actuator is None:
        raise SystemExit(f"no network in {FOLDER} holds its actuator")
    estimators = {name: network_estimator(one) for name, one in artefacts.items()}
    lines = [
        f"{count} fresh episodes of {SECONDS:g} s each; RMSE in N·m over all samples, in brackets "
        "with saturation apart.",
        "",
        f"| off | {' | '.join(NETWORKS)} |",
        f"|---{'|---:' * len(NETWORKS)}|",
    ]
    for told, actuators in specimens(actuator):
        sets = [recorded(one, count) for one in actuators]
        scores = [rmse(one, sets) for one in estimators.values()]
        cells = [f"{whole:.2f} ({apart:.2f})" for whole, apart in scores]
        lines.append(f"| {told} | {' | '.join(cells)} |")
        print(lines[-1], flush=True)
    return "\n".join(lines)


def main() -> None:
    """Score, print, and write."""
    asked = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    asked.add_argument("--episodes", type=int, default=40, help="a set (default 40)")
    asked.add_argument("--write", action="store_true", help="into docs/torque-estimation.md")
    options = asked.parse_args()
    found = table(options.episodes)
    if options.write:
        before, _, rest = PAGE.read_text(encoding="utf-8").partition(BEGIN)
        after = rest.partition(END)[2]
        write_atomically(PAGE, f"{before}{BEGIN}\n\n{found}\n\n{END}{after}", "markdown")


if __name__ == "__main__":
    main()
