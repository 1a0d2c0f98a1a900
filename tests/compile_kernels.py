"""Compile the kernels into numba's cache, once, before many tests would each do it.

    python tests/compile_kernels.py elastic     bodies that yield
    python tests/compile_kernels.py moving      time stepping, networks, friction
    python tests/compile_kernels.py gearboxes   what is toleranced: rests on the other two

The first two share next to no kernel, for two cores.
"""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

TESTS = Path(__file__).resolve().parent
PAPER = TESTS.parent / "designs" / "cqdd-10.toml"


def elastic() -> None:
    """Equilibria without friction on discs and ring that give way."""
    from cqdd_design.design import load_design
    from cqdd_design.gearbox.contact.sweep import contact_sweep, perfect_angles
    from cqdd_design.machine import resolve

    model = resolve(load_design(PAPER)).contact
    contact_sweep(model, 20.0, perfect_angles(model, 8))


def moving() -> None:
    """An actuator made by hand, networks with drawn weights, and friction on rigid bodies."""
    sys.path.insert(0, str(TESTS / "oracles"))
    from actuator_samples import paper_actuator
    from torque_networks import motion, network

    from cqdd_design.actuator.scenario import Scenario
    from cqdd_design.actuator.simulate import simulate
    from cqdd_design.design import load_design
    from cqdd_design.gearbox.contact.rubbing import ContactFriction
    from cqdd_design.gearbox.contact.sweep import contact_sweep, perfect_angles
    from cqdd_design.machine import resolve
    from cqdd_design.torque.networks.predict import predict

    simulate([paper_actuator()], Scenario(), 1e-3, 1e-5)
    for family, mode in (("gru", "streaming"), ("gru", "window"), ("mlp", "window")):
        drawn = network(family, mode)
        predict(drawn, np.asarray(motion(drawn, 64)))
    model = resolve(load_design(PAPER)).contact
    rigid = replace(model, bodies=None, pin=None)
    contact_sweep(
        rigid, 20.0, perfect_angles(rigid, 8), friction=ContactFriction.of(rigid, "drive")
    )


def gearboxes() -> None:
    """A whole analysis, and an ensemble of two gearboxes."""
    from cqdd_design.design import load_design
    from cqdd_design.gearbox.tolerance.ensemble import make_ensemble
    from cqdd_design.gearbox.tolerance.run import run_ensemble
    from cqdd_design.machine import resolve
    from cqdd_design.machine.contact_analysis import analyse_contact

    design = load_design(PAPER)
    analyse_contact(resolve(design), angles=44)
    run_ensemble(make_ensemble(design, angles=44), 2)


if __name__ == "__main__":
    {"elastic": elastic, "moving": moving, "gearboxes": gearboxes}[sys.argv[1]]()
