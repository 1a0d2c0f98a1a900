"""``cqdd-design compare``."""

from __future__ import annotations

import textwrap
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cqdd_design.cli import completion
from cqdd_design.cli.fitting import WIDTH
from cqdd_design.cli.options import (
    DesignFile,
    NamedMotor,
    OwnMotor,
    option,
    parse_positive,
    parse_whole_list,
    quantity_option,
)
from cqdd_design.cli.session import Output, read_design
from cqdd_design.cli.tables import folded, number, table

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
        str | None,
        option(
            "NAME",
            "Material of the gears; default that of the discs.",
            autocompletion=completion.materials,
        ),
    ] = None,
    planets: Annotated[
        int | None, option("N", "Planets looked at in detail; default the most that fit.")
    ] = None,
    settings: Annotated[
        Path | None, option("FILE", "Settings of the rating in TOML; options below go before it.")
    ] = None,
    material_quality: Annotated[
        str | None, option("ML|MQ|ME", "Of ISO 6336-5; default MQ.")
    ] = None,
    accuracy_class: Annotated[int | None, option("N", "Of ISO 1328-1; default 5, ground.")] = None,
    application_factor: Annotated[float | None, option("X", "K_A; default 1.")] = None,
    mesh_load_table: Annotated[
        str | None,
        option(
            "NAME",
            "K_gamma by number of planets; default iso.",
            autocompletion=completion.mesh_load_tables,
        ),
    ] = None,
    lubricant_viscosity: Annotated[
        str | None, quantity_option('At 40 degC; default "150 mm^2/s".')
    ] = None,
    life_hours: Annotated[
        float | None, option("H", "At the continuous torque; default 1000.")
    ] = None,
    peak_cycles: Annotated[
        float | None, option("N", "Of every tooth at the peak torque; default 1e4.")
    ] = None,
    least_contact_safety: Annotated[float | None, option("X", "S_H asked; default 1.")] = None,
    least_bending_safety: Annotated[float | None, option("X", "S_F asked; default 1.2.")] = None,
    shifts: Annotated[
        str | None,
        option("S,P1,P2,R", "Profile shifts, the ring's in the sign of ISO 21771; default least."),
    ] = None,
    motor: NamedMotor = None,
    motor_file: OwnMotor = None,
) -> None:
    """The same loads on a compound planetary, rated by ISO 6336."""
    from cqdd_design.planetary.kinematics import PlanetaryTeeth
    from cqdd_design.planetary.settings import read_settings
    from cqdd_design.roads.compare import compare as compared
    from cqdd_design.units import LENGTH

    counts = parse_whole_list("--teeth", teeth, 4, "12,36,22,70")
    asked = {
        "material_quality": material_quality,
        "accuracy_class": accuracy_class,
        "application_factor": application_factor,
        "mesh_load_table": mesh_load_table,
        "lubricant_viscosity": lubricant_viscosity,
        "life_hours": life_hours,
        "peak_cycles": peak_cycles,
        "least_contact_safety": least_contact_safety,
        "least_bending_safety": least_bending_safety,
        "shifts": shifts,
    }
    given = {key: value for key, value in asked.items() if value is not None}
    chosen = read_settings(settings, given)
    loaded = read_design(out, design, motor, motor_file)
    found = compared(
        loaded,
        teeth=PlanetaryTeeth(*counts),
        module=parse_positive("--module", module, LENGTH),
        face_width=parse_positive("--face-width", face_width, LENGTH),
        material=material,
        planets=planets,
        settings=chosen,
    )
    out.say(*_lines(found))
    out.warn(*found.warnings)
    out.document(found.to_dict(), design=loaded)


def _lines(found: PlanetaryComparison) -> list[str]:
    results = found.to_dict()["planetary"]
    assert isinstance(results, dict)
    head = ["planets", "mesh", "load", "sigma_H MPa", "S_H", "sigma_F MPa", "S_F"]
    rows = [
        [
            str(row["planets"]),
            row["mesh"].replace("_", " and "),
            row["load"],
            *(number(row[key]) for key in ("sigma_H_MPa", "S_H", "sigma_F_MPa", "S_F")),
        ]
        for row in results["by_planets"]
        if row["planets"] in {found.planets, found.planets_that_fit, 6}
    ]
    assembling = ", ".join(str(n) for n in found.planets_that_assemble)
    claims = []
    for claim in found.claims:
        told = f"- {claim.claim} Paper: {claim.paper}. Ours: {claim.ours}. It {claim.verdict}."
        claims.append(textwrap.fill(told, width=WIDTH, subsequent_indent="  "))
    settings = [
        [name, value, "default" if usual else "given"]
        for name, value, usual in found.gears.settings.rows()
    ]
    return [
        *folded(
            f"compound planetary, {results['material']}: ratio {number(results['ratio'], 6)}, "
            f"centre distance {number(results['centre_distance_mm'])} mm"
        ),
        f"profile shifts {found.gears.shifts_text}; tip diameter of the ring "
        f"{number(results['ring_tip_diameter_mm'], 5)} mm",
        *folded(f"at most {found.planets_that_fit} planets fit; these assemble: {assembling}"),
        "",
        table(rows, head=head, right=(0, 3, 4, 5, 6)),
        "",
        "rated with:",
        table(settings, head=["setting", "value", ""], right=()),
        "",
        "the paper's claims, judged on the paper's actuator:",
        *claims,
    ]
