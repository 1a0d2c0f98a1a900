"""What ISO 6336 leaves to the designer, with a stated default and its reason for each."""

from __future__ import annotations

from dataclasses import dataclass


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
    least_contact_safety: float = 1.0
    least_bending_safety: float = 1.2

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
