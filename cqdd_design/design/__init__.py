"""Requirements and designs: frozen models, TOML in and out, JSON schema."""

from cqdd_design.design.model import SCHEMA_VERSION, Design
from cqdd_design.design.reducer import Reducer, RingType
from cqdd_design.design.requirements import DutyPoint, Requirements
from cqdd_design.design.toml import (
    LARGEST_FILE,
    load_design,
    load_requirements,
    requirements_from_mapping,
    save_design,
)

__all__ = [
    "LARGEST_FILE",
    "SCHEMA_VERSION",
    "Design",
    "DutyPoint",
    "Reducer",
    "Requirements",
    "RingType",
    "load_design",
    "load_requirements",
    "requirements_from_mapping",
    "save_design",
]
