"""The gallery: designs with picture, verdict and files, as the code judges them now.

    python docs/gallery.py [NAME ...]     size those of `gallery/` anew, half a minute each

`docs/build.py` judges every design and writes `gallery.md` and the pictures; files of the designs
are exported when the site is built.
"""

from __future__ import annotations

import shlex
import subprocess
import sys
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from cqdd_design.report.ink.numbers import pretty_unit

if TYPE_CHECKING:
    from cqdd_design.library.judging import Checked

DOCS = Path(__file__).resolve().parent
FILES = DOCS / "gallery" / "files"
KINDS = "dxf,bom"
"""What the site has of every design: light files that every maker needs."""


@dataclass(frozen=True)
class Shown:
    """A design of the gallery.

    Attributes
    ----------
    name : str
        Of its file.
    title : str
        Heading.
    told : str
        What it is for, in a sentence or two.
    asked : str
        Options of `size` that made it; empty for a design that comes with the package.
    """

    name: str
    title: str
    told: str
    asked: str = ""

    @property
    def path(self) -> Path:
        """Of its file."""
        return (DOCS / "gallery" if self.asked else DOCS.parent / "designs") / f"{self.name}.toml"

    @property
    def command(self) -> str:
        """By which it was sized."""
        return f"cqdd-design size {self.asked} --out {self.name}.toml"

    def judged(self) -> Checked:
        """Its verdict, found once."""
        return _judged(self.path)


DESIGNS = (
    Shown(
        "plain-10",
        "Ten to one, and nothing else said",
        "A ratio alone: asked for is what the motor can do through such a gearbox.",
        "--ratio 10",
    ),
    Shown(
        "knee-8",
        "A knee of a light quadruped",
        "Shocks and short peaks, and little torque for long: the example of the how-to pages.",
        '--ratio 8 --peak-torque "40 N*m" --continuous-torque "5 N*m" --continuous-speed "300 rpm"',
    ),
    Shown(
        "efficient-10",
        "Little loss",
        "Sized for small losses: hardened pins under sleeves that roll on needles.",
        '--ratio 10 --peak-torque "30 N*m" --continuous-torque "5 N*m" '
        '--continuous-speed "300 rpm" --objective efficiency',
    ),
    Shown(
        "three-discs-9",
        "Three discs",
        "An odd ratio with three discs, as the paper's rule has it; more discs share the load.",
        '--ratio 9 --discs 3 --peak-torque "28 N*m" --continuous-torque "5 N*m" '
        '--continuous-speed "300 rpm"',
    ),
    Shown(
        "wrist-15",
        "A wrist, with whatever motor fits",
        "A ring of 56 mm at most, and the motor looked for in the catalogue.",
        '--ratio 15 --motor any --outer-diameter "56 mm" --peak-torque "8 N*m" '
        '--continuous-torque "1.5 N*m" --continuous-speed "600 rpm"',
    ),
    Shown(
        "cqdd-10",
        "The actuator of the paper",
        "As far as the paper says what it is; its file says what is assumed. It does not meet what "
        "the paper asks of it.",
    ),
    Shown(
        "printed-13",
        "A printed actuator",
        "Disc, ring and housing of a plastic with carbon fibres, as a thesis built and measured "
        "it.",
    ),
    Shown(
        "reference-s",
        "The reference of the contact model",
        "One design with round numbers, by which the [contact model](contact-model.md) is compared "
        "with other solvers. It was not sized to pass.",
    ),
)

_WORDS = {"pass": "pass", "warn": "warn", "fail": "fail", "unknown": "are unknown"}


@cache
def _judged(path: Path) -> Checked:
    import cqdd_design as cq

    return cq.check(path)


def picture(shown: Shown) -> str:
    """Its front view as a file."""
    from figures.sheet import sheet

    from cqdd_design.machine import resolve
    from cqdd_design.report.drawings.front_view import front_view
    from cqdd_design.report.notebook import outlines_of

    return sheet(front_view(outlines_of(resolve(shown.judged().design))))


def page() -> str:
    """gallery.md."""
    answers = [(one, one.judged().meets) for one in DESIGNS]
    rows = "\n".join(
        f"| [{one.name}](#{_anchor(one.title)}) | {meets} | {one.judged().design.reducer.ratio} "
        f"| {1e3 * one.judged().design.reducer.ring.outer_diameter:g} mm "
        f"| {one.judged().design.reducer.disc_count} | {one.judged().design.motor.name} |"
        for one, meets in answers
    )
    head = (
        "# Gallery\n\n"
        "Designs to begin from, each judged by `cqdd-design check` when this page is built. Those "
        "that fail are here for what they teach. Every picture is the front view at crank angle 0, "
        "from the contours that are cut.\n\n"
        "| design | meets all | ratio | ring | discs | motor |\n"
        "|---|---|---|---|---|---|\n"
    )
    return head + rows + "\n\n" + "\n".join(_entry(one) for one in DESIGNS)


def _anchor(title: str) -> str:
    """What Markdown makes of a heading."""
    return "".join(c for c in title.lower().replace(" ", "-") if c.isalnum() or c == "-")


def _entry(shown: Shown) -> str:
    """A design of the page."""
    judged = shown.judged()
    figures = [
        f"| {one.title} | {_value(one.value, one.unit)} | {_value(one.required, one.unit)} "
        f"| {pretty_unit(one.unit)} | {one.status} |"
        for one in judged.verdict.headline
    ]
    statuses = [one.status for one in judged.checks]
    told = ", ".join(
        f"{statuses.count(kind)} {word}" for kind, word in _WORDS.items() if kind in statuses
    )
    binds = ", ".join(f"`{one.id}`" for one in judged.verdict.limits[:4])
    answer = {"yes": "meets", "no": "does not meet", "unknown": "is not known to meet"}
    file = f"[design file]({'gallery' if shown.asked else '../designs'}/{shown.name}.toml)"
    made = f"```text\n{shown.command}\n```\n\n" if shown.asked else ""
    return "\n".join(
        [
            f"## {shown.title}\n",
            f"{shown.told}\n",
            f"{made}![Front view of {shown.name}](images/gallery-{shown.name}.svg)\n",
            f"`{shown.name}` **{answer[judged.meets]}** its requirements: of {len(statuses)} lines "
            f"{told}. Closest to their limits or beyond: {binds}.\n",
            "| figure | value | asked | unit | status |\n|---|---|---|---|---|",
            *figures,
            f"\nFiles: {file}\n",
        ]
    )


def _value(value: float | None, unit: str) -> str:
    from cqdd_design.terms import hardly

    if value is None:
        return "\u2013"
    return hardly(value, unit) or (f"{value:.3g}" if value < 1000 else f"{value:.0f}")


def main() -> None:
    """Size designs anew."""
    names = sys.argv[1:]
    for one in DESIGNS:
        if one.asked and (not names or one.name in names):
            command = [sys.executable, "-m", *shlex.split(one.command.replace("-", "_", 1))]
            subprocess.run([*command, "--force"], cwd=DOCS / "gallery", check=True)


if __name__ == "__main__":
    main()
