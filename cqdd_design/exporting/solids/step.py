"""STEP files (AP214 or AP242): the machine with names and colours, every made part by itself.

The kernel stamps its own name and the present time into the header; both are replaced, so that a
file says which design it came from and the same design gives the same bytes.
"""

from __future__ import annotations

import contextlib
import itertools
import re
from collections.abc import Iterator, Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING

from cqdd_design.environment import source_date
from cqdd_design.errors import ReadBackError
from cqdd_design.files import WrittenFile, file_label, write_with
from cqdd_design.version import __version__

if TYPE_CHECKING:
    from cadquery import Assembly

    from cqdd_design.design import Design
    from cqdd_design.exporting.job import ExportJob
    from cqdd_design.solids.part import Colour, Part

_AUTHOR = "cqdd-design"
_SCHEMA_SETTING = "write.step.schema"
_SCHEMAS = {"AP214": "AP214IS", "AP242": "AP242DIS"}
_HEADER = re.compile(rb"FILE_DESCRIPTION\(.*?\);\s*FILE_NAME\(.*?\);", re.DOTALL)
_OCCURRENCE = re.compile(rb"NEXT_ASSEMBLY_USAGE_OCCURRENCE\('[^']*'(.*?)\);", re.DOTALL)
_SOLID = re.compile(rb"#(\d+) = MANIFOLD_SOLID_BREP\(")
_BODY = re.compile(rb"ADVANCED_BREP_SHAPE_REPRESENTATION\('',\((.*?)\),\s*#(\d+)\)", re.DOTALL)
_SIZE = re.compile(rb"#\d+ = PLUS_MINUS_TOLERANCE\(")
_ZONE = re.compile(
    rb"\b(?:CYLINDRICITY|POSITION|CIRCULAR_RUNOUT|TOTAL_RUNOUT|LINE_PROFILE)_TOLERANCE\s*\("
)
_STYLES = re.compile(rb"#\d+ = MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION\(")
_BEYOND_ASCII = re.compile(r"[^\x00-\x7f]")
_COMMON = re.compile(rb"COMMON_DATUM_LIST\((#[^()]*)\)")
_LINE_END = re.compile(rb"\s*\n\s*")


def export_step(job: ExportJob) -> tuple[WrittenFile, ...]:
    """Write ``<name>.step`` and ``<name>-<part>.step`` for every part."""
    schema = job.options.step_schema
    return (
        write_step(job.design, job.parts, job.path(".step"), schema=schema),
        *(
            write_part_step(job.design, part, job.path(f"-{file_label(part.name)}.step"), schema)
            for part in job.parts
        ),
    )


def write_step(
    design: Design,
    parts: Sequence[Part],
    path: Path,
    crank_angle: float = 0.0,
    schema: str = "AP214",
) -> WrittenFile:
    """Write the assembly.

    Parameters
    ----------
    parts : sequence of Part
        From `solids.parts.build_parts`.
    path : Path
        Destination, ending in ``.step``.
    crank_angle : float
        rad.
    schema : {"AP214", "AP242"}

    Returns
    -------
    WrittenFile
        In mm; one product a part, one named and coloured occurrence a piece.

    Raises
    ------
    DependencyError
        When CadQuery is not usable.
    ReadBackError
        When the kernel did not write every part.
    """
    from cqdd_design.solids.assembly import build_assembly

    return _write(build_assembly(design, parts, crank_angle), design, parts, path, schema)


def write_part_step(design: Design, part: Part, path: Path, schema: str = "AP214") -> WrittenFile:
    """Write one part in its own frame; see `write_step`.

    As AP242 with the sizes, tolerances and datums of its features, see `pmi`.
    """
    from cqdd_design.solids.cad import import_cadquery

    cadquery = import_cadquery()
    if schema == "AP242":
        return _write_stated(design, part, path)
    assembly = cadquery.Assembly(name=design.file_name)
    assembly.add(part.solid, name=part.name, color=cadquery.Color(*part.colour, 1.0))
    return _write(assembly, design, [part], path, schema)


def _write_stated(design: Design, part: Part, path: Path) -> WrittenFile:
    from cqdd_design.exporting.solids.pmi import stated_of
    from cqdd_design.exporting.solids.pmi_file import write_stated

    stated = stated_of(part)
    wanted = (1, len(stated.sizes), len(stated.zones))

    def write(place: Path) -> None:
        with _schema("AP242"):
            done = write_stated(part, stated, place)
        content = place.read_bytes() if done else b""
        found = tuple(len(one.findall(content)) for one in (_SOLID, _SIZE, _ZONE))
        if found != wanted or not _HEADER.search(content):
            raise ReadBackError(
                f"{path.name} holds {found[0]} solids with {found[1]} sizes and {found[2]} "
                f"tolerances instead of one with {wanted[1]} and {wanted[2]}; nothing was kept."
            )
        place.write_bytes(_reproducible(_listed(content), design, path.name))

    return write_with(path, "step", write)


def _listed(content: bytes) -> bytes:
    """The file with common datums as Part 21 has typed lists, in brackets of their own.

    A typed parameter holds one parameter, here a list (ISO 10303-21). The kernel leaves its
    brackets out, and other readers stop there.
    """
    return _COMMON.sub(lambda one: b"COMMON_DATUM_LIST((%s))" % one.group(1), content)


def _write(
    assembly: Assembly, design: Design, parts: Sequence[Part], path: Path, schema: str
) -> WrittenFile:
    from cadquery.occ_impl.exporters.assembly import exportAssembly

    def write(place: Path) -> None:
        with _schema(schema):
            done = exportAssembly(assembly, str(place), write_pcurves=False)
        content = place.read_bytes() if done else b""
        written = len(_SOLID.findall(content))
        if written != len(parts) or not _HEADER.search(content):
            raise ReadBackError(
                f"{path.name} holds {written} solids instead of {len(parts)}; nothing was kept."
            )
        content = _coloured(content, [part.colour for part in parts])
        place.write_bytes(_reproducible(content, design, path.name))

    return write_with(path, "step", write)


@contextlib.contextmanager
def _schema(name: str) -> Iterator[None]:
    """The kernel's schema is a setting of the whole process; it is put back afterwards."""
    from OCP.Interface import Interface_Static
    from OCP.STEPCAFControl import STEPCAFControl_Writer

    # The setting exists only once a writer has been made.
    STEPCAFControl_Writer()
    former = Interface_Static.CVal_s(_SCHEMA_SETTING)
    Interface_Static.SetCVal_s(_SCHEMA_SETTING, _SCHEMAS[name])
    try:
        yield
    finally:
        Interface_Static.SetCVal_s(_SCHEMA_SETTING, former)


def _coloured(content: bytes, colours: Sequence[Colour]) -> bytes:
    """The file with its styles written anew, in the order of the solids.

    The kernel writes the same styles at the end of the file, in an order that changes from run to
    run.
    """
    styles = _STYLES.search(content)
    cut = styles.start() if styles else content.rindex(b"ENDSEC;")
    kept = content[:cut]
    solids = _SOLID.findall(kept)
    contexts = {
        item: context
        for items, context in _BODY.findall(kept)
        for item in re.findall(rb"#(\d+)", items)
    }
    numbers = itertools.count(max(int(n) for n in re.findall(rb"^#(\d+) =", kept, re.M)) + 1)
    blocks = []
    for solid, colour in zip(solids, colours, strict=True):
        i = [next(numbers) for _ in range(9)]
        red, green, blue = (f"{value:.6g}" if value % 1.0 else f"{value:.1f}" for value in colour)
        blocks.append(
            f"#{i[0]} = MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION('',(#{i[1]}),"
            f"#{contexts[solid].decode()});\n"
            f"#{i[1]} = STYLED_ITEM('color',(#{i[2]}),#{solid.decode()});\n"
            f"#{i[2]} = PRESENTATION_STYLE_ASSIGNMENT((#{i[3]}));\n"
            f"#{i[3]} = SURFACE_STYLE_USAGE(.BOTH.,#{i[4]});\n"
            f"#{i[4]} = SURFACE_SIDE_STYLE('',(#{i[5]}));\n"
            f"#{i[5]} = SURFACE_STYLE_FILL_AREA(#{i[6]});\n"
            f"#{i[6]} = FILL_AREA_STYLE('',(#{i[7]}));\n"
            f"#{i[7]} = FILL_AREA_STYLE_COLOUR('',#{i[8]});\n"
            f"#{i[8]} = COLOUR_RGB('',{red},{green},{blue});\n"
        )
    return kept + "".join(blocks).encode() + b"ENDSEC;\nEND-ISO-10303-21;\n"


def _reproducible(content: bytes, design: Design, file_name: str) -> bytes:
    """The file with our own header, and occurrences numbered from one.

    The kernel numbers occurrences through the life of the process, and breaks lines after the
    length of the number.
    """
    header = _header(design, file_name).encode()
    content = _HEADER.sub(lambda _: header, content, count=1)
    numbers = itertools.count(1)

    def renumbered(found: re.Match[bytes]) -> bytes:
        rest = _LINE_END.sub(b"", found.group(1))
        return b"NEXT_ASSEMBLY_USAGE_OCCURRENCE('%d'%s);" % (next(numbers), rest)

    content = _OCCURRENCE.sub(renumbered, content)
    return content if content.isascii() else _ascii(_unmangled(content)).encode()


def _unmangled(content: bytes) -> str:
    """Text whose names have gone through UTF-8 twice, as CadQuery 2.8 hands them to the kernel."""
    text = content.decode()
    try:
        return text.encode("latin-1").decode()
    except UnicodeError:
        return text


def _header(design: Design, file_name: str) -> str:
    description = (
        f"cycloidal gearbox {design.file_name}, ratio {design.reducer.ratio}, "
        f"design sha256 {design.sha256}"
    )
    return (
        f"FILE_DESCRIPTION(('{_text(description)}'),'2;1');\n"
        f"FILE_NAME('{_text(file_name)}','{_time_stamp()}',('{_AUTHOR}'),('{_AUTHOR}'),\n"
        f"  'Open CASCADE','{_AUTHOR} {__version__}','');"
    )


def _time_stamp() -> str:
    """Time of SOURCE_DATE_EPOCH, else the epoch itself: never the clock."""
    moment = source_date() or datetime.fromtimestamp(0, UTC)
    return moment.strftime("%Y-%m-%dT%H:%M:%S")


def _text(text: str) -> str:
    """A string as ISO 10303-21 wants it: apostrophes doubled, backslashes too, ASCII only."""
    printable = "".join(c if c >= " " else " " for c in text)
    return _ascii(printable.replace("\\", "\\\\").replace("'", "''"))


def _ascii(text: str) -> str:
    """Text with every other character written by its code point (ISO 10303-21, 6.4.3)."""
    return _BEYOND_ASCII.sub(
        lambda found: (
            f"\\X2\\{ord(found[0]):04X}\\X0\\"
            if ord(found[0]) < 0x10000
            else f"\\X4\\{ord(found[0]):08X}\\X0\\"
        ),
        text,
    )
