"""``cqdd-design torque train``."""

from __future__ import annotations

import shlex
import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, cast

import typer

from cqdd_design.cli import completion
from cqdd_design.cli.options import (
    Force,
    NamedMotor,
    OwnMotor,
    count_option,
    option,
    parse_positive,
)
from cqdd_design.cli.session import Output, read_design
from cqdd_design.cli.tables import number, table
from cqdd_design.cli.torque_actuator import data_actuator, refuse_without_design
from cqdd_design.environment import output_folder
from cqdd_design.errors import UsageError

if TYPE_CHECKING:
    from cqdd_design.torque.networks.artefact import Artefact, Mode
    from cqdd_design.torque.networks.modules import Model
    from cqdd_design.torque.training.recipe import Choice, Recipe
    from cqdd_design.torque.training.schedule import Reading


def train(
    out: Output,
    folder: Annotated[Path, option("DIR", "Data set of `torque generate`.", "--data")],
    model: Annotated[
        str,
        option(
            "NAME",
            "pva-gru, pv-gru, mlp, mlp-baseline, mlp-acceleration, physics-gru, phase-gru or "
            "physics-phase-gru.",
            autocompletion=completion.networks,
        ),
    ] = "pva-gru",
    seed: Annotated[int, count_option("Of weights and order.", 0)] = 0,
    target: Annotated[
        Path | None, option("FILE", "Default exports/MODEL-seed-N.npz.", "--out")
    ] = None,
    epochs: Annotated[int, count_option("At most.")] = 20,
    protocol: Annotated[
        str,
        option(
            "NAME",
            "What is held out: trajectory, mass, wall or gearbox.",
            "--split",
            autocompletion=completion.held_out,
        ),
    ] = "trajectory",
    split_seed: Annotated[int, count_option("Of the split.", 0)] = 0,
    mode: Annotated[
        str, option("window|streaming", "How it is trained and will be run.")
    ] = "window",
    device: Annotated[str, option("auto|cpu|cuda", "Where it is trained.")] = "auto",
    resume: Annotated[
        bool, typer.Option("--resume", help="Go on from the checkpoint beside --out.")
    ] = False,
    reading: Annotated[
        str,
        option(
            "max|initial|ours",
            "Of the paper's 1e-4: the cycle's peak, or its start, a 25th of it; or our own.",
            "--learning-rate-reading",
        ),
    ] = "initial",
    batch: Annotated[int, count_option("Windows in a step.")] = 64,
    stride: Annotated[int, count_option("Every how many-th window an epoch trains on.")] = 2,
    patience: Annotated[
        int, count_option("Epochs without a better validation after which it stops; 0: never.", 0)
    ] = 8,
    threads: Annotated[
        int, count_option("Of the CPU; one is the fastest for networks this small.")
    ] = 1,
    orders: Annotated[int, count_option("Of the gearbox, for phase-gru.")] = 4,
    sample_time: Annotated[
        str | None, option("Q", 'That the data must have, as "5 ms"; default theirs.')
    ] = None,
    design: Annotated[
        Path | None,
        option(
            "FILE",
            "Whose parameters physics-gru, physics-phase-gru and phase-gru use; stored in the "
            "network.",
        ),
    ] = None,
    gearbox: Annotated[
        int | None,
        count_option("Seed of the gearbox drawn for --design; default that of the data.", 0),
    ] = None,
    calibration: Annotated[
        Path | None, option("FILE", "Factors that `calibrate` wrote; default those in the data.")
    ] = None,
    motor: NamedMotor = None,
    motor_file: OwnMotor = None,
    like: Annotated[
        Path | None,
        option(
            "FILE",
            "Network whose searched hyperparameters are taken instead of a new search.",
            "--hyperparameters-of",
        ),
    ] = None,
    leaked: Annotated[
        bool,
        typer.Option(
            "--leaked",
            help="Train a second time on random windows, as should not be done, and store how much "
            "that flatters.",
        ),
    ] = False,
    force: Force = False,
) -> None:
    """Train a torque network, with a checkpoint after every epoch."""
    from cqdd_design.files import kind_by_ending, refuse_overwrite
    from cqdd_design.torque.data.episodes import read_data
    from cqdd_design.torque.data.splits import audit, split
    from cqdd_design.torque.networks.artefact import read_artefact, write_artefact
    from cqdd_design.torque.networks.modules import find_model, require_torch
    from cqdd_design.torque.training.recipe import Choice, Order, Recipe
    from cqdd_design.torque.training.train import leaked_rmse
    from cqdd_design.torque.training.train import train as trained
    from cqdd_design.units import TIME

    chosen = find_model(model)
    recipe = Recipe(
        epochs=epochs,
        batch=batch,
        stride=stride,
        mode=cast("Mode", mode),
        reading=cast("Reading", reading),
        patience=patience,
        orders=orders,
        threads=threads,
    )
    own = {"--motor": motor, "--motor-file": motor_file}
    refuse_without_design(design, {"--gearbox": gearbox, "--calibration": calibration, **own})
    _refuse_unread(chosen, design, recipe)
    dt = parse_positive("--sample-time", sample_time, TIME)
    require_torch()
    place = target or output_folder("exports") / f"{chosen.name}-seed-{seed}.npz"
    kept = place.with_suffix(".checkpoint.npz")
    if target is not None:
        kind_by_ending(target, ("npz",), chosen.name)
        refuse_overwrite(place, force=force)
    if kept.exists() and not (resume or force):
        raise UsageError(
            f"{kept} is the checkpoint of an interrupted training; add --resume to go on with it, "
            "or --force to begin anew."
        )
    choice: Choice | None = None
    if like is not None:
        found = read_artefact(like).facts.get("choice")
        if not isinstance(found, dict):
            raise UsageError(f"{like} does not say what it was trained with; leave it out.")
        choice = Choice(**found)
    data = read_data(folder)
    parts = split(data, protocol, split_seed)
    audit(data, parts, chosen.history)
    actuator = None
    if design is not None:
        loaded = read_design(out, design, motor, motor_file)
        actuator = data_actuator(out, data, loaded, gearbox, calibration)
    if chosen.searched and choice is None and not resume:
        out.note("searching activation, learning rate and weight decay on validation episodes")
    order = Order(chosen.name, seed, recipe, actuator, choice, device)
    tell = out.stages(epochs)
    try:
        artefact = trained(
            data,
            parts,
            order,
            dt=dt,
            checkpoint=kept,
            resume=resume,
            command=shlex.join(["cqdd-design", *sys.argv[1:]]),
            progress=lambda result: tell(result.line, result.left),
        )
    except KeyboardInterrupt:
        if kept.exists():
            out.note(f"what was trained by now is in {kept}; add --resume to go on")
        raise
    if leaked:
        out.note("training on random windows, for the inflated score beside the honest one")
        again = replace(order, choice=Choice(**artefact.facts["choice"]))
        flattered = leaked_rmse(data, again)
        artefact = replace(artefact, facts={**artefact.facts, "leaked_rmse_Nm": flattered})
    file = write_artefact(artefact, place)
    kept.unlink(missing_ok=True)
    out.say(*_lines(artefact))
    out.wrote([file])
    out.document(_results(artefact), files=[file])


def _refuse_unread(model: Model, design: Path | None, recipe: Recipe) -> None:
    """Refuse what says something of an actuator to a network that knows none."""
    from cqdd_design.torque.networks.modules import MODELS

    knowing = [one.name for one in MODELS.values() if one.needs_actuator]
    phased = [one.name for one in MODELS.values() if one.phase]
    for name, given, takers in (
        ("--design", design is not None, knowing),
        ("--orders", recipe.orders != type(recipe).orders, phased),
    ):
        if given and model.name not in takers:
            raise UsageError(
                f"{name} does not belong to --model {model.name}; leave it out, or train "
                f"{' or '.join(takers)}."
            )


def _results(artefact: Artefact) -> dict[str, Any]:
    facts = artefact.facts
    names = ("seed", "epochs", "best_epoch", "validation_rmse_Nm", "training_rmse_Nm")
    more = (
        "seconds",
        "data_sha256",
        "choice",
        "recipe",
        "device",
        "log",
        "search",
        "leaked_rmse_Nm",
        "differentiator",
    )
    return {
        "model": artefact.name,
        "parameters": artefact.parameters,
        "inputs": list(artefact.inputs),
        "mode": artefact.mode,
        "history": artefact.history,
        **{name: facts[name] for name in (*names, *more) if name in facts},
    }


def _lines(artefact: Artefact) -> list[str]:
    facts = artefact.facts
    rows = [
        ["trained numbers", f"{artefact.parameters:,}", ""],
        ["RMSE, validation", number(float(facts["validation_rmse_Nm"])), "N*m"],
        ["RMSE, training", number(float(facts["training_rmse_Nm"])), "N*m"],
        ["epochs", f"{facts['epochs']}", f"best {facts['best_epoch']}"],
        ["time", number(float(facts["seconds"])), "s"],
    ]
    if "leaked_rmse_Nm" in facts:
        flattered = number(float(facts["leaked_rmse_Nm"]))
        rows.append(["RMSE, random windows", flattered, "N*m, inflated: do not quote"])
    told = facts.get("differentiator")
    if isinstance(told, dict):
        title = f"delay of the acceleration at {told['frequency']:g} Hz"
        rows.append([title, number(1e3 * told["delay"]), "ms"])
    return [
        f"{artefact.name}, {artefact.mode}, of {', '.join(artefact.inputs)}",
        "",
        table(rows, right=(1,)),
        "",
    ]
