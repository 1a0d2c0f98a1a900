"""Films of three designs beside those of cycloidgen 8.0.0, under the same forces and speeds.

    python benchmarks/films.py --cycloidgen PYTHON [--write]

`--cycloidgen` names the Python of an environment in which cycloidgen is installed; `--write` puts
the table into docs/benchmarks.md. Forces and sliding speeds are the means of our equilibrium at the
continuous torque and input speed, so that what differs is the film. Its roughness is set to what
gives ours of ring and disc, 0.5 µm each.
"""

from __future__ import annotations

import argparse
import json
import subprocess
from pathlib import Path

import numpy as np
from contact_solves import peer_design
from processes import write_section

from cqdd_design.design import Design, load_design
from cqdd_design.gearbox.contact.films import hole_film, ring_film, travel
from cqdd_design.gearbox.contact.rubbing import ContactFriction, slip
from cqdd_design.gearbox.contact.states import nominal_states
from cqdd_design.gearbox.contact.sweep import contact_sweep, perfect_angles
from cqdd_design.gearbox.losses.sliding import pin_sliding
from cqdd_design.machine import resolve

REPOSITORY = Path(__file__).resolve().parents[1]
PEER = Path(__file__).resolve().parent / "cycloidgen_films.py"
HEADING = "## Films beside cycloidgen 8.0.0"
BY_FILM = {"reducer.friction.tooth": "film", "reducer.friction.pin": "film"}
_UNTOLD = 0.2
"""Differences beyond this are explained."""


def designs() -> list[Design]:
    """The three designs, their friction by films."""
    files = (load_design(REPOSITORY / "designs" / f"{n}.toml") for n in ("reference-s", "cqdd-10"))
    named = [*files, peer_design().replacing({"name": "R 40, r 3, e 1.5"})]
    return [design.replacing(BY_FILM) for design in named]


def mean(values: np.ndarray, force: np.ndarray) -> float:
    """Of what is loaded, by its force."""
    return float(np.average(values[force > 0.0], weights=force[force > 0.0]))


def ours(design: Design) -> tuple[dict[str, float], list[dict[str, float]], list[float]]:
    """The case, the films at ring and pins, and what the ring's film owes to its kinematics."""
    machine = resolve(design)
    model, asked = machine.contact, machine.design.requirements
    states = nominal_states(model, perfect_angles(model, 120))
    friction = ContactFriction.of(model, "drive")
    sweep = contact_sweep(model, asked.continuous_torque, states=states, friction=friction)
    speed, moved = asked.input_speed, slip(model, states)
    ring = ring_film(model, states, moved, sweep.ring_force, speed)
    pins = hole_film(model, sweep.pin_force, speed)
    assert ring is not None
    assert pins is not None
    sliding = np.abs(moved[:, :, : model.tooth_count]) * speed
    entrained = 0.5 * np.abs(np.sum(travel(model, states, moved), axis=0)) * speed
    path = float(pin_sliding(model.lobe_count, model.eccentricity)) * speed
    reducer = machine.design.reducer
    case = {
        "R": 1e3 * model.ring_pitch_radius,
        "r": 1e3 * model.tooth_radius,
        "e": 1e3 * model.eccentricity,
        "n": model.lobe_count,
        "b": 1e3 * model.contact_length,
        "pins": model.pin_count,
        "pin_diameter": 2e3 * model.pin_contact_radius,
        "pin_circle": 1e3 * model.pin_circle_radius,
        "hole_clearance": 1e3 * reducer.output_pins.hole_clearance,
        "roughness": 0.5,
        "ring_force": mean(sweep.ring_force, sweep.ring_force),
        "pin_force": mean(sweep.pin_force, sweep.pin_force),
        "ring_sliding": mean(sliding, sweep.ring_force),
        "pin_sliding": path,
        "temperature": 40.0,
    }
    films = [
        {
            "film": 1e6 * mean(film.thickness, force),
            "lambda": mean(film.ratio, force),
            "friction": mean(film.friction, force),
        }
        for film, force in ((ring, sweep.ring_force), (pins, sweep.pin_force))
    ]
    radius = mean(states.ring.equivalent_radius, sweep.ring_force)
    turn = speed * (1.0 + 1.0 / model.lobe_count)
    at_pins = 0.5 * (model.pin_contact_radius + model.hole_radius) * turn
    gap = model.hole_radius - model.pin_contact_radius
    their_pins = model.pin_contact_radius * model.hole_radius / gap
    owed = [
        (0.5 * case["ring_sliding"] / mean(entrained, sweep.ring_force)) ** 0.7
        * (model.tooth_radius / radius) ** 0.43,
        (0.5 * path / at_pins) ** 0.7 * (their_pins / model.pin_equivalent_radius) ** 0.43,
    ]
    return case, films, owed


def table(python: str) -> list[str]:
    """Lines of the section."""
    found = [(design.name, *ours(design)) for design in designs()]
    done = subprocess.run(
        [python, str(PEER)],
        input=json.dumps([case for _, case, _, _ in found]),
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    lines = [
        "| design, contact | film, µm | theirs | ratio | of which entrainment and radius | λ "
        "| theirs | friction | theirs |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    for (name, _, films, owed), theirs in zip(found, json.loads(done.stdout), strict=True):
        for place, us, them, part in zip(("ring", "pins"), films, theirs, owed, strict=True):
            ratio = them["film"] / us["film"]
            told = f"{part:.2f}" if abs(ratio - 1.0) > _UNTOLD else ""
            lines.append(
                f"| {name}, {place} | {us['film']:.4f} | {them['film']:.4f} | {ratio:.2f} | {told} "
                f"| {us['lambda']:.3f} | {them['lambda']:.3f} | {us['friction']:.4f} "
                f"| {them['friction']:.4f} |"
            )
    return lines


WORDS = """\
Under the same mean forces, sliding speeds, grease (110 and 11 mm²/s, 22 1/GPa) and 40 °C. Both
use 2.65 G^0.54 U^0.7/W^0.13; what differs is what goes in. cycloidgen takes half of the sliding
speed as the entrainment at a fixed tooth or pin: that is right only where the contact stands
still on it. Here the contact travels: along the tooth against the sliding where teeth are loaded,
which leaves less entrainment and a thinner film, and around the pin and its hole with the crank,
(r_pin + r_hole)/2 where sliding alone gives (r_hole - r_pin)/2, which leaves more. It also takes
the tooth's own radius for that of tooth and flank. The column says what these two alone make of
the film (speed^0.7 radius^0.43), where the ratio is off 1 by more than a fifth. Its λ at the
pins is for discs and pins as smooth as each other; ours has the shoulder screw's 1.0 µm. Its
friction stays that of the boundary (0.11 for this grease) up to a λ of 0.5; ours falls by
1/(1 + λ)² from 0.10 (Olver and Spikes 1998).
"""


def main() -> None:
    """Print or write the section."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cycloidgen", required=True)
    parser.add_argument("--write", action="store_true")
    given = parser.parse_args()
    text = "\n".join([*WORDS.splitlines(), "", *table(given.cycloidgen)])
    if given.write:
        write_section("films", "films.py", HEADING, text + "\n")
    else:
        print(text)


if __name__ == "__main__":
    main()
