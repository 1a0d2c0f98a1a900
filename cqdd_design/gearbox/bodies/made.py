"""The elastic bodies of a design, each made once."""

from __future__ import annotations

import threading
from functools import lru_cache

from cqdd_design.design import Design
from cqdd_design.errors import GeometryError
from cqdd_design.gearbox.bodies.cache import cached
from cqdd_design.gearbox.bodies.compliance import ElasticBodies
from cqdd_design.gearbox.bodies.disc import DiscShape
from cqdd_design.gearbox.bodies.model import (
    Body,
    disc_body,
    of_standard,
    ring_body,
    to_standard,
)
from cqdd_design.gearbox.bodies.ring import RingShape

_making = threading.Lock()


def elastic_bodies(design: Design) -> ElasticBodies:
    """Discs and ring of a design that names its cam bearing; discs of one kind are computed once.

    Raises
    ------
    GeometryError
        Where a part's material is too thin to mesh, or a disc has too many lobes.
    """
    made: dict[DiscShape, Body] = {}
    discs = []
    for index in range(design.reducer.disc_count):
        shape = DiscShape.from_design(design, index)
        standard = shape.standard()[0]
        if standard not in made:
            made[standard] = cached(standard, disc_body)
        discs.append((shape, of_standard(made[standard], to_standard(shape))))
    ring = RingShape.from_design(design)
    return ElasticBodies(tuple(discs), (ring, cached(ring, ring_body).widened()))


def bodies_or_none(design: Design) -> ElasticBodies | None:
    """The same, read once a process; None where :func:`elastic_bodies` raises.

    Of threads that ask at once one makes them, and the others wait for it.
    """
    with _making:
        return _read_once(design)


@lru_cache(maxsize=2)
def _read_once(design: Design) -> ElasticBodies | None:
    try:
        return elastic_bodies(design)
    except GeometryError:
        return None
