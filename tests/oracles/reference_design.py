"""Reference design S, with as many discs as a test asks for."""

from __future__ import annotations

from pathlib import Path

from contact_checks import one_body

from cqdd_design.design import load_design
from cqdd_design.gearbox.contact.model import ContactModel

DESIGN_S = Path(__file__).resolve().parents[2] / "designs" / "reference-s.toml"


def reference_s(disc_count: int = 2) -> ContactModel:
    """S as the contact equilibrium sees it, plate and cap of its carrier one body."""
    design = load_design(DESIGN_S)
    reducer = design.reducer.unchecked_copy({"disc_count": disc_count})
    return one_body(ContactModel.from_design(design.unchecked_copy({"reducer": reducer})))
