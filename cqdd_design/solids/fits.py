"""Tolerance zones of the seats, named as on a drawing (ISO 286).

Why these: the load of a cam bearing turns with the crank, so its inner ring has a standing load
and slips on the lobe (h6), while its outer ring is pressed into the disc (N7). The shaft's support
bearings and the output bearing are pressed on what turns (k6) and slide in what stands (H7). Ring
and pins are located without play that matters: n6 in H7 for the ring, which its clamp then holds,
H7 over the f9 shoulders of the screws. A retaining compound fills what H7 leaves there where a pin
is to sit stiffly: in a cap whose joint is clamped, and in the plate where a dowel has no thread.
The bell's bore is F7 over the k6 of the shaft, a slip fit of a few hundredths at most that the
compound fills.
"""

from __future__ import annotations

from dataclasses import dataclass

from cqdd_design.catalog.fits import FitLimits, fit_limits
from cqdd_design.solids.layout import Layout

_MM = 1e3


@dataclass(frozen=True)
class Fit:
    """The tolerance zone of one seat of a part.

    Attributes
    ----------
    part : str
        Name of the part; ``disc`` stands for every disc.
    feature : str
        Such as ``bore for the cam bearing``.
    diameter : float
        Nominal, m.
    zone : str
        Such as ``H7``.
    """

    part: str
    feature: str
    diameter: float
    zone: str

    def __str__(self) -> str:
        """As on a drawing: ``bore for the cam bearing 28 N7``."""
        return f"{self.feature} {self.diameter * _MM:.6g} {self.zone}"

    @property
    def limits(self) -> FitLimits:
        """Deviations from nominal.

        Raises
        ------
        CatalogError
            When the diameter is outside the table.
        """
        return fit_limits(self.zone, self.diameter)

    def belongs_to(self, part: str) -> bool:
        """Whether a part of this name has this seat."""
        return part == self.part or (self.part == "disc" and part.startswith("disc "))


def seat_fits(layout: Layout) -> tuple[Fit, ...]:
    """The fits of every seat of a machine."""
    pack, shaft, carrier, housing = layout.pack, layout.shaft, layout.carrier, layout.housing
    cam, support, output = pack.cam.bearing, shaft.support.bearing, carrier.output.bearing
    ring, pin = 2.0 * pack.ring_radius, carrier.pin.nominal_diameter
    fits = [
        Fit("disc", "bore for the cam bearing", cam.outer_diameter, "N7"),
        Fit("ring", "outside", ring, "n6"),
        Fit("eccentric shaft", "lobes", cam.bore_diameter, "h6"),
        Fit("eccentric shaft", "journals and rotor seat", support.bore_diameter, "k6"),
        Fit("carrier plate", "seat of the output bearing", output.bore_diameter, "k6"),
        Fit("carrier plate", "seat of the shaft bearing", support.outer_diameter, "H7"),
        Fit("carrier plate", "pin seats" if carrier.pin.screw else "bonded pin seats", pin, "H7"),
        Fit("housing", "ring seat", ring, "H7"),
        Fit("housing", "seat of the shaft bearing", support.outer_diameter, "H7"),
        Fit("output cover", "seat of the output bearing", output.outer_diameter, "H7"),
    ]
    if housing.seated_motor:
        fits.append(Fit("housing", "stator register", 2.0 * housing.register_radius, "h7"))
    if layout.motor is not None:
        magnets = 2.0 * layout.motor.rotor_outer
        fits.append(Fit("rotor bell", "bonded bore", support.bore_diameter, "F7"))
        fits.append(Fit("rotor bell", "seat of the ring of magnets", magnets, "H7"))
    if layout.dowels.radius:
        for part in ("ring", "housing"):
            fits.append(Fit(part, "holes of the ring dowels", 2.0 * layout.dowels.radius, "H7"))
    if carrier.flange_dowels.count:
        size = carrier.flange_dowels.diameter
        fits.append(Fit("carrier plate", "dowel holes of the output", size, "H7"))
    if carrier.cap:
        holes = "bonded pin seats" if carrier.bonded_in_cap else "pin holes"
        fits.append(Fit("carrier cap", holes, pin, "H7"))
    if pack.disc_count > 2:
        core = 2.0 * shaft.shoulder_radius
        fits.append(Fit("eccentric shaft", "seat of the eccentric cam", core, "p6"))
        fits.append(Fit("eccentric cam", "bore", core, "H7"))
        fits.append(Fit("eccentric cam", "lobe", cam.bore_diameter, "h6"))
    return tuple(fits)
