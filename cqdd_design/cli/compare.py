"""``cqdd-design compare``."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING, Annotated

from cqdd_design.cli.options import (
    DesignFile,
    option,
    parse_positive,
    parse_whole_list,
    quantity_option,
)
from cqdd_design.cli.session import Output
from cqdd_design.cli.tables import number, table

if TYPE_CHECKING:
    from cqdd_design.planetary.compare import PlanetaryComparison


def compare(
    out: Output,
    design: DesignFile,
    teeth: Annotated[
        str, option("S,P1,P2,R", "Teeth of sun, planet at sun and at ring, ring.")
    ] = "12,36,22,70",
    module: Annotated[str, quantity_option("Module of both meshes.")] = "1 mm",
    face_width: Annotated[str, quantity_option("Face width of both meshes.")] = "12 mm",
    material: Annotated[
        str | None, option("NAME", "Material of the gears; default that of the discs.")
    ] = None,
    planets: Annotated[
        int | None, option("N", "Planets looked at in detail; default the most that fit.")
    ] = None,
) -> None:
    """The same loads on a compound planetary, rated by ISO 6336."""
    from cqdd_design.design import load_design
    from cqdd_design.planetary.kinematics import PlanetaryTeeth
    from cqdd_design.roads.compare import compare as compared
    from cqdd_design.units import LENGTH

    counts = parse_whole_list("--teeth", teeth, 4, "12,36,22,70")
    loaded = load_design(design)
    found = compared(
        loaded,
        teeth=PlanetaryTeeth(*counts),
        module=parse_positive("--module", module, LENGTH),
        face_width=parse_positive("--face-width", face_width, LENGTH),
        material=material,
        planets=planets,
    )
    out.say(*_lines(found))
    out.warn(*found.warnings)
    out.document(found.to_dict(), design=loaded)


def _lines(found: PlanetaryComparison) -> list[str]:
    results = found.to_dict()["planetary"]
    assert isinstance(results, dict)
    head = ["planets", "fits", "assembles", "mesh", "load"]
    head += ["sigma_H MPa", "S_H", "sigma_F MPa", "S_F"]
    rows = [
        [
            str(row["planets"]),
            "yes" if row["fits"] else "no",
            "yes" if row["assembles"] else "no",
            row["mesh"],
            row["load"],
            *(number(row[key]) for key in ("sigma_H_MPa", "S_H", "sigma_F_MPa", "S_F")),
        ]
        for row in results["by_planets"]
        if row["planets"] in {found.planets, found.planets_that_fit, 6}
    ]
    assembling = ", ".join(str(n) for n in found.planets_that_assemble)
    claims = []
    for claim in found.claims:
        word = {True: "holds", False: "does not hold", None: "open"}[claim.holds]
        told = f"- {claim.claim} Paper: {claim.paper}. Ours: {claim.ours}. It {word}."
        claims.append(textwrap.fill(told, width=96, subsequent_indent="  "))
    return [
        f"compound planetary, {results['material']}: ratio {number(results['ratio'], 6)}, "
        f"centre distance {number(results['centre_distance_mm'])} mm",
        f"at most {found.planets_that_fit} planets fit; these assemble: {assembling}",
        "",
        table(rows, head=head, right=(0, 5, 6, 7, 8)),
        "",
        "the paper's claims:",
        *claims,
    ]
