"""Mass properties of every part from its mesh, and the balance of the crank."""

from __future__ import annotations

from dataclasses import dataclass

from cqdd_design.actuator.specimen import AS_DRAWN, Specimen
from cqdd_design.design import Design
from cqdd_design.gearbox.balance import paper_disc_count
from cqdd_design.machine import Machine
from cqdd_design.machine.weighing import Bodies, weigh
from cqdd_design.roads.telling import Progress, silent

#: How often `inertia` tells its progress.
INERTIA_STAGES = 1


@dataclass(frozen=True)
class InertiaAndBalance:
    """Mass properties of a gearbox from meshes, and its balance for one, two and three discs.

    Attributes
    ----------
    bodies : Bodies
        Parts, their mass properties, and the balance by number of discs.
    paper_disc_count : int
        What the paper's rule asks for.
    """

    machine: Machine
    bodies: Bodies
    paper_disc_count: int

    @property
    def torque_density(self) -> float:
        """Peak torque over the mass of all that is drawn, N m/kg."""
        return self.machine.design.requirements.peak_torque / self.bodies.inertia.total.mass

    @property
    def warnings(self) -> tuple[str, ...]:
        """What the figures leave out."""
        missing = tuple(
            f"there is no balance with {count} discs: the parts cannot be put together so."
            for count in (1, 2, 3)
            if count not in self.bodies.balance
        )
        return self.bodies.inertia.warnings + missing

    def to_dict(self) -> dict[str, object]:
        """The JSON form (``results`` of ``inertia``)."""
        by_count = {str(count): self._balance(count) for count in (1, 2, 3)}
        return {
            **self.bodies.inertia.to_dict(),
            "torque_density_Nm_per_kg": self.torque_density,
            "balance": {"by_disc_count": by_count, "paper_disc_count": self.paper_disc_count},
        }

    def _balance(self, count: int) -> dict[str, float] | None:
        found = self.bodies.balance.get(count)
        if found is None:
            return None
        reducer = self.machine.design.reducer
        pack = count * reducer.disc_thickness + (count - 1) * reducer.disc_spacing
        # One weight at each end of the pack: half of the static part, or a pair for the couple.
        weight = 0.5 * found.static_unbalance + found.couple_unbalance / pack
        return {**found.to_dict(), "counterweight_each_end_kgm": weight}


def inertia(
    design: Design,
    specimen: Specimen = AS_DRAWN,
    *,
    speed: float | None = None,
    progress: Progress = silent,
) -> InertiaAndBalance:
    """Mass properties of every part from its mesh, and the balance of the crank.

    Parameters
    ----------
    specimen : Specimen
        Whose motor is weighed.
    speed : float, optional
        Input speed of the shaking forces, rad/s; default that of the requirements.
    progress : callable
        Told in a few words what begins.

    Raises
    ------
    DependencyError
        When CadQuery or one of its system libraries is missing.
    """
    from cqdd_design.solids.mesh import mass_properties

    machine = specimen.machine(design)
    if speed is not None:
        machine = machine.changed({"requirements.input_speed": speed})
    progress("building solids and meshes")
    bodies = weigh(machine, mass_properties)
    return InertiaAndBalance(machine, bodies, paper_disc_count(design.reducer.ratio))
