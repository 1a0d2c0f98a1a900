"""What every road tells: how far it is, and when and from what a result was made."""

from __future__ import annotations

from collections.abc import Callable
from datetime import UTC, datetime
from typing import TYPE_CHECKING

from cqdd_design.environment import source_date
from cqdd_design.version import __version__

if TYPE_CHECKING:
    from cqdd_design.design import Design
    from cqdd_design.results import Provenance

Progress = Callable[[str], None]


def silent(stage: str) -> None:
    """Progress that nobody asked for."""


def provenance(design: Design | None) -> Provenance:
    """Version, time and design hash of a result made now.

    The time is that of the environment variable ``SOURCE_DATE_EPOCH`` where it is set, so that
    the same input gives the same bytes. No design, no hash.
    """
    from cqdd_design.results import Provenance

    moment = source_date() or datetime.now(UTC)
    return Provenance(
        version=__version__,
        time=moment.strftime("%Y-%m-%dT%H:%M:%SZ"),
        design_sha256="" if design is None else design.sha256,
    )
