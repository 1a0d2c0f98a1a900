"""Requirements and designs: frozen models, TOML in and out, JSON schema."""

from cqdd_design.design.model import Design
from cqdd_design.design.requirements import Requirements
from cqdd_design.design.toml import (
    LARGEST_FILE,
    load_design,
    load_required_motor,
    load_requirements,
    requirements_from_mapping,
    save_design,
)

__all__ = [
    "LARGEST_FILE",
    "Design",
    "Requirements",
    "load_design",
    "load_required_motor",
    "load_requirements",
    "requirements_from_mapping",
    "save_design",
]
