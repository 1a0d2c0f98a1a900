"""The actuator that data were recorded on, for the commands of ``torque``."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from cqdd_design.cli.session import Output, read_factors
from cqdd_design.errors import UsageError

if TYPE_CHECKING:
    from cqdd_design.actuator.parameters import ActuatorParameters
    from cqdd_design.design import Design
    from cqdd_design.torque.data.episodes import DataSet


def refuse_without_design(design: Path | None, given: Mapping[str, object]) -> None:
    """Refuse options, name to value, that say more of a design where none is named."""
    for name, value in given.items():
        if design is None and value is not None:
            raise UsageError(f"{name} belongs to a design; give it with --design.")


def data_actuator(
    out: Output,
    data: DataSet,
    design: Design,
    gearbox: int | None,
    calibration: Path | None,
) -> ActuatorParameters:
    """The actuator of a design, drawn and calibrated as the data's own where they say so."""
    from cqdd_design.actuator.build import actuator_parameters
    from cqdd_design.actuator.specimen import Specimen

    facts = data.facts
    seed = facts.get("training_gearbox") if gearbox is None else gearbox
    own = facts.get("calibration") if calibration is None else None
    factors = read_factors(out, calibration, design) or (own if isinstance(own, dict) else {})
    out.compile_ahead(design)
    if facts.get("design_sha256") not in (None, design.sha256):
        out.warn(f"the data are of another design or version of it than {design.name}.")
    specimen = Specimen(
        seed=None if seed is None else int(seed),
        factors={name: value for name, value in factors.items() if name != "tolerance_scale"},
    )
    return actuator_parameters(
        specimen.machine(design), specimen, supply_voltage=facts.get("supply_voltage_V")
    )
