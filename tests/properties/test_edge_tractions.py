"""Tractions of point loads on a body's edges, from afar by series, beside their plain twin."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from flamant_plain import displacements_plain, tractions_plain

from cqdd_design.design import load_design
from cqdd_design.gearbox.bodies.disc import DiscShape
from cqdd_design.gearbox.bodies.edge_tractions import EdgeTractions
from cqdd_design.gearbox.bodies.elements import elements
from cqdd_design.gearbox.bodies.mesh import mesh
from cqdd_design.gearbox.bodies.ring import RingShape
from cqdd_design.machine import resolve

DESIGNS = Path(__file__).resolve().parents[2] / "designs"


@pytest.mark.parametrize("kind", ["disc", "ring on its seat"])
@pytest.mark.parametrize("name", ["reference-s", "cqdd-10"])
def test_series_give_what_every_traction_does(name: str, kind: str) -> None:
    """Work on any motion, and forces at unknowns, of loads near and far, beside all tractions."""
    design = resolve(load_design(DESIGNS / f"{name}.toml")).design
    shape: DiscShape | RingShape
    shape = DiscShape.from_design(design, 0) if kind == "disc" else RingShape.from_design(design)
    loops, places = shape.loops(), shape.places()
    body = elements(mesh(loops, shape.side, "the body"), loops, shape.plate)
    edges = body.edges
    seat = np.where(edges.loop == 0, shape.seat, 0.0) if isinstance(shape, RingShape) else None
    made = EdgeTractions.of(edges.point, edges.normal, edges.loop, places, shape.plate, seat)
    plain = tractions_plain(edges.point, edges.normal, places)
    if seat is not None:
        plain -= seat[:, None] * displacements_plain(edges.point, places, shape.plate)
    weight = np.tile(edges.weight, 2)
    every = np.concatenate([plain.real, plain.imag])
    moved = weight[:, None] * np.random.default_rng(3).normal(size=(len(weight), 5))
    begin, end = 4, 2 * len(places) - 2
    wanted = every[:, begin:end].T @ moved
    found = made.work(moved, begin, end)
    assert np.abs(found - wanted).max() < 1e-9 * np.abs(wanted).max()
    # Most are far in a disc, and only series tell of them; on springs every load is near.
    far = (made.series != 0.0).mean()
    assert far > (0.5 if seat is None else 0.2)
    weighed = edges.trace[:, edges.unknowns].multiply(weight[:, None]).tocsr()
    loads = np.array([0, 1, 8, 9, end, end + 1])
    nodal = weighed.T @ every[:, loads]
    added = np.ones(nodal.shape)
    made.add_forces(added, weighed, loads)
    assert np.abs(added - 1.0 - nodal).max() < 1e-9 * np.abs(nodal).max()
