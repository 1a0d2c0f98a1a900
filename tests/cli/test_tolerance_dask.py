"""Ensembles on a real Dask cluster of processes: the same digits, also when a worker is killed."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

distributed = pytest.importorskip("distributed")

from cqdd_design.design import load_design  # noqa: E402
from cqdd_design.errors import UsageError  # noqa: E402
from cqdd_design.gearbox.tolerance.ensemble import make_ensemble  # noqa: E402
from cqdd_design.gearbox.tolerance.run import run_ensemble  # noqa: E402
from cqdd_design.sizing.distributed import dask_client, on_cluster  # noqa: E402

DESIGN = Path(__file__).resolve().parents[2] / "designs" / "cqdd-10.toml"
SAMPLES, ANGLES = 600, 110

pytestmark = pytest.mark.deep


@pytest.fixture(scope="module")
def cluster() -> Iterator[object]:
    """Two worker processes with one thread each, nannies that restart them."""
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
    ) as running:
        yield running


def test_a_cluster_gives_the_same_digits(cluster: object) -> None:
    ensemble = make_ensemble(load_design(DESIGN), angles=ANGLES)
    here = run_ensemble(ensemble, SAMPLES)
    with dask_client(cluster.scheduler_address) as client:  # type: ignore[attr-defined]
        there = run_ensemble(ensemble, SAMPLES, mapper=on_cluster(client))
    assert np.array_equal(here.values, there.values)
    assert here.to_dict()["sensitivity"] == there.to_dict()["sensitivity"]


def test_it_survives_a_killed_worker(cluster: object) -> None:
    ensemble = make_ensemble(load_design(DESIGN), angles=ANGLES, seed=7)
    here = run_ensemble(ensemble, SAMPLES)
    killed: list[int] = []
    with dask_client(cluster.scheduler_address) as client:  # type: ignore[attr-defined]
        victim = next(iter(client.run(os.getpid).values()))

        def kill(done: int, total: int) -> None:
            if not killed:
                os.kill(victim, signal.SIGKILL)
                killed.append(done)

        there = run_ensemble(ensemble, SAMPLES, mapper=on_cluster(client), progress=kill)
        left = set(client.run(os.getpid).values())
    assert killed
    assert killed[0] < SAMPLES
    assert victim not in left
    assert np.array_equal(here.values, there.values)
    assert not there.interrupted


def test_the_command_works_on_a_scheduler(cluster: object) -> None:
    address = cluster.scheduler_address  # type: ignore[attr-defined]
    options = ["--samples", "40", "--angles", "110", "--json", "--quiet"]
    command = [sys.executable, "-m", "cqdd_design", "tolerance", str(DESIGN), *options]
    results = []
    for extra in ([], ["--scheduler", address]):
        done = subprocess.run(
            [*command, *extra], capture_output=True, text=True, timeout=240, check=False
        )
        assert done.returncode == 0, done.stderr
        results.append(json.loads(done.stdout)["results"])
    for result in results:
        result.pop("seconds")
    assert results[0] == results[1]


def test_an_interrupt_keeps_what_the_cluster_has_done(cluster: object) -> None:
    ensemble = make_ensemble(load_design(DESIGN), angles=ANGLES, seed=3)
    with dask_client(cluster.scheduler_address) as client:  # type: ignore[attr-defined]

        def stop(done: int, total: int) -> None:
            if done > 400:
                raise KeyboardInterrupt

        result = run_ensemble(ensemble, SAMPLES, mapper=on_cluster(client), progress=stop)
    assert result.interrupted
    assert 0 < len(result.values) <= SAMPLES
    assert result.to_dict()["samples"] == len(result.values)
    assert result.sensitivity is None


def test_no_scheduler_is_a_clear_error() -> None:
    with pytest.raises(UsageError, match="no Dask scheduler"):
        dask_client("tcp://127.0.0.1:1")
    assert threading.main_thread().is_alive()
