"""Sizes with their limits in a part's AP242 file, tied to the faces that they are of.

They are the diameters of the part's seats and fitted holes: those that a drawing gives a zone. The
kernel writes each as a dimension of its cylinders (ISO 10303-242, DIMENSIONAL_SIZE with a
PLUS_MINUS_TOLERANCE), which measuring and milling software reads without a drawing.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from cqdd_design.errors import CatalogError
from cqdd_design.solids.cad import MM
from cqdd_design.solids.features.holes import FittedHole
from cqdd_design.solids.features.kinds import Seat

if TYPE_CHECKING:
    from cqdd_design.solids.part import Part

_NEAR = 0.02
"""By how much a face may lie off the nominal size, mm: some parts are drawn at their mean."""


class Size(NamedTuple):
    """A diameter with its limits, mm, and the faces of the solid that have it."""

    diameter: float
    lower: float
    upper: float
    faces: tuple[Any, ...]


def sizes_of(part: Part) -> tuple[Size, ...]:
    """Seats and fitted holes of a part whose zones are tabulated, with their faces."""
    faces = [face for face in part.solid.Faces() if face.geomType() == "CYLINDER"]
    return tuple(size for size in _sizes(part, faces) if size.faces)


def _sizes(part: Part, faces: list[Any]) -> Iterator[Size]:
    for feature in part.features:
        if not isinstance(feature, Seat | FittedHole):
            continue
        try:
            limits = feature.limits
        except CatalogError:
            continue
        centres = [feature.centre] if isinstance(feature, Seat) else feature.circle.centres
        found = tuple(
            face
            for face in faces
            if any(_is_of(face, feature, (MM * x, MM * y)) for x, y in centres)
        )
        yield Size(MM * feature.diameter, MM * limits.lower, MM * limits.upper, found)


def _is_of(face: Any, feature: Seat | FittedHole, centre: tuple[float, float]) -> bool:
    """Whether a cylinder has the size, axis and heights of a feature."""
    cylinder = face._geomAdaptor().Cylinder()
    axis = cylinder.Axis().Location()
    away = max(abs(axis.X() - centre[0]), abs(axis.Y() - centre[1]))
    middle = face.Center().z
    return bool(
        abs(2.0 * cylinder.Radius() - MM * feature.diameter) < _NEAR
        and away < _NEAR
        and MM * feature.bottom < middle < MM * feature.top
    )


def write_with_sizes(part: Part, path: Path) -> bool:
    """Write a part in its own frame with its sizes; whether the kernel did.

    The process's schema has to be AP242.
    """
    from OCP.IFSelect import IFSelect_ReturnStatus
    from OCP.Interface import Interface_Static
    from OCP.Quantity import Quantity_Color, Quantity_TOC_RGB
    from OCP.STEPCAFControl import STEPCAFControl_Writer
    from OCP.STEPControl import STEPControl_StepModelType
    from OCP.TCollection import TCollection_ExtendedString
    from OCP.TDataStd import TDataStd_Name
    from OCP.TDocStd import TDocStd_Document
    from OCP.XCAFApp import XCAFApp_Application
    from OCP.XCAFDoc import XCAFDoc_ColorType, XCAFDoc_DocumentTool

    document = TDocStd_Document(TCollection_ExtendedString("XmlOcaf"))
    XCAFApp_Application.GetApplication_s().InitDocument(document)
    shapes = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    whole = shapes.AddShape(part.solid.wrapped, False)
    TDataStd_Name.Set_s(whole, TCollection_ExtendedString(part.name))
    colours = XCAFDoc_DocumentTool.ColorTool_s(document.Main())
    colour = Quantity_Color(*part.colour, Quantity_TOC_RGB)
    colours.SetColor(whole, colour, XCAFDoc_ColorType.XCAFDoc_ColorSurf)
    for size in sizes_of(part):
        _add(document, shapes, whole, size)
    writer = STEPCAFControl_Writer()
    writer.SetNameMode(True)
    writer.SetColorMode(True)
    writer.SetDimTolMode(True)
    # As the other files are written: in mm, without curves in the parameters of faces.
    Interface_Static.SetIVal_s("write.surfacecurve.mode", 0)
    for setting in ("xstep.cascade.unit", "write.step.unit"):
        Interface_Static.SetCVal_s(setting, "MM")
    writer.Transfer(document, STEPControl_StepModelType.STEPControl_AsIs)
    return bool(writer.Write(str(path)) == IFSelect_ReturnStatus.IFSelect_RetDone)


def _add(document: Any, shapes: Any, whole: Any, size: Size) -> None:
    from OCP.TDF import TDF_LabelSequence
    from OCP.XCAFDimTolObjects import (
        XCAFDimTolObjects_DimensionObject,
        XCAFDimTolObjects_DimensionType,
    )
    from OCP.XCAFDoc import XCAFDoc_Dimension, XCAFDoc_DocumentTool

    tolerances = XCAFDoc_DocumentTool.DimTolTool_s(document.Main())
    labels = TDF_LabelSequence()
    for face in size.faces:
        labels.Append(shapes.AddSubShape(whole, face.wrapped))
    label = tolerances.AddDimension()
    stated = XCAFDimTolObjects_DimensionObject()
    stated.SetType(XCAFDimTolObjects_DimensionType.XCAFDimTolObjects_DimensionType_Size_Diameter)
    stated.SetValue(size.diameter)
    stated.SetUpperTolValue(size.upper)
    stated.SetLowerTolValue(size.lower)
    XCAFDoc_Dimension.Set_s(label).SetObject(stated)
    tolerances.SetDimension(labels, TDF_LabelSequence(), label)
