"""What the checks of what keeps its place mean."""

from __future__ import annotations

from cqdd_design.gearbox.checks import allowables as limits
from cqdd_design.gearbox.checks.guide_row import HOUSE, CheckGuide

ROWS = (
    CheckGuide(
        "RETENTION-HELD",
        "Parts that nothing holds along the axis",
        "",
        "max",
        "number of parts and directions from which no way of faces, threads, press fits and bonds "
        "leads to the housing = 0",
        "What can wander along the axis does: it rubs on what turns, or leaves its seat.",
        "the parts as drawn, cqdd_design.solids.retention",
    ),
    CheckGuide(
        "RETENTION-SHOULDER",
        "Lowest shoulder beside a bearing, over the bearing's chamfer",
        "",
        "min",
        "width of the face on a ring, at the limit of its diameter and with its edge broken, / "
        "its least chamfer (catalogue; ISO 15) >= largest chamfer (ISO 582) / least",
        "A shoulder lower than the chamfer of the ring's edge does not hold it at all, and a maker "
        "may make that chamfer twice the least; the shop may make the shoulder smaller and break "
        "its edge.",
        "ISO 15:2017, ISO 582:1995 table 1 (chamfers of the rings)",
    ),
    CheckGuide(
        "RETENTION-AXIAL-PLAY",
        "Least axial play that shims and lengths leave",
        "mm",
        "min",
        "play of shaft, output bearing and discs, lengths of the parts at their worst limits, "
        "shims chosen from their set, from the coldest start to settled temperatures >= 0; "
        "negative too where the thickest pack falls short; a pack that clamps crossed rollers has "
        "but to be thick enough",
        "Bearings that are pressed along the axis run hot and fail; play that no shim takes up "
        "lets shaft and output knock.",
        "the parts as drawn, cqdd_design.solids.axial; ISO 492, ISO 2768-1, DIN 988",
    ),
    CheckGuide(
        "RETENTION-WALL",
        "Thinnest wall of made parts between holes, and to their rims",
        "mm",
        "min",
        "distance of two holes less their radii >= "
        f"{1e3 * limits.LEAST_WALL_BETWEEN_HOLES:g} mm; discs and ring have checks of their own",
        "Thinner walls tear or bulge when they are drilled and tapped.",
        f"the parts as drawn, cqdd_design.solids.walls; {HOUSE}",
        severity="warn",
    ),
)
