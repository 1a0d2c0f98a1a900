"""Calls about the gearbox alone: `tolerance`, `compare` and `inertia`."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

from cqdd_design.errors import UsageError
from cqdd_design.library.calls import of_arguments, road, si_value, text, whole
from cqdd_design.library.inputs import DesignLike, PathLike, design_of, path_of, read_design
from cqdd_design.library.results import Result, Row

if TYPE_CHECKING:
    from cqdd_design.gearbox.tolerance.run import ToleranceResult
    from cqdd_design.planetary.compare import PlanetaryComparison
    from cqdd_design.report.notebook import Section
    from cqdd_design.roads.inertia import InertiaAndBalance
    from cqdd_design.units import Quantity

_MOST_SAMPLES = 10_000_000


@dataclass(frozen=True, eq=False, repr=False)
class Toleranced(Result):
    """What `tolerance` returns; `to_pandas` has a row a gearbox.

    Attributes
    ----------
    found : ToleranceResult
        Values of every gearbox (`columns`), `statistics`, `limits` and `ranking`.
    """

    command: ClassVar[str] = "tolerance"

    found: ToleranceResult

    def _told(self) -> str:
        found = self.found
        return f"{len(found.values)} gearboxes at {found.ensemble.torque:.4g} N*m"

    def _figures(self) -> tuple[str, ...]:
        if not len(self.found.values):
            return ()
        return tuple(
            f"{name}: {of['p50']:.4g} in the middle, {of['p95']:.4g} of 95 %"
            for name, of in self.found.statistics().items()
        )

    def _results(self) -> Mapping[str, Any]:
        return self.found.to_dict()

    def _rows(self) -> Sequence[Row]:
        found = self.found
        columns = {name: values.tolist() for name, values in found.columns.items()}
        return [
            {"gearbox": int(number)} | {name: values[row] for name, values in columns.items()}
            for row, number in enumerate(found.numbers)
        ]

    def _sections(self) -> Sequence[Section]:
        from cqdd_design.report.gearbox.tolerances import tolerance_view
        from cqdd_design.report.notebook import Section

        return (Section("tolerances.html", {"tolerances": tolerance_view(self.found)}),)


@road
def tolerance(
    design: DesignLike,
    *,
    samples: int = 1000,
    angles: int | None = None,
    seed: int = 0,
    torque: Quantity | None = None,
    temperature: Quantity | None = None,
    scheduler: str | None = None,
    motor: str | None = None,
    motor_file: PathLike | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Toleranced:
    """Draw gearboxes from the tolerances of a design, and solve each over a whole output turn.

    Parameters
    ----------
    design : Design or path
        A path is that of a design file; a bare name may be an example's.
    samples : int
        Gearboxes, 1 to 10,000,000.
    angles : int, optional
        Crank angles over the output turn, at least 8; default about 1000, two to eight a tooth.
    seed : int
        Of the draws, 0 to 2^64 - 1. The same seed gives the same gearboxes.
    torque : quantity, optional
        At the output; default the continuous one.
    temperature : quantity, optional
        Of all parts of the gearbox; default 20 deg C, as drawn.
    scheduler : str, optional
        A Dask scheduler to work on, as ``tcp://HOST:8786``; default this machine.
    motor : str, optional
        A motor of the catalogue, as in `load`.
    motor_file : path, optional
        A motor in TOML, as in `load`.
    progress : callable, optional
        Told how many gearboxes are solved, and of how many.

    Returns
    -------
    Toleranced
        `found.columns` holds an array (S,) an output: backlash and transmission error in arcmin,
        forces in N, pressure in MPa, stiffness in N m/arcmin, torques in N m.

    Raises
    ------
    UsageError, DesignError, GeometryError
        As `analyse`; angles that do not fit into memory; no scheduler answers.

    Notes
    -----
    Shares of the variance are Sobol indices; docs/how-to-tolerances.md has the source.

    Examples
    --------
    >>> import cqdd_design as cq
    >>> drawn = cq.tolerance("cqdd-10", samples=8, angles=110)
    >>> backlash = drawn.found.columns["backlash_arcmin"]
    >>> len(backlash), bool((backlash > 0.0).all())
    (8, True)
    """
    from cqdd_design.roads.tolerance import tolerance as draw
    from cqdd_design.units import TEMPERATURE, TORQUE

    file = None if motor_file is None else path_of("motor_file", motor_file)
    if motor is not None:
        text("motor", motor, "CubeMars RO100 KV55")
    loaded, told = read_design(design, motor, file)
    found = draw(
        loaded,
        samples=whole("samples", samples, 1, _MOST_SAMPLES),
        torque=si_value("torque", torque, TORQUE, positive=True),
        angles=None if angles is None else whole("angles", angles, 8),
        seed=whole("seed", seed, 0, 2**64 - 1),
        temperature=si_value("temperature", temperature, TEMPERATURE),
        scheduler=None if scheduler is None else text("scheduler", scheduler, "tcp://HOST:8786"),
        progress=progress,
    )
    return Toleranced(loaded, (*map(of_arguments, told), *found.warnings), found)


@dataclass(frozen=True, eq=False, repr=False)
class Compared(Result):
    """What `compare` returns; `to_pandas` has a row a mesh, load and number of planets.

    Attributes
    ----------
    found : PlanetaryComparison
        Gear set, ratings, how many planets fit, assemble and are needed, the paper's claims.
    """

    command: ClassVar[str] = "compare"

    found: PlanetaryComparison

    def _told(self) -> str:
        return f"beside a compound planetary of {self.found.material.label}"

    def _figures(self) -> tuple[str, ...]:
        found = self.found
        needed = (
            ("for the peak torque's bending", found.needed_peak_bending),
            ("for the peak torque's contact", found.needed_peak_contact),
            ("for the continuous torque's contact", found.needed_continuous_contact),
        )
        return (
            f"planets that fit: {found.planets_that_fit} at most",
            *(
                f"planets needed {words}: {'more than are rated' if count is None else count}"
                for words, count in needed
            ),
        )

    def _results(self) -> Mapping[str, Any]:
        return self.found.to_dict()

    def _rows(self) -> Sequence[Row]:
        rows: Sequence[Row] = self.to_dict()["results"]["planetary"]["by_planets"]
        return rows

    def _sections(self) -> Sequence[Section]:
        from cqdd_design.report.judgement.planetary import planetary_view
        from cqdd_design.report.notebook import Section

        return (Section("planetary.html", {"planetary": planetary_view(self.found)}),)


@road
def compare(
    design: DesignLike,
    *,
    teeth: str | Sequence[int] = (12, 36, 22, 70),
    module: Quantity = "1 mm",
    face_width: Quantity = "12 mm",
    material: str | None = None,
    planets: int | None = None,
    settings: Mapping[str, object] | PathLike | None = None,
) -> Compared:
    """The same loads on a compound planetary, rated by ISO 6336.

    Parameters
    ----------
    design : Design or path
        A path is that of a design file; a bare name may be an example's.
    teeth : sequence of four int
        Of sun, planet at the sun, planet at the ring, ring; or a text with commas between them.
    module, face_width : quantity
        Of both meshes, above zero.
    material : str, optional
        Of the gears; default that of the discs.
    planets : int, optional
        Looked at in detail; default the most that fit.
    settings : mapping or path, optional
        Of the rating: keys such as ``application_factor`` and ``life_hours``, or a TOML file of
        them.

    Returns
    -------
    Compared
        `to_dict()["results"]["planetary"]["by_planets"]`: stresses in MPa and safety factors.

    Raises
    ------
    UsageError
        Teeth that make no gear set, a setting that does not exist or is out of its range.
    CatalogError
        No such material.
    DesignError
        No valid design.

    Notes
    -----
    ISO 6336-1, -2, -3 (2019), -5 (2016); docs/theory.md holds the paper's claims against it.

    Examples
    --------
    >>> import cqdd_design as cq
    >>> beside = cq.compare("cqdd-10", settings={"life_hours": 2000.0})
    >>> beside.found.planets_that_fit
    3
    """
    from cqdd_design.planetary.assembly import MOST_PLANETS
    from cqdd_design.planetary.kinematics import PlanetaryTeeth
    from cqdd_design.planetary.settings import read_settings
    from cqdd_design.roads.compare import compare as rate
    from cqdd_design.units import LENGTH

    counts = _four_counts(teeth)
    if material is not None:
        text("material", material, "AISI 4140 Q&T 540C")
    stated = isinstance(settings, Mapping)
    file = None if settings is None or stated else path_of("settings", settings)
    loaded = design_of(design)
    found = rate(
        loaded,
        teeth=PlanetaryTeeth(*counts),
        module=si_value("module", module, LENGTH, positive=True),
        face_width=si_value("face_width", face_width, LENGTH, positive=True),
        material=material,
        planets=None if planets is None else whole("planets", planets, 1, MOST_PLANETS),
        settings=read_settings(file, settings if isinstance(settings, Mapping) else None),
    )
    return Compared(loaded, found.warnings, found)


def _four_counts(teeth: object) -> tuple[int, ...]:
    """Teeth of sun, planet at the sun, planet at the ring, ring; in a text between commas."""
    told = UsageError(f"teeth {teeth} must be four numbers, such as (12, 36, 22, 70).")
    parts = teeth.split(",") if isinstance(teeth, str) else teeth
    if not isinstance(parts, Iterable):
        raise told
    found = [
        int(part) if isinstance(part, str) and part.strip().isdecimal() else part for part in parts
    ]
    if len(found) != 4:
        raise told
    return tuple(whole("teeth", count, 1) for count in found)


@dataclass(frozen=True, eq=False, repr=False)
class Weighed(Result):
    """What `inertia` returns; `to_pandas` has a row a part.

    Attributes
    ----------
    found : InertiaAndBalance
        Parts and their mass properties (`bodies`), and the balance by number of discs.
    """

    command: ClassVar[str] = "inertia"

    found: InertiaAndBalance

    def _told(self) -> str:
        return f"{len(self.found.bodies.inertia.parts)} kinds of part"

    def _figures(self) -> tuple[str, ...]:
        whole_of = self.found.bodies.inertia
        values = (
            ("mass", whole_of.whole_mass, "kg"),
            ("torque density", self.found.torque_density, "N*m/kg"),
            ("inertia at the input", whole_of.reflected_input, "kg*m^2"),
            ("inertia at the output", whole_of.reflected_output, "kg*m^2"),
        )
        return tuple(
            f"{words}: " + ("not known" if value is None else f"{value:.4g} {unit}")
            for words, value, unit in values
        )

    def _results(self) -> Mapping[str, Any]:
        return self.found.to_dict()

    def _rows(self) -> Sequence[Row]:
        return [
            {key: value for key, value in part.items() if not isinstance(value, list)}
            for part in self.to_dict()["results"]["parts"]
        ]

    def _sections(self) -> Sequence[Section]:
        from cqdd_design.report.gearbox.masses import bodies_view
        from cqdd_design.report.ink.numbers import RPM, with_unit
        from cqdd_design.report.notebook import Section

        design = self.found.machine.design
        speed = with_unit(design.requirements.input_speed * RPM, "rpm")
        return (
            Section(
                "bodies.html",
                {
                    "bodies": bodies_view(design, self.found.bodies),
                    "counterweights": design.reducer.balance.counterweights,
                    "input_speed": speed,
                },
            ),
        )


@road
def inertia(
    design: DesignLike,
    *,
    speed: Quantity | None = None,
    progress: Callable[[str], None] | None = None,
) -> Weighed:
    """Mass properties of every part from its mesh, and the balance of the crank.

    Parameters
    ----------
    design : Design or path
        A path is that of a design file; a bare name may be an example's.
    speed : quantity, optional
        Of the input, for the shaking forces; default that of the requirements.
    progress : callable, optional
        Told in a few words what begins.

    Returns
    -------
    Weighed
        `found.bodies.inertia.parts`: a mass in kg, a centre (3,) in m and an inertia (3, 3) in
        kg m^2 about it, in the axes of the assembly.

    Raises
    ------
    UsageError, DesignError, GeometryError
        As `check`.
    DependencyError
        The CAD kernel or one of its system libraries is missing.

    Notes
    -----
    Solids are meshed and integrated; closed forms stand beside them as `exact_volume_mm3`.

    Examples
    --------
    >>> import cqdd_design as cq
    >>> weighed = cq.inertia("cqdd-10")
    >>> 0.5 < weighed.found.bodies.inertia.mass < 2.0  # kg
    True
    """
    from cqdd_design.roads.inertia import inertia as weigh
    from cqdd_design.roads.telling import silent
    from cqdd_design.units import SPEED

    loaded = design_of(design)
    asked = si_value("speed", speed, SPEED, positive=True)
    found = weigh(loaded, speed=asked, progress=progress or silent)
    return Weighed(loaded, found.warnings, found)
