"""Compile the kernels into numba's cache, once, before many tests would each do it.

    python tests/compile_kernels.py gearbox     contact, precision, tolerance
    python tests/compile_kernels.py actuator    time stepping, networks

Two halves that share no kernel, for two cores.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

TESTS = Path(__file__).resolve().parent


def gearbox() -> None:
    """A contact analysis, and ensembles of two gearboxes, of all outputs and of loads alone."""
    from cqdd_design.design import load_design
    from cqdd_design.gearbox.tolerance.ensemble import make_ensemble, run_ensemble
    from cqdd_design.gearbox.tolerance.evaluate import LOADS, OUTPUTS
    from cqdd_design.machine import resolve
    from cqdd_design.machine.contact_analysis import analyse_contact

    design = load_design(TESTS.parent / "designs" / "cqdd-10.toml")
    analyse_contact(resolve(design))
    for outputs in (OUTPUTS, LOADS):
        run_ensemble(make_ensemble(design, angles=44, outputs=outputs), 2)


def actuator() -> None:
    """A few steps of an actuator made by hand, and of a network with drawn weights."""
    sys.path.insert(0, str(TESTS / "oracles"))
    from actuator_samples import paper_actuator
    from torque_networks import motion, network

    from cqdd_design.actuator.scenario import Scenario
    from cqdd_design.actuator.simulate import simulate
    from cqdd_design.torque.networks.predict import predict

    simulate([paper_actuator()], Scenario(), 1e-3, 1e-5)
    for family, mode in (("gru", "streaming"), ("gru", "window"), ("mlp", "window")):
        drawn = network(family, mode)
        predict(drawn, np.asarray(motion(drawn, 64)))


if __name__ == "__main__":
    {"gearbox": gearbox, "actuator": actuator}[sys.argv[1]]()
