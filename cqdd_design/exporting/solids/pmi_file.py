"""A part's AP242 file with what `pmi` states of it, as the kernel writes it.

Sizes become dimensions of their cylinders (ISO 10303-242, DIMENSIONAL_SIZE with a
PLUS_MINUS_TOLERANCE), the others geometric tolerances with their datum systems, all without their
looks: measuring and milling software reads them without a drawing.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from cqdd_design.exporting.solids.pmi import Size, Stated, Zone
    from cqdd_design.solids.part import Part


def write_stated(part: Part, stated: Stated, path: Path) -> bool:
    """Write a part in its own frame with all that is stated of it; whether the kernel did.

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
    sheet = _Sheet(document, shapes, whole, stated)
    for size in stated.sizes:
        sheet.add_size(size)
    for zone in stated.zones:
        sheet.add_zone(zone)
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


class _Sheet:
    """The document's table of dimensions, tolerances and datums."""

    def __init__(self, document: Any, shapes: Any, whole: Any, stated: Stated) -> None:
        from OCP.XCAFDoc import XCAFDoc_DocumentTool

        self._tool = XCAFDoc_DocumentTool.DimTolTool_s(document.Main())
        self._shapes, self._whole = shapes, whole
        self._faces = {one.letter: one.faces for one in stated.datums}
        self._datums: dict[tuple[str, int], Any] = {}

    def add_size(self, size: Size) -> None:
        """A diameter with its limits."""
        from OCP.TDF import TDF_LabelSequence
        from OCP.XCAFDimTolObjects import (
            XCAFDimTolObjects_DimensionObject,
            XCAFDimTolObjects_DimensionType,
        )
        from OCP.XCAFDoc import XCAFDoc_Dimension

        label = self._tool.AddDimension()
        stated, kinds = XCAFDimTolObjects_DimensionObject(), XCAFDimTolObjects_DimensionType
        stated.SetType(kinds.XCAFDimTolObjects_DimensionType_Size_Diameter)
        stated.SetValue(size.diameter)
        stated.SetUpperTolValue(size.upper)
        # The kernel takes it as how far below, and writes its negative as the lower bound.
        stated.SetLowerTolValue(-size.lower)
        XCAFDoc_Dimension.Set_s(label).SetObject(stated)
        self._tool.SetDimension(self._labels(size.faces), TDF_LabelSequence(), label)

    def add_zone(self, zone: Zone) -> None:
        """A tolerance of form or place, with its datums in their order."""
        from OCP.XCAFDimTolObjects import (
            XCAFDimTolObjects_GeomToleranceModif,
            XCAFDimTolObjects_GeomToleranceObject,
            XCAFDimTolObjects_GeomToleranceType,
            XCAFDimTolObjects_GeomToleranceTypeValue,
        )
        from OCP.XCAFDoc import XCAFDoc_GeomTolerance

        kinds = XCAFDimTolObjects_GeomToleranceType
        kind = {
            "cylindricity": kinds.XCAFDimTolObjects_GeomToleranceType_Cylindricity,
            "total run-out": kinds.XCAFDimTolObjects_GeomToleranceType_TotalRunout,
            "run-out": kinds.XCAFDimTolObjects_GeomToleranceType_CircularRunout,
            "position": kinds.XCAFDimTolObjects_GeomToleranceType_Position,
            "profile": kinds.XCAFDimTolObjects_GeomToleranceType_ProfileOfLine,
        }[zone.kind]
        label, stated = self._tool.AddGeomTolerance(), XCAFDimTolObjects_GeomToleranceObject()
        stated.SetType(kind)
        stated.SetValue(zone.value)
        if zone.kind == "profile":
            marks = XCAFDimTolObjects_GeomToleranceModif
            stated.AddModifier(marks.XCAFDimTolObjects_GeomToleranceModif_Common_Zone)
        if zone.round:
            forms = XCAFDimTolObjects_GeomToleranceTypeValue
            stated.SetTypeOfValue(forms.XCAFDimTolObjects_GeomToleranceTypeValue_Diameter)
        XCAFDoc_GeomTolerance.Set_s(label).SetObject(stated)
        self._tool.SetGeomTolerance(self._labels(zone.faces), label)
        for place, cell in enumerate(zone.datums, start=1):
            # Those that share a place are a common datum.
            for letter in cell.split("-"):
                self._tool.SetDatumToGeomTol(self._datum(letter, place), label)

    def _datum(self, letter: str, place: int) -> Any:
        """The label of a datum at its place in a frame."""
        from OCP.TCollection import TCollection_HAsciiString
        from OCP.XCAFDimTolObjects import XCAFDimTolObjects_DatumObject
        from OCP.XCAFDoc import XCAFDoc_Datum

        known = self._datums.get((letter, place))
        if known is not None:
            return known
        label, stated = self._tool.AddDatum(), XCAFDimTolObjects_DatumObject()
        stated.SetName(TCollection_HAsciiString(letter))
        stated.SetPosition(place)
        XCAFDoc_Datum.Set_s(label).SetObject(stated)
        self._tool.SetDatum(self._labels(self._faces[letter]), label)
        self._datums[letter, place] = label
        return label

    def _labels(self, faces: Iterable[Any]) -> Any:
        from OCP.TDF import TDF_LabelSequence

        labels = TDF_LabelSequence()
        for face in faces:
            labels.Append(self._shapes.AddSubShape(self._whole, face.wrapped))
        return labels
