"""Calls that give a design: `load` from a file, `size` from requirements."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Literal, cast, get_args

from cqdd_design.errors import UsageError, shown
from cqdd_design.library.calls import of_arguments, one_of, road, si_value, text
from cqdd_design.library.inputs import (
    DesignLike,
    PathLike,
    not_taken_over,
    path_of,
    read_design,
    read_wanted,
    under_duty,
)
from cqdd_design.library.results import Result, Row

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from cqdd_design.design import Design, Requirements
    from cqdd_design.library.asked import Asked
    from cqdd_design.report.notebook import Section
    from cqdd_design.results import Check
    from cqdd_design.roads.size import Road
    from cqdd_design.units import Quantity
    from cqdd_design.verdict import Verdict
    from cqdd_design.verdict.judge import Meets

Goal = Literal["mass", "inertia", "backlash", "efficiency", "size"]
_MOTOR = "CubeMars RO100 KV55"


@road
def load(
    design: DesignLike,
    *,
    motor: str | None = None,
    motor_file: PathLike | None = None,
    duty: PathLike | None = None,
    duty_columns: str | None = None,
) -> Design:
    """Read a design file, or take an example, and give it another motor or duty.

    Parameters
    ----------
    design : path or Design
        Of a design file (TOML). A text without an ending that no file has as its name is the name
        of an example that comes with the package: ``"cqdd-10"``, ``"printed-13"`` or
        ``"reference-s"``.
    motor : str, optional
        A motor of the catalogue, instead of all that the design's ``[motor]`` says of one.
    motor_file : path, optional
        A motor in TOML, over the design's ``[motor]`` and the catalogue.
    duty : path, optional
        A duty over time (CSV) instead of the design's own.
    duty_columns : str, optional
        Of `duty`, where headings do not say: ``"time=t [ms],torque=tau [N*m],speed=dq [deg/s]"``.

    Returns
    -------
    Design
        Frozen; quantities are SI floats under the keys of the file. `Design.replacing` gives one
        with other values, `Design.assumed` the keys that were left to their defaults.

    Raises
    ------
    UsageError
        No such file, example or motor.
    DesignError
        The content is no valid design, motor or duty; one sentence a problem.

    Warns
    -----
    UserWarning
        Where another motor replaces data of the design's own.

    Examples
    --------
    >>> import cqdd_design as cq
    >>> paper = cq.load("cqdd-10")
    >>> paper.reducer.eccentricity  # m
    0.0016
    >>> thicker = paper.replacing({"reducer.disc_thickness": "9 mm"})
    >>> thicker.reducer.disc_thickness
    0.009
    """
    file = None if motor_file is None else path_of("motor_file", motor_file)
    if motor is not None:
        text("motor", motor, _MOTOR)
    if duty_columns is not None:
        text("duty_columns", duty_columns, "time=t [ms],torque=tau [N*m]")
    found, told = read_design(design, motor, file)
    for sentence in told:
        # The caller's line, behind the wrapper of errors.
        warnings.warn(of_arguments(sentence), stacklevel=3)
    return under_duty(found, None if duty is None else path_of("duty", duty), duty_columns)


@dataclass(frozen=True, eq=False, repr=False)
class Sized(Result):
    """What `size` returns; `to_pandas` has a row a design: the first and its alternatives.

    Attributes
    ----------
    found : Road
        The search (`sizing`, with `alternatives` and what was `rejected`) and its verdict.
    """

    command: ClassVar[str] = "size"

    found: Road

    @property
    def verdict(self) -> Verdict | None:
        """On the design; None after the screen alone."""
        return self.found.verdict

    @property
    def checks(self) -> tuple[Check, ...]:
        """Of the verdict; after the screen alone the closed forms'."""
        return self.found.lines

    @property
    def meets(self) -> Meets | None:
        """The verdict's answer; None after the screen alone, which is no verdict."""
        return None if self.found.verdict is None else self.found.verdict.meets

    def _told(self) -> str:
        if self.found.verdict is None:
            return "no verdict, but the screen by closed forms"
        return self._answer(self.checks)

    def _results(self) -> Mapping[str, Any]:
        return self.found.to_dict()

    def _rows(self) -> Sequence[Row]:
        from cqdd_design.sizing.result import SizedDesign

        sizing = self.found.sizing
        first = SizedDesign.to_dict(sizing) | {"name": self.design.name}
        return [first, *(one.to_dict() for one in sizing.alternatives)]

    def _sections(self) -> Sequence[Section]:
        from cqdd_design.report.judgement.search import sizing_view
        from cqdd_design.report.notebook import Section, table

        view = sizing_view(self.found.sizing)
        if self.found.verdict is not None:
            return (Section("sizing.html", {"sizing": view}),)
        # The report's words tell of a search to the verdict.
        head = ("", *(f"#{name}" for name in view["headings"]))
        return (table("Designs of the screen", head, [(name, *of) for name, of in view["rows"]]),)


@road
def size(
    ratio: int | None = None,
    *,
    requirements: Requirements | Mapping[str, Any] | PathLike | None = None,
    motor: str | None = None,
    motor_file: PathLike | None = None,
    ambient: Quantity | None = None,
    objective: Goal = "mass",
    quick: bool = False,
    pick: Literal["b", "c", "d"] | None = None,
    out: PathLike | None = None,
    force: bool = False,
    progress: Callable[[str], None] | None = None,
    **asked: Unpack[Asked],
) -> Sized:
    """Requirements to a design whose verdict is yes; nothing is written unless `out` says where.

    Parameters
    ----------
    ratio : int
        Reduction, 4 to 119: the lobes of a disc. It may stand in `requirements` instead.
    requirements : Requirements, mapping or path, optional
        A file with a table ``[requirements]``, or the values; named arguments replace its keys. Of
        a file its motor is read too; a warning names tables that are not.
    motor : str, optional
        Of the catalogue, or ``"any"``: the first that fits. Default CubeMars RO100 KV55.
    motor_file : path, optional
        A motor in TOML, instead of the catalogue's.
    ambient : quantity, optional
        Of the air round the actuator; default 25 deg C.
    objective : {"mass", "inertia", "backlash", "efficiency", "size"}
        What is made small; losses for efficiency.
    quick : bool
        The screen by closed forms alone: seconds less, and no verdict. Torques that are left out
        are 9 N m times the ratio, 90 N m at most, and 0.38 of that.
    pick : {"b", "c", "d"}, optional
        Take this alternative; it is judged, and taken whatever the verdict is.
    out : path, optional
        Design file to write. Its stem names the design, which is ``sized-N`` otherwise.
    force : bool
        Replace that file where it exists.
    progress : callable, optional
        Told in a few words what begins.
    **asked
        Any other key of ``[requirements]`` (docs/how-to-duty.md), quantities with their unit:
        ``peak_torque="44 N*m"``, ``life="2000 h"``, ``efficiency=0.8``. ``yield_share`` is
        ``yield`` there. Torques that are left out are what motor and gearbox can do, the
        continuous one no more than 0.38 of a peak that is stated.

    Returns
    -------
    Sized
        `design`, `verdict`, `meets`, and `found.sizing` with the alternatives.

    Raises
    ------
    InfeasibleError
        No design meets the requirements; the message names the limits that bind.
    UsageError, DesignError
        A requirement that cannot be read or contradicts another; a file that exists.

    Notes
    -----
    docs/how-to-design.md says how it searches; the limits are those of `check`.

    Examples
    --------
    >>> import cqdd_design as cq
    >>> found = cq.size(10, peak_torque="30 N*m", quick=True)
    >>> found.design.name, found.design.reducer.ratio, found.meets
    ('sized-10', 10, None)
    """
    from cqdd_design.design import Requirements as AskedFor
    from cqdd_design.roads.size import default_path, size_and_write, size_design
    from cqdd_design.roads.telling import silent
    from cqdd_design.units import TEMPERATURE

    goal = cast("Goal", one_of("objective", objective, get_args(Goal)))
    if pick is not None:
        one_of("pick", pick, ("b", "c", "d"))
    if motor is not None:
        text("motor", motor, _MOTOR)
    keys: dict[str, Any] = dict(asked) | ({} if ratio is None else {"ratio": ratio})
    source: Requirements | Path | None = None
    if isinstance(requirements, str) or hasattr(requirements, "__fspath__"):
        source = path_of("requirements", requirements)
        if left := not_taken_over(source):
            warnings.warn(of_arguments(left), stacklevel=3)
    elif isinstance(requirements, Mapping):
        keys = dict(requirements) | keys
    elif isinstance(requirements, AskedFor) or requirements is None:
        source = requirements
    else:
        raise UsageError(
            f"requirements {shown(requirements)} are none: give Requirements, a mapping of their "
            'keys, such as {"ratio": 10}, or the path of a file.'
        )
    wanted = read_wanted(
        {("yield" if key == "yield_share" else key): value for key, value in keys.items()},
        source,
        motor=motor,
        motor_file=None if motor_file is None else path_of("motor_file", motor_file),
    )
    options: dict[str, Any] = {
        "motor": wanted.motor,
        "any_motor": wanted.any_motor,
        "pick": pick or "",
        "ambient": si_value("ambient", ambient, TEMPERATURE),
        "quick": quick,
        "goal": goal,
        "progress": progress or silent,
    }
    if out is None:
        found = size_design(wanted.requirements, default_path(wanted.requirements), **options)
    else:
        place = path_of("out", out)
        found = size_and_write(wanted.requirements, place, force=force, **options)
    return Sized(found.design, found.warnings, found, files=found.files)
