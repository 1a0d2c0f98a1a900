"""Catalogues of bought parts and materials: CSV files with a source per row, and typed readers.

Values are SI in the records (m, N, Pa, kg) and catalogue units in the files.
"""

from cqdd_design.catalog.bearings import Bearing, bearings, find_bearing
from cqdd_design.catalog.finishes import Finish, find_finish, finishes
from cqdd_design.catalog.fits import FitLimits, fit_limits, fit_zones
from cqdd_design.catalog.lubricants import Lubricant, find_lubricant, lubricants
from cqdd_design.catalog.materials import Material, find_material, materials
from cqdd_design.catalog.motors import Motor, find_bare_motor, find_motor, motors
from cqdd_design.catalog.screws import ShoulderScrew, find_shoulder_screw, shoulder_screws

__all__ = [
    "Bearing",
    "Finish",
    "FitLimits",
    "Lubricant",
    "Material",
    "Motor",
    "ShoulderScrew",
    "bearings",
    "find_bare_motor",
    "find_bearing",
    "find_finish",
    "find_lubricant",
    "find_material",
    "find_motor",
    "find_shoulder_screw",
    "finishes",
    "fit_limits",
    "fit_zones",
    "lubricants",
    "materials",
    "motors",
    "shoulder_screws",
]
