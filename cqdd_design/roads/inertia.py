"""Mass properties of every part from its mesh, and the balance of the crank."""

from __future__ import annotations

from dataclasses import dataclass, replace

from cqdd_design.actuator.build import motor_and_drive
from cqdd_design.actuator.density import density_torque, torques_of_drive
from cqdd_design.actuator.specimen import AS_DRAWN, Specimen
from cqdd_design.design import Design
from cqdd_design.errors import DesignError
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
    drive_peak : float or None
        Torque at the output that motor and driver give, N m; None where their data do not say.
    """

    machine: Machine
    bodies: Bodies
    paper_disc_count: int
    drive_peak: float | None = None

    @property
    def torque_density(self) -> float | None:
        """Peak torque over mass, N m/kg: the test bench's, on the same torque and mass.

        None where the motor's mass is not known.
        """
        mass = self.bodies.inertia.whole_mass
        return None if mass is None else self._counted[0] / mass

    @property
    def torque_density_scope(self) -> str:
        """Which torque it is, over which mass."""
        inertia = self.bodies.inertia
        if inertia.whole_mass is None:
            return f"the mass of {inertia.motor.name} is not known"
        return f"{self._counted[1]} over {inertia.mass:.4g} kg: {inertia.mass_scope}"

    @property
    def _counted(self) -> tuple[float, str]:
        return density_torque(self.drive_peak, self.machine.design.requirements.peak_torque)

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
            "torque_density_scope": self.torque_density_scope,
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
        machine = replace(machine, design=machine.design.turning_at(speed))
    progress("building solids and meshes")
    bodies = weigh(machine, mass_properties)
    paper = paper_disc_count(design.reducer.ratio)
    return InertiaAndBalance(machine, bodies, paper, _drive_peak(machine, specimen))


def _drive_peak(machine: Machine, specimen: Specimen) -> float | None:
    """Torque at the output that motor and driver give, N m; None where their data do not say."""
    try:
        motor, drive, _ = motor_and_drive(machine, specimen)
    except DesignError:
        return None
    ratio, ambient = machine.design.reducer.ratio, machine.design.environment.ambient
    return min(torques_of_drive(motor, drive, ratio, ambient).values())
