"""The options of ``simulate``: which belong to which load, command and signal; their defaults."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Literal, NamedTuple, cast

from cqdd_design.errors import UsageError
from cqdd_design.library.calls import one_of, si_value

if TYPE_CHECKING:
    from cqdd_design.actuator.scenario import (
        Command,
        CommandMode,
        FrictionModel,
        Load,
        Scenario,
        Signal,
    )
    from cqdd_design.design import Design
    from cqdd_design.units import Dimension

LOADS = ("free", "locked", "inertia", "driven", "pendulum", "wall")
COMMANDS = ("torque", "current", "voltage", "impedance", "position", "open")
SIGNALS = ("constant", "sine", "chirp", "ramp", "file")
FRICTION = ("clip", "lugre")
_ON_ANGLES = ("impedance", "position")
_SWINGING = ("pendulum", "wall")

Sense = Literal["any", "positive", "not negative"]


@dataclass(frozen=True)
class _Rule:
    """An option that belongs to some choices of another: its dimension and defaults by choice."""

    dimension: str
    defaults: Mapping[str, str | None]
    sense: Sense = "positive"


def _same(default: str | None, *choices: str) -> dict[str, str | None]:
    return dict.fromkeys(choices, default)


_BY_LOAD = {
    "--load-inertia": _Rule(
        "INERTIA",
        {"inertia": "0.05 kg*m^2", "pendulum": "0 kg*m^2", "wall": "0 kg*m^2"},
        "not negative",
    ),
    "--load-damping": _Rule(
        "DAMPING_GAIN", _same("0 N*m*s/rad", "inertia", *_SWINGING), "not negative"
    ),
    "--mass": _Rule("MASS", _same("2.28 kg", *_SWINGING)),
    "--arm": _Rule("LENGTH", _same("0.5 m", *_SWINGING)),
    "--wall-angle": _Rule("ANGLE", _same("0.5 rad", "wall"), "any"),
    "--wall-stiffness": _Rule("STIFFNESS_GAIN", _same("2000 N*m/rad", "wall")),
    "--output-speed": _Rule("LOAD_SPEED", _same("1 rad/s", "driven"), "any"),
    "--sensor-stiffness": _Rule("STIFFNESS_GAIN", _same("50000 N*m/rad", "locked")),
    "--start-angle": _Rule("ANGLE", _same("0 rad", "free", "inertia", "driven", *_SWINGING), "any"),
}
_BY_COMMAND = {
    "--position-gain": _Rule("STIFFNESS_GAIN", _same(None, *_ON_ANGLES), "not negative"),
    "--velocity-gain": _Rule("DAMPING_GAIN", _same(None, *_ON_ANGLES), "not negative"),
}
_BY_SIGNAL = {
    "--frequency": _Rule("FREQUENCY", {"sine": "0.8 Hz", "chirp": "0.5 Hz"}),
    "--end-frequency": _Rule("FREQUENCY", {"chirp": "50 Hz"}),
}
_COMMANDED = {
    "torque": "TORQUE",
    "current": "CURRENT",
    "voltage": "VOLTAGE",
    "impedance": "ANGLE",
    "position": "ANGLE",
}


def _dimension(name: str) -> Dimension:
    from cqdd_design import units

    found: Dimension = getattr(units, name)
    return found


class Run(NamedTuple):
    """What is run: SI values, and in `options` what was asked for, defaults included."""

    scenario: Scenario
    duration: float
    rate: float
    step: float | None
    voltage: float | None
    options: Mapping[str, str]
    warnings: tuple[str, ...]


class Choices:
    """The options as typed; what is taken of them, defaults included, is noted in `resolved`."""

    def __init__(self, given: Mapping[str, str | None]) -> None:
        self.given = given
        self.resolved: dict[str, str] = {}
        self.warnings: list[str] = []

    def run(
        self, design: Design, *, load: str, command: str, signal: str | None, friction: str
    ) -> Run:
        """What is run, from the words for load, command, signal and friction.

        Raises
        ------
        UsageError
            For a word or an option that does not belong, with those that do.
        """
        from cqdd_design.actuator.scenario import Scenario, Start

        self.resolved["--friction"] = one_of("--friction", friction, FRICTION)
        carried, start = self.load(load)
        supply = self.quantity("--voltage", "VOLTAGE", None, example="24 V")
        told, seconds = self.command(command, signal, design, supply)
        model = cast("FrictionModel", friction)
        if command in _ON_ANGLES:
            self._tell_too_fast(design.drive.control_rate)
        return Run(
            Scenario(told, carried, Start(output_angle=start), model),
            duration=seconds,
            rate=self.quantity("--rate", "FREQUENCY", "1 kHz") or 0.0,
            step=self.quantity("--step", "TIME", None, example="20 us"),
            voltage=supply,
            options=self.resolved,
            warnings=tuple(self.warnings),
        )

    def _tell_too_fast(self, control_rate: float) -> None:
        """Warn of angles that are commanded faster than a drive at its rate (Hz) can follow."""
        from cqdd_design.units import BANDWIDTH, FREQUENCY, format_quantity, parse_quantity

        for option in _BY_SIGNAL:
            text = self.resolved.get(option)
            if text is not None and parse_quantity(text, FREQUENCY) > 0.5 * control_rate:
                self.warnings.append(
                    f"{option} {text} is above half of the drive's control_rate, "
                    f"{format_quantity(control_rate, BANDWIDTH)}; lower it: no drive follows that."
                )

    def quantity(
        self,
        option: str,
        dimension: str,
        default: str | None,
        sense: Sense = "positive",
        *,
        example: str = "",
        of: str = "",
    ) -> float | None:
        """SI value of an option or its default, None where there is neither."""
        text = self.given.get(option)
        text = default if text is None else text
        value = si_value(option + of, text, _dimension(dimension))
        if value is None or text is None:
            return None
        if sense != "any" and (value < 0.0 or (value == 0.0 and sense == "positive")):
            wrong = "not above zero" if sense == "positive" else "below zero"
            nearest = example or default or _dimension(dimension).example().strip('"')
            raise UsageError(f'{option} {text} is {wrong}; use "{nearest}", for example.')
        self.resolved[option] = text
        return value

    def ruled(self, rules: Mapping[str, _Rule], by: str, choice: str) -> dict[str, float | None]:
        """Values of options that depend on a choice; those that do not belong are refused."""
        found = {}
        for option, rule in rules.items():
            if choice in rule.defaults:
                default = rule.defaults[choice]
                found[option] = self.quantity(option, rule.dimension, default, rule.sense)
            elif self.given.get(option) is not None:
                self.refuse(option, by, choice, tuple(rule.defaults))
        return found

    def refuse(self, option: str, by: str, choice: str, fitting: Sequence[str]) -> None:
        """Refuse an option that was given and does not belong to a choice."""
        if self.given.get(option) is not None:
            others = ", ".join(fitting[:-1])
            fits = f"{others} or {fitting[-1]}" if others else fitting[-1]
            raise UsageError(
                f"{option} does not belong to {by} {choice}; leave it out, or use {by} {fits}."
            )

    def load(self, name: str) -> tuple[Load, float]:
        """The load, and the output's angle at the start, rad."""
        from cqdd_design.actuator.scenario import Constant, Load, Wall

        self.resolved["--load"] = one_of("--load", name, LOADS)
        found = {
            option: 0.0 if value is None else value
            for option, value in self.ruled(_BY_LOAD, "--load", name).items()
        }
        start = found.get("--start-angle", 0.0)
        if name == "free":
            return Load.free(), start
        if name == "locked":
            return Load.locked(found["--sensor-stiffness"]), start
        if name == "driven":
            return Load.driven(Constant(found["--output-speed"])), start
        if name == "inertia":
            return Load.flywheel(found["--load-inertia"], found["--load-damping"]), start
        wall = None
        if name == "wall":
            angle = found["--wall-angle"]
            side = 1 if angle >= 0.0 else -1
            if side * (start - angle) > 0.0:
                raise UsageError(
                    f"--start-angle {self.resolved['--start-angle']} is within the wall at "
                    f"{self.resolved['--wall-angle']}; start nearer to 0, or move the wall away."
                )
            # Linear, so that its stiffness is one of N*m/rad.
            wall = Wall(angle, found["--wall-stiffness"], exponent=1.0, side=side)
        pendulum = Load.pendulum(
            found["--mass"],
            found["--arm"],
            bar_inertia=found["--load-inertia"],
            viscous=found["--load-damping"],
            wall=wall,
        )
        return pendulum, start

    def command(
        self, name: str, signal: str | None, design: Design, supply: float | None
    ) -> tuple[Command, float]:
        """The command, and the duration of the run, s."""
        from cqdd_design.actuator.scenario import Command
        from cqdd_design.units import DAMPING_GAIN, STIFFNESS_GAIN, format_quantity

        self.resolved["--command"] = one_of("--command", name, COMMANDS)
        gains = self.ruled(_BY_COMMAND, "--command", name)
        if name in _ON_ANGLES:
            used = (design.drive.position_gain, design.drive.velocity_gain)
            for option, unit, value in zip(
                gains, (STIFFNESS_GAIN, DAMPING_GAIN), used, strict=True
            ):
                self.resolved.setdefault(option, format_quantity(value, unit))
        if name == "open":
            if signal is not None:
                raise UsageError(
                    "--signal does not belong to --command open, which has none; leave it out, or "
                    "choose another command."
                )
            for option in ("--amplitude", "--offset", *_BY_SIGNAL, "--reference"):
                self.refuse(option, "--command", name, COMMANDS[:-1])
            return Command("open"), self.quantity("--duration", "TIME", "5 s") or 0.0
        given, seconds = self._signal(name, signal or self._implied(), design, supply)
        mode = cast("CommandMode", name)
        position, velocity = gains.get("--position-gain"), gains.get("--velocity-gain")
        return Command(mode, given, position_gain=position, velocity_gain=velocity), seconds

    def _implied(self) -> str:
        """The signal that the options given speak of."""
        for option, signal in (
            ("--reference", "file"),
            ("--end-frequency", "chirp"),
            ("--frequency", "sine"),
        ):
            if self.given.get(option) is not None:
                return signal
        return "constant"

    def _signal(
        self, command: str, name: str, design: Design, supply: float | None
    ) -> tuple[Signal, float]:
        from cqdd_design.actuator.reference import read_reference
        from cqdd_design.actuator.scenario import Chirp, Constant, Ramp, Sine

        self.resolved["--signal"] = one_of("--signal", name, SIGNALS)
        found = self.ruled(_BY_SIGNAL, "--signal", name)
        dimension = _COMMANDED[command]
        path = self.given.get("--reference")
        if name == "file":
            for option in ("--amplitude", "--offset"):
                self.refuse(option, "--signal", name, SIGNALS[:-1])
            if path is None:
                unit = _dimension(dimension)
                raise UsageError(
                    "--signal file needs --reference FILE.csv with the columns "
                    f"time [s],{unit.name} [{unit.unit}]."
                )
            sampled = read_reference(Path(path), _dimension(dimension))
            self.resolved["--reference"] = path
            last = float(sampled.times[-1])
            if last <= 0.0:
                raise UsageError(f"{path} ends at {last:g} s; its times must go beyond 0.")
            seconds = self.quantity("--duration", "TIME", f"{last!r} s") or 0.0
            if seconds > last * (1.0 + 1e-9):
                self.warnings.append(
                    f"{path} ends at {last:g} s; its last value is held from there."
                )
            return sampled, seconds
        self.refuse("--reference", "--signal", name, ("file",))
        seconds = self.quantity("--duration", "TIME", "5 s") or 0.0
        default, of = _amplitude(command, design, supply), f" of --command {command}"
        size = self.quantity("--amplitude", dimension, default, "any", of=of) or 0.0
        if name == "constant":
            if self.given.get("--offset") is not None:
                raise UsageError(
                    "--offset does not belong to --signal constant; give the whole value as "
                    "--amplitude, or choose --signal sine, chirp or ramp."
                )
            return Constant(size), seconds
        zero = f"0 {_dimension(dimension).unit}"
        offset = self.quantity("--offset", dimension, zero, "any", of=of) or 0.0
        first = found.get("--frequency") or 0.0
        if name == "sine":
            return Sine(size, first, offset), seconds
        if name == "ramp":
            return Ramp(offset, size / seconds), seconds
        last = found["--end-frequency"] or 0.0
        if last <= first:
            raise UsageError(
                f"--end-frequency {self.resolved['--end-frequency']} is not above --frequency "
                f"{self.resolved['--frequency']}; a chirp rises: exchange them, or use --signal "
                "sine."
            )
        return Chirp(size, first, last, seconds, offset), seconds


def _amplitude(command: str, design: Design, supply: float | None) -> str:
    """The default of ``--amplitude`` as a unit string."""
    from cqdd_design.units import CURRENT, TORQUE, VOLTAGE, format_quantity

    if command == "torque":
        return format_quantity(design.requirements.continuous_torque, TORQUE)
    if command == "current":
        return format_quantity(0.25 * design.motor.current_limit, CURRENT)
    if command == "voltage":
        return format_quantity(0.5 * (supply or design.motor.voltage), VOLTAGE)
    return "0.5 rad"
