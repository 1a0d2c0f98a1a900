"""``cqdd-design torque evaluate``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cqdd_design.cli import completion
from cqdd_design.cli.options import Calibrated, Force, NamedMotor, OwnMotor, option, parse_names
from cqdd_design.cli.session import Output, read_design
from cqdd_design.cli.tables import number, table
from cqdd_design.cli.torque_actuator import data_actuator, refuse_without_design

if TYPE_CHECKING:
    from cqdd_design.torque.evaluation.bootstrap import Interval
    from cqdd_design.torque.evaluation.evaluate import EvaluationResult
    from cqdd_design.torque.evaluation.scoring import SetResult


def evaluate(
    out: Output,
    data: Annotated[Path, option("DIR", "As `torque generate` or import wrote.")],
    model: Annotated[list[Path] | None, option("FILE", "A network (.npz); once for each.")] = None,
    sets: Annotated[
        str | None,
        option(
            "NAMES",
            "Test sets: trajectory,mass,wall,gearbox; default that of the first network.",
            "--set",
            autocompletion=completion.test_sets,
        ),
    ] = None,
    design: Annotated[
        Path | None,
        option(
            "DESIGN",
            "Of the actuator, for the estimates by physics and from the current; default "
            "what the networks' files say.",
        ),
    ] = None,
    calibration: Calibrated = None,
    motor: NamedMotor = None,
    motor_file: OwnMotor = None,
    split_seed: Annotated[
        int | None, option("N", "Of the split; default that of the networks.", min=0)
    ] = None,
    draws: Annotated[int, option("N", "Resamples of the bootstrap.", min=100, max=100_000)] = 2000,
    seed: Annotated[int, option("N", "Of the bootstrap.", min=0)] = 0,
    rollouts: Annotated[int, option("N", "Episodes that each model drives; 0: none.", min=0)] = 6,
    report: Annotated[Path | None, option("FILE", "One self-contained HTML page.")] = None,
    markdown: Annotated[Path | None, option("FILE", "The tables as Markdown.")] = None,
    force: Force = False,
) -> None:
    """Score networks and baselines on held-out episodes, with intervals, beside the paper."""
    from cqdd_design.files import kind_by_ending, refuse_overwrite, write_atomically
    from cqdd_design.torque.data.episodes import read_data
    from cqdd_design.torque.evaluation.behaviour import Effort
    from cqdd_design.torque.evaluation.carried import DesignVersion
    from cqdd_design.torque.evaluation.documents import result_dict
    from cqdd_design.torque.evaluation.evaluate import evaluate as measure
    from cqdd_design.torque.evaluation.lineup import line_up, read_networks

    for target, kind in ((report, "html"), (markdown, "md")):
        if target is not None:
            kind_by_ending(target, (kind,), "evaluation")
            refuse_overwrite(target, force=force)
    refuse_without_design(
        design, {"--calibration": calibration, "--motor": motor, "--motor-file": motor_file}
    )
    known = read_data(data)
    networks = read_networks(model or [], known)
    actuator = version = None
    if design is not None:
        loaded = read_design(out, design, motor, motor_file)
        version = DesignVersion(loaded.name, loaded.sha256)
        actuator = data_actuator(out, known, loaded, None, calibration)
    names = parse_names(sets)
    lineup = line_up(
        known, networks, names, split_seed=split_seed, actuator=actuator, design=version
    )
    out.warn(*lineup.warnings)
    work = len(lineup.estimators) * (len(lineup.sets) + 1)
    result = measure(
        known,
        lineup.sets,
        lineup.estimators,
        seen=lineup.seen,
        effort=Effort(draws=draws, seed=seed, rollouts=rollouts),
        progress=out.stages(work),
    )
    files = []
    if report is not None:
        from cqdd_design.report.torque.page import torque_page
        from cqdd_design.roads.telling import provenance

        date = provenance(None).time.partition("T")[0]
        files.append(write_atomically(report, torque_page(result, date=date), "report"))
    if markdown is not None:
        from cqdd_design.torque.evaluation.markdown import markdown as tables

        files.append(write_atomically(markdown, tables(result), "markdown"))
    for one in result.sets:
        out.say(*_lines(result, one))
    out.say(*_paper(), "", f"in {number(result.seconds)} s")
    out.wrote(files)
    out.warn(*result.warnings)
    of_models = {name: str(path) for name, path in zip(networks, model or [], strict=True)}
    out.document(result_dict(result) | {"files_of_models": of_models}, files=files)


def _lines(result: EvaluationResult, found: SetResult) -> list[str]:
    rows = []
    for score in sorted(found.models, key=lambda one: one.overall.rmse.value):
        own = result.behaviour(score.name)
        band, whole, times = score.ripple, score.overall, own.latency
        rows.append(
            [
                score.name,
                number(whole.rmse.value, 3),
                _ends(whole.rmse),
                number(whole.bias.value, 2),
                number(whole.variance.value, 3),
                "" if band is None or band.share is None else f"{100.0 * band.share.value:.2g}",
                "" if band is None else number(band.amplitude_error.value, 2),
                "" if band is None or band.frequency is None else f"{band.frequency.value:.1f}",
                "" if band is None or band.phase is None else f"{band.phase.value:.0f}",
                "" if band is None else number(band.error_rms.value, 3),
                str(own.parameters),
                ""
                if times is None or times.streaming_p50 is None
                else number(times.streaming_p50, 2),
                "" if times is None else number(times.throughput_per_sample, 2),
            ]
        )
    head = [
        "model", "RMSE N*m", "95 %", "bias", "variance", "ripple %", "off", "Hz", "deg", "in band",
        "parameters", "step us", "batch us",
    ]  # fmt: skip
    lines = [
        f"set {found.name}: {len(found.episodes)} held-out episodes, {found.samples} samples",
        "",
        table(rows, head=head, right=(1, *range(3, 13))),
        "",
    ]
    band = next((score.ripple for score in found.models if score.ripple is not None), None)
    if band is not None:
        lines += [
            f"ripple, 10 to 25 Hz in free swing: the label has {number(band.amplitude_label, 3)} "
            f"N*m about {band.frequency_label:.1f} Hz; the band's share of the error's variance in "
            "%, amplitude (N*m) and phase of an estimate against the label, and the error within "
            "the band, N*m r.m.s.",
            "",
        ]
    return lines


def _ends(value: Interval) -> str:
    if value.low is None or value.high is None:
        return ""
    return f"{number(value.low, 3)} to {number(value.high, 3)}"


def _paper() -> list[str]:
    from cqdd_design.catalog import paper

    rows = [row.cells("") for row in paper.NETWORKS]
    head = ["paper (hardware)", "RMSE N*m", "size of bias", "variance N^2*m^2", "cycle us"]
    return [table(rows, head=head, right=(1, 2, 3, 4)), "not to be read against ours"]
