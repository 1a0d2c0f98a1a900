"""JSON forms of an evaluation; keys carry their units, values their 95 % intervals."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

from cqdd_design.catalog import paper
from cqdd_design.torque.evaluation import bootstrap
from cqdd_design.torque.evaluation.behaviour import Behaviour
from cqdd_design.torque.evaluation.bootstrap import Interval
from cqdd_design.torque.evaluation.evaluate import EvaluationResult
from cqdd_design.torque.evaluation.ripple import Ripple
from cqdd_design.torque.evaluation.scoring import SetResult
from cqdd_design.torque.evaluation.seeds import ModelScore, RegimeScores


def result_dict(result: EvaluationResult) -> dict[str, Any]:
    """The whole JSON form."""
    headline, data, effort = result.sets[0], result.data, result.effort
    models = {}
    for own in result.models:
        score = headline.model(own.name)
        told = {} if score is None else score_dict(score)
        models[own.name] = told | behaviour_dict(own)
    return {
        "headline_set": headline.name,
        "models": models,
        "sets": {one.name: set_dict(one) for one in result.sets},
        "paper_hardware": [
            {
                "model": row.model,
                "title": row.title,
                "rmse_Nm": row.rmse,
                "variance_N2m2": row.variance,
                "bias_Nm": row.bias,
                "cycle_time_us": row.cycle_time,
                "source": paper.NETWORKS_SOURCE,
            }
            for row in paper.NETWORKS
        ],
        "data": {
            "sha256": data.sha256,
            "dt_s": data.dt,
            "position_gain_Nm_per_rad": data.position_gain,
            "velocity_gain_Nms_per_rad": data.velocity_gain,
        },
        "bootstrap": {"draws": effort.draws, "seed": effort.seed, "level": bootstrap.LEVEL},
        "seconds": result.seconds,
    }


def _with_ends(told: Mapping[str, Interval | None]) -> dict[str, Any]:
    """Values by key, and the ends of those that have some."""
    ends = {key: one.ends for key, one in told.items() if one is not None and one.ends is not None}
    return {
        **{key: None if one is None else one.value for key, one in told.items()},
        "intervals_95": ends,
    }


def regime_dict(found: RegimeScores) -> dict[str, Any]:
    """JSON form of one regime."""
    told = {
        "rmse_Nm": found.rmse,
        "bias_Nm": found.bias,
        "variance_N2m2": found.variance,
        "r_squared": found.r_squared,
        "p95_Nm": found.p95,
    }
    return {
        **_with_ends(told),
        "max_Nm": found.scores.most,
        "samples": found.scores.samples,
        "episodes": found.episodes,
    }


def ripple_dict(found: Ripple) -> dict[str, Any]:
    """JSON form of the ripple band."""
    told = {
        "ripple_amplitude_Nm": found.amplitude,
        "ripple_amplitude_error_Nm": found.amplitude_error,
        "ripple_frequency_Hz": found.frequency,
        "ripple_frequency_error_Hz": found.frequency_error,
        "ripple_phase_deg": found.phase,
        "ripple_error_rms_Nm": found.error_rms,
        "ripple_share_of_variance": found.share,
    }
    return {
        **_with_ends(told),
        "ripple_label_amplitude_Nm": found.amplitude_label,
        "ripple_label_frequency_Hz": found.frequency_label,
        "ripple_coherence": found.coherence,
        "ripple_segments": found.segments,
    }


_NO_RIPPLE = dict.fromkeys(
    ("ripple_amplitude_error_Nm", "ripple_frequency_Hz", "ripple_phase_deg"), None
)


def score_dict(score: ModelScore) -> dict[str, Any]:
    """JSON form of one model on one set, the interface's keys at its top."""
    overall = regime_dict(score.overall)
    band: dict[str, Any] = dict(_NO_RIPPLE)
    if score.ripple is not None:
        band = ripple_dict(score.ripple)
    ends = overall.pop("intervals_95") | band.pop("intervals_95", {})
    found: dict[str, Any] = overall | band | {"intervals_95": ends}
    found["regimes"] = {
        name: None if one is None else regime_dict(one)
        for name, one in score.regimes.items()
        if name != "all"
    }
    if score.unknown_phase is not None:
        found["unknown_phase"] = regime_dict(score.unknown_phase)
        if score.unknown_phase_ripple is not None:
            lost = ripple_dict(score.unknown_phase_ripple)
            found["unknown_phase"]["intervals_95"] |= lost.pop("intervals_95")
            found["unknown_phase"] |= lost
    if score.flank_ripple is not None:
        found["on_one_flank"] = ripple_dict(score.flank_ripple)
    if score.orders is not None:
        found["orders"] = {
            "order": score.orders.orders.tolist(),
            "label_Nm": score.orders.label.tolist(),
            "estimate_Nm": score.orders.estimate.tolist(),
            "phase_deg": score.orders.phase.tolist(),
            "strokes": score.orders.strokes,
        }
    return found


def set_dict(found: SetResult) -> dict[str, Any]:
    """JSON form of one set."""
    return {
        "episodes": list(found.episodes),
        "samples": found.samples,
        "models": {one.name: score_dict(one) for one in found.models},
        "seeds": [
            {
                "model": one.model,
                "seeds": one.seeds,
                "rmse_std_Nm": one.rmse_std,
                "regimes_rmse_Nm": dict(one.regimes),
                "unknown_phase_rmse_Nm": one.unknown_phase,
                "unknown_phase_ripple_error_rms_Nm": one.unknown_phase_ripple,
            }
            | _with_ends(
                {
                    "rmse_Nm": one.rmse,
                    "variance_N2m2": one.variance,
                    "ripple_error_rms_Nm": one.ripple_error,
                }
            )
            for one in found.seeds
        ],
        "paired": [
            {"model": one.model, "reference": one.reference, "metric": one.metric}
            | _with_ends({"difference": one.difference, "ratio": one.ratio})
            for one in found.paired
        ],
    }


def behaviour_dict(own: Behaviour) -> dict[str, Any]:
    """JSON form of what a model does beyond single errors."""
    return {
        **{key: getattr(own, key) for key in ("model", "kind", "parameters", "history")},
        "latency_us": None if own.latency is None else asdict(own.latency),
        "rollout": None
        if not own.rollouts
        else {
            "episodes": [run.episode for run in own.rollouts],
            "position_rms_rad": None if own.position_rms is None else own.position_rms.value,
            "position_rms_rad_interval_95": own.position_rms and own.position_rms.ends,
            "by_episode_rad": [run.position_rms for run in own.rollouts],
            "work_J": [run.work for run in own.rollouts],
            "plant_work_J": [run.plant_work for run in own.rollouts],
            "ran_away": sum(run.diverged for run in own.rollouts),
            "injects_energy": sum(run.injects for run in own.rollouts),
        },
        "drift": None if own.drift is None else asdict(own.drift),
        "streaming_less_window_Nm": None if own.modes is None else asdict(own.modes),
        "leaked_rmse_Nm": own.leaked_rmse,
    }
