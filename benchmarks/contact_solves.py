"""Time the contact engine: solves a second, gearboxes a second, memory; beside scipy and a peer.

    python benchmarks/contact_solves.py [--cycloidgen PYTHON] [--write]

Everything is measured in one run, after compilation (warm). A solve is one coupled equilibrium:
for two discs, 10 lobes and 5 pins 7 unknowns and 34 contacts, converged to 1e-9 of the load.
`--cycloidgen` names the Python of an environment in which cycloidgen is installed; `--write` puts
the result into docs/benchmarks.md. Run it by hand on a machine that does nothing else.
"""

from __future__ import annotations

import argparse
import dataclasses
import json
import os
import resource
import subprocess
import sys
import time
from collections.abc import Callable
from importlib import metadata
from pathlib import Path

import numpy as np
from processes import CONTACT_HEADING, machine, write_section

from cqdd_design.design import Design, load_design
from cqdd_design.gearbox.contact import laws
from cqdd_design.gearbox.contact.compliant import model_compliance, new_result
from cqdd_design.gearbox.contact.compliant_sweep_kernel import yield_sweep
from cqdd_design.gearbox.contact.friction_sweep_kernel import rub_sweep
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.problem import sweep_problem
from cqdd_design.gearbox.contact.rubbing import ContactFriction, rubbing
from cqdd_design.gearbox.contact.states import error_states, nominal_states
from cqdd_design.gearbox.contact.sweep import contact_sweep
from cqdd_design.gearbox.contact.sweep_kernel import solve_sweep
from cqdd_design.gearbox.tolerance.draws import draw_errors
from cqdd_design.gearbox.tolerance.ensemble import make_ensemble
from cqdd_design.gearbox.tolerance.evaluate import ensemble_tables, evaluate_gearboxes
from cqdd_design.gearbox.tolerance.run import run_ensemble
from cqdd_design.machine import resolve

REPOSITORY = Path(__file__).resolve().parents[1]
DESIGN = REPOSITORY / "designs" / "cqdd-10.toml"
PEER = REPOSITORY / "benchmarks" / "cycloidgen_contact.py"


def peer_design() -> Design:
    """R 40, r 3, e 1.5, n 10, two discs, 6 pins of 8 mm on R 23, at 60 N m."""
    reducer = {
        "ratio": 10,
        "ring_pitch_radius": "40 mm",
        "eccentricity": "1.5 mm",
        "ring_pin_diameter": "6 mm",
        "output_pins": {
            "count": 6,
            "diameter": "8 mm",
            "circle_radius": "23 mm",
            "hole_clocking": "0 deg",
        },
        "cam_bearing": {"designation": "6904"},
    }
    return Design.from_mapping({"reducer": reducer})


def kernel_rate(model: ContactModel, torque: float, angle: np.ndarray) -> tuple[float, float]:
    """Solves a second of one thread (best of seven), and mean Newton steps."""
    states = nominal_states(model, angle)
    perfect = error_states(model, states, None)
    problem = sweep_problem(model, torque, states, perfect)
    best = np.inf
    for _ in range(7):
        began = time.perf_counter()
        failed = solve_sweep(*problem)
        best = min(best, time.perf_counter() - began)
        assert failed < 0
    return len(angle) / best, float(problem[-1].steps.mean())


def friction_rate(model: ContactModel, torque: float, angle: np.ndarray) -> tuple[float, float]:
    """The same with friction, the motor driving; states without it, which it may need, apart."""
    states = nominal_states(model, angle)
    perfect = error_states(model, states, None)
    smooth = sweep_problem(model, torque, states, perfect)
    solve_sweep(*smooth)
    contacts, springs, load, turns, result = sweep_problem(model, torque, states, perfect)
    friction = ContactFriction.of(model, "drive")
    assert friction is not None
    rubs = rubbing(model, states, friction, torque)
    best = np.inf
    for _ in range(7):
        began = time.perf_counter()
        failed = rub_sweep(contacts, springs, load, rubs, turns, smooth[-1], result)
        best = min(best, time.perf_counter() - began)
        assert failed < 0
    return len(angle) / best, float(result.steps.mean())


def compliant_rate(
    model: ContactModel, torque: float, angle: np.ndarray, friction: float
) -> tuple[float, float]:
    """The same with the cap on its pins and the elastic discs and ring of the design."""
    states = nominal_states(model, angle)
    perfect = error_states(model, states, None)
    contacts, springs, load, turns, smooth = sweep_problem(model, torque, states, perfect)
    assert solve_sweep(contacts, springs, load, turns, smooth) < 0
    rubs = rubbing(model, states, ContactFriction("drive", friction, friction), torque)
    assert model.bodies is not None
    share = rubs.share if friction else None
    compliance = model_compliance(model, model.bodies.compliance(model, states, torque, share))
    result = new_result(len(angle), *states.gaps.shape[1:])
    best = np.inf
    for _ in range(7):
        began = time.perf_counter()
        failed = yield_sweep(
            contacts, springs, load, rubs, compliance, turns, smooth.states, result
        )
        best = min(best, time.perf_counter() - began)
        assert failed < 0
    return len(angle) / best, float(result.steps.mean())


def sweep_rate(model: ContactModel, torque: float, angle: np.ndarray) -> float:
    """Solves a second of a whole sweep as `analyse` asks for it, all tables included."""
    states = nominal_states(model, angle)
    friction = ContactFriction.of(model, "drive")
    best = np.inf
    for _ in range(3):
        began = time.perf_counter()
        contact_sweep(model, torque, states=states, friction=friction)
        best = min(best, time.perf_counter() - began)
    return len(angle) / best


def worst_imbalance(model: ContactModel, torque: float, angle: np.ndarray) -> float:
    """Greatest force left over on a disc, as a share of the greatest force."""
    sweep = contact_sweep(model, torque, angle)
    ring = (sweep.ring_force[..., None] * sweep.ring_normal).sum(axis=2)
    pins = (sweep.pin_force[..., None] * sweep.pin_normal).sum(axis=2)
    return float(np.abs(ring + pins + sweep.cam_force).max() / sweep.ring_force.max())


def scipy_equations(
    model: ContactModel, torque: float, angle: float
) -> tuple[Callable, Callable, Callable]:
    """Energy, gradient and Hessian of the same state, from the same contacts, in plain numpy."""
    sys.path.insert(0, str(REPOSITORY / "tests" / "oracles"))
    from contact_plain import law_force

    states = nominal_states(model, np.array([angle]))
    perfect = error_states(model, states, None)
    rows, gaps, coefficient = states.rows[0], states.gaps[0], states.coefficient[0]
    discs, contacts = gaps.shape
    teeth, size = model.tooth_count, 1 + 3 * discs
    # Unknowns in micrometres, so that scipy's own scaling fits.
    unit = 1e-6
    closing = np.zeros((discs, contacts, size))
    for d in range(discs):
        closing[d, :, 1 + 3 * d : 4 + 3 * d] = -rows[d]
        closing[d, teeth:, 0] = rows[d, teeth:, 2]
    parts = (
        (model.ring_law, slice(None, teeth), np.zeros((discs, 1))),
        (model.pin_law, slice(teeth, None), model.pin_series[:, None]),
    )
    pull = torque / states.length

    def evaluate(x: np.ndarray) -> tuple[float, np.ndarray, np.ndarray]:
        q = unit * x
        delta = closing @ q - gaps
        force, stiff = np.zeros_like(delta), np.zeros_like(delta)
        energy = -pull * q[0]
        for law, part, series in parts:
            c = coefficient[:, part]
            force[:, part], stiff[:, part] = law_force(law, c, series, delta[:, part])
            energy += laws.stored_energy(law, c, series, force[:, part]).sum()
        gradient = np.einsum("dk,dks->s", force, closing)
        gradient[0] -= pull
        hessian = np.einsum("dks,dk,dkr->sr", closing, stiff, closing)
        for d in range(discs):
            away = q[1 + 3 * d : 3 + 3 * d]
            rho = float(np.hypot(*away))
            over = rho - perfect.half_play[d]
            if over > 0.0:
                k, p = model.cam.stiffness, model.cam.exponent
                load, slope = k * over**p, p * k * over ** (p - 1.0)
                direction = away / rho
                along = np.outer(direction, direction)
                at = slice(1 + 3 * d, 3 + 3 * d)
                energy += load * over / (p + 1.0)
                gradient[at] += load * direction
                hessian[at, at] += slope * along + load / rho * (np.eye(2) - along)
        return energy / unit, gradient, hessian * unit

    return (
        lambda x: evaluate(x)[0],
        lambda x: evaluate(x)[1],
        lambda x: evaluate(x)[2] + 1e-9 * np.eye(size),
    )


def scipy_rates(model: ContactModel, torque: float, count: int = 60) -> dict[str, float]:
    """Solves a second by scipy, each state from the one before; agreement is asserted."""
    from scipy.optimize import minimize, root

    angle = np.radians(np.arange(count, dtype=float))
    ours = contact_sweep(model, torque, angle)
    start = 1e6 * np.delete(ours.state_vectors[0], (0, 1))
    equations = [scipy_equations(model, torque, float(a)) for a in angle]
    rates = {}
    for name in ("root", "minimize"):
        x = start.copy()
        began = time.perf_counter()
        found = []
        for energy, gradient, hessian in equations:
            if name == "root":
                x = root(gradient, x, jac=hessian, method="hybr", tol=1e-12).x
            else:
                x = minimize(
                    energy, x, jac=gradient, hess=hessian, method="trust-exact",
                    options={"gtol": 1e-9 * abs(torque) / model.pin_circle_radius},
                ).x  # fmt: skip
            found.append(x[0])
        rates[name] = count / (time.perf_counter() - began)
        error = np.abs(1e-6 * np.array(found) / model.pin_circle_radius - ours.carrier_angle_error)
        assert error.max() < 1e-6 * np.abs(ours.carrier_angle_error).max(), (name, error.max())
    return rates


def peak_memory(samples: int) -> float:
    """Peak memory in MB of a process that solves an ensemble over 36 angles."""
    code = (
        "import resource, sys; from pathlib import Path;"
        "from cqdd_design.design import load_design;"
        "from cqdd_design.gearbox.tolerance.ensemble import make_ensemble;"
        "from cqdd_design.gearbox.tolerance.run import run_ensemble;"
        "e = make_ensemble(load_design(Path(sys.argv[1])), angles=36);"
        "run_ensemble(e, int(sys.argv[2]), sensitivity=False);"
        "print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, str(DESIGN), str(samples)],
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    return float(done.stdout)


def processes_time(arguments: list[str], runs: int = 5) -> float:
    """Median seconds of a whole process, after one that is not measured."""
    taken = []
    for _ in range(runs + 1):
        began = time.perf_counter()
        subprocess.run(
            [sys.executable, "-m", "cqdd_design", *arguments], capture_output=True, check=True
        )
        taken.append(time.perf_counter() - began)
    return float(np.median(taken[1:]))


def measure(cycloidgen: str | None) -> list[tuple[str, str, str]]:
    """Rows of (what, measured, goal)."""
    design = load_design(DESIGN)
    model = ContactModel.from_design(design)
    built, held = resolve(design).contact, dataclasses.replace(model, pin=None)
    degree = np.radians(np.arange(0.0, 3600.0, 1.0))
    kernel_rate(model, 40.0, degree[:10])
    rate, steps = kernel_rate(model, 40.0, degree)
    rows = [
        (
            "coupled solves a second, one thread, two discs, 10 lobes, 5 pins, 1\u00b0 of crank",
            f"{rate:,.0f} ({steps:.2f} Newton steps each)",
            "no slower than 212,000 to 340,000 of before",
        )
    ]
    fine, _ = kernel_rate(model, 40.0, np.radians(np.arange(0.0, 3600.0, 0.25)))
    rows.append(("the same at 0.25\u00b0", f"{fine:,.0f}", ""))
    johnson, _ = kernel_rate(ContactModel.from_design(design, "johnson"), 40.0, degree)
    rows.append(("the same at 1\u00b0, Johnson's law", f"{johnson:,.0f}", ""))
    for friction, words, goal in (
        (0.0, "the cap on its pins, elastic discs and ring", "at least 80,000"),
        (0.08, "that, with friction of 0.08", "at least 50,000"),
    ):
        rate_there, steps = compliant_rate(built, 40.0, degree, friction)
        told = f"{rate_there:,.0f} ({steps:.2f} Newton steps each)"
        rows.append((f"the same at 1\u00b0, {words}", told, goal))
    whole = sweep_rate(built, 40.0, degree[:360])
    rows.append(("that, over 360 angles with all that `contact_sweep` does", f"{whole:,.0f}", ""))
    worst = worst_imbalance(held, 40.0, degree)
    rows.append(("greatest imbalance of those states, share of the load", f"{worst:.1g}", "1e-9"))
    friction_rate(model, 40.0, degree[:10])
    rubbed, steps = friction_rate(model, 40.0, degree)
    rows.append(
        (
            "the same at 1\u00b0 with friction, the motor driving, beside those without",
            f"{rubbed:,.0f} ({steps:.2f} Newton steps each)",
            "at least 50,000",
        )
    )
    for name, found in scipy_rates(held, 40.0).items():
        words = "root, analytic Jacobian" if name == "root" else "minimize, trust-exact"
        rows.append(
            (
                f"scipy.optimize.{words}, the same equations",
                f"{found:,.0f} a second: {rate / found:,.0f} times slower",
                "",
            )
        )
    if cycloidgen is not None:
        done = subprocess.run(
            [cycloidgen, str(PEER)], capture_output=True, text=True, check=True
        ).stdout
        other, _ = kernel_rate(ContactModel.from_design(peer_design()), 60.0, degree)
        rows.append(
            (
                "coupled solves a second on R 40, r 3, e 1.5, n 10, 6 pins, 60 N\u00b7m",
                f"{other:,.0f}",
                "",
            )
        )
        for name, told in json.loads(done).items():
            theirs = told["solves"] / told["seconds"]
            rows.append(
                (
                    f"cycloidgen 8.0.0 `{name}`, its solves of one unknown",
                    f"{theirs:,.0f} a second ({told['solves']:.0f} in {told['seconds']:.2f} s): "
                    f"{other / theirs:,.0f} times slower",
                    "at least 100",
                )
            )
    rows += _ensembles(design, model)
    analyse = processes_time(["analyse", str(DESIGN), "--json"])
    rows.append(("`analyse designs/cqdd-10.toml`, whole process", f"{analyse:.2f} s", "under 4 s"))
    return rows


def _ensembles(design: Design, model: ContactModel) -> list[tuple[str, str, str]]:
    tables = ensemble_tables(model, 40.0, 36)
    evaluate_gearboxes(tables, draw_errors(model, design.tolerances, 1, 0, 100))
    began = time.perf_counter()
    for first in range(0, 10_000, 500):
        evaluate_gearboxes(tables, draw_errors(model, design.tolerances, 0, first, 500))
    small = time.perf_counter() - began
    ensemble = make_ensemble(design)
    alone = run_ensemble(ensemble, 1000, sensitivity=False)
    whole = run_ensemble(ensemble, 1000)
    memory = {samples: peak_memory(samples) for samples in (1_000, 4_000, 16_000)}
    cores = os.cpu_count()
    return [
        (
            f"10,000 gearboxes over 36 angles, rigid discs, draws and all outputs, {cores} cores",
            f"{small:.1f} s",
            "",
        ),
        (
            f"1,000 gearboxes over a whole output turn, everything on, {cores} cores",
            f"{alone.seconds:.1f} s ({alone.solves:,} equilibria)",
            "under 30 s",
        ),
        (
            f"`tolerance` of the same, which ranks the tolerances too, {cores} cores",
            f"{whole.seconds:.1f} s ({whole.solves:,} equilibria)",
            "",
        ),
        (
            "peak memory of 1,000, 4,000 and 16,000 gearboxes over 36 angles",
            ", ".join(f"{value:.0f} MB" for value in memory.values()),
            "flat",
        ),
    ]


def main() -> None:
    """Measure and show, or write into the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cycloidgen", metavar="PYTHON")
    parser.add_argument("--write", action="store_true")
    asked = parser.parse_args()
    rows = measure(asked.cycloidgen)
    versions = ", ".join(f"{name} {metadata.version(name)}" for name in ("numpy", "scipy", "numba"))
    lines = [
        "Written by `python benchmarks/contact_solves.py --cycloidgen PYTHON --write`, in one run,",
        "after compilation (warm); the load is 40 N\u00b7m unless it says otherwise.",
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
        write_section("contact", "contact_solves.py", CONTACT_HEADING, text)
    else:
        print(text)
    print(f"peak memory here {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024:.0f} MB")


if __name__ == "__main__":
    main()
