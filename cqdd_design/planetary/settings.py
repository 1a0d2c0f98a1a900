"""What ISO 6336 leaves to the designer, with a stated default and its reason for each."""

from __future__ import annotations

from dataclasses import dataclass

from cqdd_design.errors import UsageError
from cqdd_design.planetary.iso6336 import influence
from cqdd_design.planetary.profile_shift import ProfileShifts
from cqdd_design.planetary.tooth_geometry import ISO_53_A, BasicRack


@dataclass(frozen=True)
class RatingSettings:
    """What ISO 6336 leaves to the designer.

    Attributes
    ----------
    application_factor : float
        K_A. 1: peak and continuous torque are stated apart, as for the cycloid.
    mesh_load_table : str
        K_gamma by number of planets, a key of `influence.MESH_LOAD_TABLES`.
    dynamic_factor, face_load_factor, transverse_load_factor : float or None
        K_v, K_Hbeta, K_Halpha where stated; None computes them by methods B, C and B. A stated
        factor holds for the root as well (K_Fbeta follows from K_Hbeta by 7.6).
    accuracy_class : int
        ISO 1328-1 class. 5, ground: the care the paper spends on its +-2 um cycloid.
    crowned : bool
        Flanks crowned by half the mounting misalignment, as planets should be.
    lubricant_viscosity : float
        nu_40 in m^2/s. 150 mm^2/s, the base oil of a common NLGI 2 gear grease.
    flank_roughness, root_roughness : float
        R_z in m. 3 um for ground or finely eroded flanks; 10 um, the test gears', for the root.
    life_hours : float
        Life at the continuous torque and full input speed. 1000 h, as asked of the cam bearing.
    peak_cycles : float
        Load cycles of every tooth at peak torque. 1e4: still static strength in ISO 6336-3, as the
        cycloid's peak limits are static.
    reversing : bool
        Whether the duty bends every root both ways. A single planet gear always is.
    shifts : ProfileShifts or None
        None for :func:`profile_shift.default_shifts`.
    rack : BasicRack
        Profile A of ISO 53.
    cutter_teeth : int
        Teeth of the pinion cutter that makes the ring.
    ring_rim : float or None
        Rim outside the ring's root, m; None for the larger of 2.5 mm (the least wall of the
        cycloid's ring) and 2.5 modules.
    planet_bore : float or None
        Bearing bore of the planets, m; None for one small enough (1.2 tooth depths of rim) to leave
        the roots their strength.
    least_contact_safety, least_bending_safety : float
        S_H 1.0 and S_F 1.2, the margins the cycloid's contact and pins must keep.
    """

    application_factor: float = 1.0
    mesh_load_table: str = "iso"
    dynamic_factor: float | None = None
    face_load_factor: float | None = None
    transverse_load_factor: float | None = None
    accuracy_class: int = 5
    crowned: bool = True
    lubricant_viscosity: float = 150e-6
    flank_roughness: float = 3e-6
    root_roughness: float = 10e-6
    life_hours: float = 1000.0
    peak_cycles: float = 1e4
    reversing: bool = False
    shifts: ProfileShifts | None = None
    rack: BasicRack = ISO_53_A
    cutter_teeth: int = 20
    ring_rim: float | None = None
    planet_bore: float | None = None
    least_contact_safety: float = 1.0
    least_bending_safety: float = 1.2

    def __post_init__(self) -> None:
        """Refuse settings outside the ranges the formulas hold for."""
        ranges = (
            ("application_factor", 0.1, 10.0, 1.0),
            ("dynamic_factor", 1.0, 10.0, 1.05),
            ("face_load_factor", 1.0, 10.0, 1.25),
            ("transverse_load_factor", 1.0, 10.0, 1.0),
            ("accuracy_class", 1, 11, 5),
            ("lubricant_viscosity", 1e-6, 1e-1, 150e-6),
            ("flank_roughness", 0.1e-6, 100e-6, 3e-6),
            ("root_roughness", 0.1e-6, 100e-6, 10e-6),
            ("life_hours", 1e-3, 1e7, 1000.0),
            ("peak_cycles", 1.0, 1e12, 1e4),
            ("cutter_teeth", 8, 500, 20),
            ("ring_rim", 1e-5, 1.0, 2.5e-3),
            ("planet_bore", 1e-5, 1.0, 8e-3),
            ("least_contact_safety", 0.1, 10.0, 1.0),
            ("least_bending_safety", 0.1, 10.0, 1.2),
        )
        for name, least, most, usual in ranges:
            value = getattr(self, name)
            if value is not None and not least <= value <= most:
                raise UsageError(
                    f"settings: {name} = {value:g} is outside {least:g} to {most:g}; "
                    f"{usual:g} is usual."
                )
        influence.mesh_load_factor(3, self.mesh_load_table)

    @classmethod
    def nominal(cls) -> RatingSettings:
        """All load factors K = 1: the stress of a perfect gear, for comparison by hand."""
        return cls(
            mesh_load_table="equal",
            dynamic_factor=1.0,
            face_load_factor=1.0,
            transverse_load_factor=1.0,
        )

    @property
    def label(self) -> str:
        """The load factors in words, as answers quote them."""
        parts = [f"K_A {self.application_factor:g}"]
        equal = self.mesh_load_table == "equal"
        parts.append("K_gamma 1" if equal else f"K_gamma by table '{self.mesh_load_table}'")
        for name, value, method in (
            ("K_v", self.dynamic_factor, "B"),
            ("K_Hbeta", self.face_load_factor, "C"),
            ("K_Halpha", self.transverse_load_factor, "B"),
        ):
            parts.append(f"{name} {value:g}" if value is not None else f"{name} method {method}")
        if None in (self.dynamic_factor, self.face_load_factor, self.transverse_load_factor):
            crowning = "crowned" if self.crowned else "not crowned"
            parts.append(f"class {self.accuracy_class}, {crowning}")
        return ", ".join(parts)
