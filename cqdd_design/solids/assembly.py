"""The machine as a CadQuery assembly: named, coloured, in any position."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from cqdd_design.design import Design
from cqdd_design.solids.cad import import_cadquery, location
from cqdd_design.solids.part import Part

if TYPE_CHECKING:
    from cadquery import Assembly


def build_assembly(design: Design, parts: Sequence[Part], crank_angle: float = 0.0) -> Assembly:
    """Put all pieces in place.

    Parameters
    ----------
    parts : sequence of Part
        From `build_parts`.
    crank_angle : float
        rad; the discs orbit with it, the carrier follows at -1/n.

    Returns
    -------
    cadquery.Assembly
        In mm, the ring's frame, output upward. Pieces of one part share one solid; every piece
        has its own name, so a viewer lists ``shoulder screw 3``.
    """
    cadquery = import_cadquery()
    assembly: Assembly = cadquery.Assembly(name=design.name)
    for part in parts:
        colour = cadquery.Color(*part.colour, 1.0)
        for piece in part.instances:
            assembly.add(
                part.solid,
                name=piece.name,
                loc=location(piece.pose(design, crank_angle)),
                color=colour,
            )
    return assembly
