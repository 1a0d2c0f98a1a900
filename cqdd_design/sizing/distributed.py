"""Work the blocks of an ensemble on a Dask cluster.

A block is a pure function of the ensemble and its place, so it can be worked anywhere, and again
when a worker is lost; results are put together by place and are the same to the last digit.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from cqdd_design.errors import DependencyError, UsageError
from cqdd_design.gearbox.tolerance.ensemble import Block, Ensemble, Mapper, work_block
from cqdd_design.geometry.contours import FloatArray

_CONNECT_SECONDS = 5
_RETRIES = 3
"""Workers a block may lose before it is given up."""


def dask_client(address: str) -> Any:
    """Connect to a scheduler.

    Parameters
    ----------
    address : str
        As ``tcp://10.0.0.1:8786``.

    Returns
    -------
    distributed.Client
        A context manager; it closes the connection.

    Raises
    ------
    DependencyError
        When Dask is not installed.
    UsageError
        When there is no scheduler at the address within five seconds, or it has no workers.
    """
    try:
        import distributed

        client_class: Any = distributed.Client
    except ImportError as error:
        raise DependencyError(
            '--scheduler needs Dask; install it with: pip install "cqdd-design[sweep]"'
        ) from error
    try:
        client = client_class(address, timeout=_CONNECT_SECONDS)
    except (OSError, TimeoutError, ValueError) as error:
        raise UsageError(
            f"there is no Dask scheduler at {address} ({type(error).__name__}); start one with "
            "`dask scheduler` and give the address it prints, such as tcp://127.0.0.1:8786."
        ) from error
    return client


def on_cluster(client: Any) -> Mapper:
    """A mapper for :func:`.run_ensemble` that works blocks on a cluster, in any order."""

    def work(ensemble: Ensemble, blocks: list[Block]) -> Iterator[tuple[int, FloatArray]]:
        import distributed

        as_completed: Any = distributed.as_completed
        futures = {}
        # The design is sent once, not with every block.
        held = client.scatter(ensemble, broadcast=False, hash=False)
        for place, block in enumerate(blocks):
            # In order where possible: the gearboxes themselves before their ranking.
            future = client.submit(
                work_block, held, block, pure=False, retries=_RETRIES, priority=-place
            )
            futures[future.key] = (place, future)
        try:
            for future in as_completed([one for _, one in futures.values()]):
                yield futures[future.key][0], future.result()
        finally:
            client.cancel([one for _, one in futures.values()])

    return work
