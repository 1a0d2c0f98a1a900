"""What closes a machine to dust and keeps its grease in, and what does not."""

from __future__ import annotations

from cqdd_design.machine.machine import Machine


def output_gap(machine: Machine) -> float:
    """Radial gap between bearing nut and cover's lip, m.

    Raises
    ------
    GeometryError
        When the machine cannot be laid out.
    """
    output = machine.layout.carrier.output
    return output.lip_radius - output.shoulder_radius


def bearing_seals(machine: Machine) -> str:
    """How support and output bearings are ordered."""
    if machine.design.reducer.friction.seals == "contact":
        return "with contact seals on both sides"
    return "open, not sealed"


def sealing(machine: Machine) -> str:
    """A sentence on what is sealed; GeometryError as :func:`output_gap`."""
    gap = f"{1e3 * output_gap(machine):.2g} mm between nut and cover"
    if machine.design.reducer.friction.seals == "contact":
        return (
            "Sealed by its bearings alone: shaft and output bearings have contact seals on both "
            f"sides, whose drag is counted. The {gap} and the flanges' faces have no seal."
        )
    return (
        f"Not sealed: the {gap} on the output side and the shaft's bearing on the motor side are "
        "open, and nothing keeps dust and water out or grease in. Sealed bearings "
        "(reducer.friction.seals) are the only seal there is."
    )
