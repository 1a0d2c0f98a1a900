"""The call that runs the actuator in time: `simulate`."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, Literal

from cqdd_design.errors import UsageError, did_you_mean
from cqdd_design.library.actuators import CalibrationLike, specimen_given
from cqdd_design.library.asked import AskedOfScenario
from cqdd_design.library.calls import of_arguments, road, whole
from cqdd_design.library.inputs import DesignLike, PathLike, design_of, path_of
from cqdd_design.library.results import Result, frame

if TYPE_CHECKING:
    import pandas
    from typing_extensions import Unpack

    from cqdd_design.actuator.recording import Recording
    from cqdd_design.report.notebook import Section
    from cqdd_design.units import Quantity

_MOST_SAMPLES = 10_000


@dataclass(frozen=True, eq=False, repr=False)
class Simulated(Result):
    """What `simulate` returns; `to_pandas` has a row an instant, columns with their unit.

    Attributes
    ----------
    found : Recording
        `columns` by name and unit, arrays (S T,); the scenario; the energy's balance.
    """

    command: ClassVar[str] = "simulate"

    found: Recording

    def _told(self) -> str:
        found = self.found
        drawn = f"{len(found.seeds)} drawn gearboxes" if found.seeds else "perfect parts"
        asked = f"{found.options['--load']} load, {found.options['--command']} command"
        return f"{asked}, {drawn}, {len(found.simulation.time)} records at {found.rate:.4g} Hz"

    def _figures(self) -> tuple[str, ...]:
        every = self.found.summary()
        return tuple(
            f"{key}: {min(one[key] for one in every):.4g} to {max(one[key] for one in every):.4g}"
            if len(every) > 1
            else f"{key}: {every[0][key]:.4g}"
            for key in every[0]
        )

    def _results(self) -> Mapping[str, Any]:
        return self.found.to_dict()

    def to_pandas(self) -> pandas.DataFrame:
        """The record: a row an instant, the unit in every column's name."""
        return frame(self.found.columns())

    def _sections(self) -> Sequence[Section]:
        from cqdd_design.actuator.columns import SUMMARY
        from cqdd_design.report.ink.numbers import pretty_unit, significant
        from cqdd_design.report.notebook import table

        every = self.found.summary()
        several = len(every) > 1

        def cells(values: list[float]) -> list[str]:
            return [significant(v) for v in ((min(values), max(values)) if several else values)]

        rows = [
            (words, *cells([one[key] for one in every]), pretty_unit(unit))
            for key, words, unit in SUMMARY
        ]
        values = ("#Least", "#Most") if several else ("#Value",)
        return (table("The record", ("Figure", *values, "Unit"), rows),)


@road
def simulate(
    design: DesignLike,
    *,
    load: Literal["free", "locked", "inertia", "driven", "pendulum", "wall"] = "free",
    command: Literal["torque", "current", "voltage", "impedance", "position", "open"] = "torque",
    signal: Literal["constant", "sine", "chirp", "ramp", "file"] | None = None,
    duration: Quantity | None = None,
    rate: Quantity | None = None,
    step: Quantity | None = None,
    voltage: Quantity | None = None,
    friction: Literal["clip", "lugre"] = "clip",
    seed: int | None = None,
    samples: int | None = None,
    calibration: CalibrationLike | None = None,
    out: PathLike | None = None,
    force: bool = False,
    progress: Callable[[int, int], None] | None = None,
    **asked: Unpack[AskedOfScenario],
) -> Simulated:
    """Run the actuator in time; nothing is written unless `out` says where.

    Parameters
    ----------
    design : Design or path
        A path is that of a design file; a bare name may be an example's.
    load : {"free", "locked", "inertia", "driven", "pendulum", "wall"}
        What the output carries.
    command : {"torque", "current", "voltage", "impedance", "position", "open"}
        What the drive is told; ``"open"``: no current.
    signal : {"constant", "sine", "chirp", "ramp", "file"}, optional
        Of the command over time; default what the other arguments say, or constant.
    duration : quantity, optional
        Default 5 s; of a reference file, its last time.
    rate : quantity, optional
        Of the record; default 1 kHz.
    step : quantity, optional
        Default one that the stiffness surely stands.
    voltage : quantity, optional
        Supply; default that of the design.
    friction : {"clip", "lugre"}
        Model of dry friction.
    seed : int, optional
        Draw the gearbox from the tolerances; default perfect parts.
    samples : int, optional
        Gearboxes to draw, 1 to 10,000, with seeds from `seed` (default 0) on.
    calibration : path or Calibrated, optional
        Fitted factors to apply.
    out : path, optional
        ``.npz`` or ``.parquet`` to write.
    force : bool
        Replace that file.
    progress : callable, optional
        Told how many gearboxes are solved, and of how many.
    **asked
        What belongs to the load, command or signal, with the names of the command's options:
        ``mass="2 kg"`` and ``arm="0.3 m"`` of a pendulum, ``amplitude="20 N*m"``,
        ``frequency="1 Hz"`` of a sine, ``reference="knee.csv"`` of a file.

    Returns
    -------
    Simulated
        `found.columns()`: arrays (T,), or (S T,) of S gearboxes, SI with the unit in the name.

    Raises
    ------
    UsageError
        An argument that does not belong to load, command or signal; a quantity that cannot be
        read; more than memory holds.
    DesignError
        No valid design, or one that makes no actuator.

    Notes
    -----
    Equations and integrator: docs/actuator-model.md.

    Examples
    --------
    >>> import cqdd_design as cq
    >>> run = cq.simulate("cqdd-10", load="inertia", amplitude="2 N*m", duration="50 ms")
    >>> sorted(run.found.columns())[:2]
    ['commanded_torque [N m]', 'current [A]']
    """
    from cqdd_design.library.scenario_words import Choices
    from cqdd_design.roads.simulate import simulate as run
    from cqdd_design.roads.simulate import simulation_kind, write_simulation
    from cqdd_design.units import unit_string

    unknown = set(asked) - set(AskedOfScenario.__annotations__)
    if unknown:
        name = min(unknown)
        hint = did_you_mean(name, AskedOfScenario.__annotations__) or "."
        raise UsageError(
            f"simulate has no argument {name}{hint} Besides its own it takes "
            f"{', '.join(AskedOfScenario.__annotations__)}."
        )
    given: dict[str, Any] = {
        **asked,
        "duration": duration,
        "rate": rate,
        "step": step,
        "voltage": voltage,
    }
    words = Choices(
        {
            f"--{name.replace('_', '-')}": None if value is None else unit_string(value)
            for name, value in given.items()
        }
    )
    target = None if out is None else path_of("out", out)
    simulation_kind(target, force=force)
    loaded = design_of(design)
    wanted = words.run(loaded, load=load, command=command, signal=signal, friction=friction)
    specimen, told = specimen_given(loaded, seed, calibration)
    found = run(
        loaded,
        wanted.scenario,
        specimen,
        duration=wanted.duration,
        rate=wanted.rate,
        step=wanted.step,
        voltage=wanted.voltage,
        samples=None if samples is None else whole("samples", samples, 1, _MOST_SAMPLES),
        options=wanted.options,
        progress=progress,
    )
    files = (
        () if target is None else (write_simulation(found, loaded.file_name, target, force=force),)
    )
    warnings = (*map(of_arguments, wanted.warnings), *told, *found.warnings)
    return Simulated(loaded, warnings, found, files=files)
