"""What `outputs.py` runs: designs and commands.

The designs vary together: ten cover rings (solid, conjugate, pinwheel), one to three discs, pins
plain, in sleeves and on needles, both supports, counterweights, a bearing left to the package,
another motor, a duty, and two designs that ``size`` makes in the run. Dear commands run in one form
(JSON or text) on most designs; variants of options run on one.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from outputs_inputs import BAD

SIZED = {"sized-7": ("--ratio", "7"), "sized-20": ("--ratio", "20")}
"""Designs that ``size`` makes in the run, with its options."""
WRITTEN = (
    *("conjugate", "pinwheel", "one-disc", "three-discs", "sleeved", "rolling", "small-motor"),
    "columns",
)
"""Designs of ``tools/outputs_designs``."""
TEXT = ("paper", "three-discs")
"""Designs of which the dear commands are also shown as text."""


@dataclass(frozen=True)
class Step:
    """One run of the command line; in `arguments`, DESIGN stands for the job's design file."""

    name: str
    arguments: tuple[str, ...]


@dataclass(frozen=True)
class Job:
    """Steps that run one after another in one folder.

    Attributes
    ----------
    command : str
        By which ``--only`` chooses; every step's name begins with it.
    steps : tuple of Step
    design : str
        Name of the design; "" for none, or for several.
    beside : tuple of str
        Further designs in the folder.
    networks : tuple of str
        Committed torque networks in the folder.
    """

    command: str
    steps: tuple[Step, ...]
    design: str = ""
    beside: tuple[str, ...] = ()
    networks: tuple[str, ...] = ()

    @property
    def needs(self) -> tuple[str, ...]:
        """Designs that lie in the folder."""
        return ((self.design,) if self.design else ()) + self.beside


KINDS = {
    "shop": "dxf,edm,gcode,svg,bom",
    "solids": "step,stl,3mf,glb",
    "simulators": "mjcf,urdf,card,bam",
}
COLLECTIONS = ("materials", "motors", "bearings", "screws", "fits")
CHECKS = """
GEO-K1-LEAST GEO-K1-MOST GEO-UNDERCUT GEO-TOOTH-OVERLAP GEO-RING-WALL GEO-LIGAMENT-HOLES
GEO-LIGAMENT-PROFILE GEO-LIGAMENT-BORE GEO-LIGAMENT-RIM GEO-LIGAMENT-COLUMN GEO-SLEEVE-WALL
FIT-PIN-HOLE SPACE-DIAMETER SPACE-LENGTH CONTACT-RING-PEAK CONTACT-RING-CONTINUOUS CONTACT-PIN-PEAK
CONTACT-PIN-CONTINUOUS PIN-PAPER PIN-SHARED PIN-SHEAR-PEAK PIN-BENDING-PEAK PIN-BENDING-CONTINUOUS
PIN-BEARING-PEAK BEARING-STATIC BEARING-LIFE BEARING-WIDTH BEARING-CORE BEARING-RACEWAY
BALANCE-STATIC BALANCE-COUPLE DISC-COUNT EDM-DISC EDM-HOLE EDM-RING MOTOR-PEAK MOTOR-CONTINUOUS
MOTOR-SPEED MOTOR-BORE ASSEMBLY-CLEAR
"""
COMMANDS = """
size check analyse bench calibrate simulate tolerance compare inertia export report catalog schema
doctor explain
"""
TORQUE_COMMANDS = ("generate", "import", "train", "evaluate", "export")

WARMING = Job(
    "warming",
    (
        Step("warming-analyse", ("analyse", "DESIGN", "--angles", "8")),
        Step("warming-simulate", ("simulate", "DESIGN", "--duration", "0.01 s")),
    ),
    "paper",
)
"""Compiles the kernels, so that jobs beside each other do not each compile them."""


def design_names() -> tuple[str, ...]:
    """Every design."""
    return ("paper", *SIZED, *WRITTEN)


def written_design(repository: Path, name: str) -> str:
    """The text of a design that is not sized in the run."""
    if name == "paper":
        return (repository / "designs" / "cqdd-10.toml").read_text("utf-8")
    return (repository / "tools" / "outputs_designs" / f"{name}.toml").read_text("utf-8")


def _one(design: str, name: str, *arguments: str) -> Job:
    """A job of one command, which is the first of `arguments` and begins `name`."""
    return Job(arguments[0], (Step(name, arguments),), design)


def _both(design: str, name: str, *arguments: str) -> list[Job]:
    """A command as JSON and as text."""
    return [
        _one(design, f"{name}-json", *arguments, "--json"),
        _one(design, f"{name}-text", *arguments),
    ]


def _steps(design: str, command: str, *rows: tuple[str, str]) -> Job:
    """A job of several commands, each a name and its line; arguments are parted by ``|``."""
    steps = tuple(Step(f"{command}-{name}", tuple(line.split("|"))) for name, line in rows)
    return Job(command, steps, design)


def _dear_jobs() -> list[Job]:
    """What takes long on each design: reports, benches, solids."""
    jobs = []
    for design in design_names():
        form = ("--json",) if design not in TEXT else ()
        jobs.append(_one(design, "report", "report", "DESIGN", *form))
    jobs += [
        _one("paper", "calibrate-json", "calibrate", "DESIGN", "--json"),
        _one("paper", "check-assembly", "check", "DESIGN", "--assembly", "--angles", "2", "--json"),
        _one("one-disc", "check-assembly", "check", "DESIGN", "--assembly", "--angles", "1"),
        _one(
            "pinwheel", "check-assembly", "check", "DESIGN", "--assembly", "--angles", "1", "--json"
        ),
        _torque_road(),
        _one("sized-7", "size-all", "size", "--ratio", "7", "--report", "--export", "dxf,gcode"),
    ]
    for design in design_names():
        for kind, kinds in KINDS.items():
            jobs.append(_one(design, f"export-{kind}", "export", "DESIGN", "--to", kinds, "--json"))
        jobs.append(_one(design, "bench-json", "bench", "DESIGN", "--json"))
        jobs.append(_one(design, "inertia-json", "inertia", "DESIGN", "--json"))
        if design in TEXT:
            jobs.append(_one(design, "bench-text", "bench", "DESIGN"))
            jobs.append(_one(design, "inertia-text", "inertia", "DESIGN"))
    return jobs


def _cheap_jobs() -> list[Job]:
    """What takes seconds on each design."""
    jobs = []
    for design in design_names():
        jobs += _both(design, "analyse", "analyse", "DESIGN", "--angles", "90")
        jobs += _both(design, "tolerance", "tolerance", "DESIGN", "--samples", "16")
        jobs += _both(design, "check", "check", "DESIGN")
        jobs += _both(design, "compare", "compare", "DESIGN")
        jobs += [
            _one(design, "simulate-swing", *_sine(0.2), "--load", "pendulum", "--json"),
            _one(design, "simulate-drawn", *_sine(0.1), "--load", "inertia", "--seed", "3"),
        ]
    return jobs


def _sine(seconds: float) -> tuple[str, ...]:
    swing = ("--signal", "sine", "--frequency", "10 Hz", "--amplitude", "5 N*m")
    return ("simulate", "DESIGN", *swing, "--duration", f"{seconds} s")


def _variants() -> list[Job]:
    """Options, each on one design."""
    several = ("designs/sized-7.toml", "designs/sleeved.toml")
    return [
        *_both("sized-20", "size", "size", "--ratio", "20"),
        _steps(
            "",
            "size",
            ("too-much", "size|--ratio|12"),
            ("too-much-json", "size|--ratio|9|--discs|1|--json"),
            ("discs", "size|--ratio|12|--discs|3|--peak-torque|60 N*m|--length|30 mm|--json"),
            ("motor", "size|--ratio|8|--motor|CubeMars R100 KV90|--outer-diameter|74 mm|--json"),
            ("file", "size|--requirements|requirements.toml|--input-speed|900 rpm|--json"),
            ("again", "size|--ratio|9|--peak-torque|30 N*m|--export|bom"),
        ),
        _steps(
            "paper",
            "analyse",
            ("torque", "analyse|DESIGN|--angles|40|--torque|15 N*m|--speed|300 rpm|--json"),
            ("johnson", "analyse|DESIGN|--angles|40|--contact-law|johnson"),
            ("linear", "analyse|DESIGN|--angles|40|--contact-law|linear|--json"),
        ),
        _steps(
            "sleeved",
            "tolerance",
            ("shares", "tolerance|DESIGN|--samples|128|--angles|48|--seed|5|--torque|9 N*m|--json"),
            ("shares-text", "tolerance|DESIGN|--samples|128|--angles|48"),
        ),
        _steps(
            "paper",
            "compare",
            ("teeth", "compare|DESIGN|--teeth|15,30,20,65|--module|0.8 mm|--face-width|10 mm"),
            ("planets", "compare|DESIGN|--planets|3|--material|17-4PH H900|--json"),
        ),
        _steps(
            "conjugate",
            "calibrate",
            (
                "rig",
                "calibrate|DESIGN|--measured|measured.csv|--to|backdrive_static"
                "|--unknowns|motor_cogging|--out|cal.json|--json",
            ),
            ("then-bench", "bench|DESIGN|--calibration|cal.json|--only|no_load_speed|--json"),
            ("then-simulate", "simulate|DESIGN|--calibration|cal.json|--duration|0.1 s|--json"),
            ("then-export", "export|DESIGN|--calibration|cal.json|--to|card,urdf"),
        ),
        _steps(
            "sized-20",
            "bench",
            ("traces", "bench|DESIGN|--only|backlash,torque_ripple,no_load_speed|--out|t|--json"),
            ("drawn", "bench|DESIGN|--only|backlash,torque_ripple|--seed|4|--json"),
            ("motor", "bench|DESIGN|--only|no_load_speed,peak_torque|--motor-file|motor.toml"),
            ("beside", "bench|DESIGN|--only|mass|--beside|RobStride RS03;Damiao J10010|--json"),
            ("voltage", "bench|DESIGN|--only|no_load_speed,stall_torque|--voltage|36 V|--json"),
        ),
        _simulations(),
        _exports(),
        _one("sleeved", "inertia-speed", "inertia", "DESIGN", "--speed", "3000 rpm", "--json"),
        Job(
            "export",
            (
                Step(
                    "export-several",
                    ("export", *several, "--to", "dxf,bom", "--json"),
                ),
            ),
            beside=("sized-7", "sleeved"),
        ),
    ]


def _simulations() -> Job:
    """Loads, commands, signals and models of friction, each once."""
    short = "|--duration|0.1 s"
    lines = {
        "free": f"--command|voltage{short}",
        "locked": f"--load|locked|--signal|ramp{short}|--json",
        "driven": f"--load|driven|--command|open|--output-speed|2 rad/s{short}|--json",
        "wall": f"--load|wall|--command|impedance|--signal|sine|--start-angle|20 deg{short}",
        "position": f"--load|inertia|--command|position|--load-inertia|0.1 kg*m^2{short}|--json",
        "chirp": f"--load|inertia|--command|current|--signal|chirp{short}|--json",
        "file": "--reference|reference.csv|--load|inertia|--json",
        "samples": f"--samples|3|--seed|7|--load|inertia{short}|--json",
        "lugre": f"--friction|lugre|--load|inertia|--signal|sine{short}|--json",
        "motor": f"--motor-file|motor.toml|--voltage|24 V{short}|--json",
        "parquet": f"--out|trace.parquet|--rate|500 Hz{short}",
        "wrong": "--load|locked|--start-angle|1 rad",
    }
    return _steps("paper", "simulate", *((k, f"simulate|DESIGN|{v}") for k, v in lines.items()))


def _exports() -> Job:
    """Dialects, protocols, and what simulators take."""
    lines = {
        "r12": "--to|dxf,edm|--dxf-version|R12|--out|r12",
        "r2010": "--to|dxf|--dxf-version|R2010|--dxf-style|entities|--out|r2010",
        "entities": "--to|dxf,edm|--dxf-style|entities|--out|entities|--json",
        "ap242": "--to|step|--step-schema|AP242|--out|ap242",
        "tab": "--to|gcode|--tab-length|5 mm|--out|tab|--json",
        "drawn": "--to|mjcf,card,bam|--seed|2|--out|drawn|--json",
        "motor": "--to|mjcf,urdf,card,bam|--motor-file|motor.toml|--out|motor|--json",
        "again": "--to|bom|--out|tab",
        "exists": "--to|gcode|--out|tab",
        "forced": "--to|gcode|--out|tab|--force",
        "default": "--json",
    }
    return _steps("paper", "export", *((k, f"export|DESIGN|{v}") for k, v in lines.items()))


def _torque_road() -> Job:
    """Data, training, scores, files and logs, all as small as they can be.

    Scores and files are of committed networks: one trained here tells how long that took.
    """
    train = "train|--data|data|--device|cpu|--epochs|2|--stride|8"
    gains = "--position-gain|60 N*m/rad|--velocity-gain|2 N*m*s/rad"
    columns = "--columns|time=t,position=q,target=q_des,velocity=dq,torque=tau"
    networks = ("mlp-0", "pva-gru-0", "physics-phase-gru-0", "streaming/pva-gru-0")
    mlp, window, physics, streaming = (f"networks/{name}.npz" for name in networks)
    lines = {
        "generate": "generate|DESIGN|--out|data|--episodes|12|--seconds|2|--unit-gearboxes|1"
        "|--json",
        "generate-text": "generate|DESIGN|--out|few|--episodes|4|--seconds|1",
        "train-mlp": f"{train}|--model|mlp-baseline|--out|mlp.npz|--json",
        "train-gru": f"{train}|--model|pva-gru|--mode|streaming|--out|gru.npz",
        "train-physics": f"{train}|--model|physics-phase-gru|--design|DESIGN|--out|p.npz|--json",
        "evaluate": f"evaluate|--data|data|--model|{mlp}|--model|{window}|--model|{physics}"
        "|--draws|100|--rollouts|1|--report|torque.html|--markdown|torque.md|--json",
        "evaluate-text": "evaluate|--data|data|--model|mlp.npz|--set|gearbox|--draws|100"
        "|--rollouts|0",
        "export-mlp": f"export|{mlp}|--to|onnx,mjlab,c|--json",
        "export-window": f"export|{window}|--to|onnx,torchscript-isaaclab,newton,mjlab,c|--json",
        "export-streaming": f"export|{streaming}|--to|onnx,torchscript-isaaclab,newton,c"
        "|--out|streaming",
        "export-physics": f"export|{physics}|--to|c|--json",
        "export-refused": f"export|{streaming}|--to|onnx,mjlab|--out|refused|--json",
        "import": f"import|log.csv|{gains}|{columns}|--json",
        "import-cut": f"import|log.csv|{gains}|{columns}|--cut|1 s|--out|cut",
        "import-wrong": f"import|log.csv|{gains}|--columns|position=angle|--json",
        "train-none": "train|--data|none",
    }
    rows = ((name, f"torque|{line}") for name, line in lines.items())
    return replace(_steps("paper", "torque", *rows), networks=networks)


def _lookups() -> list[Job]:
    """Commands without a design."""
    catalogue = [("all", "catalog"), ("all-json", "catalog|--json")]
    for name in COLLECTIONS:
        catalogue += [(name, f"catalog|list|{name}"), (f"{name}-json", f"catalog|{name}|--json")]
    for name in ("AISI 52100 / 100Cr6 hardened", "CubeMars RO100 KV55", "Unitree M107", "6902"):
        catalogue += [(name.split()[0], f"catalog|show|{name}")]
        catalogue += [(f"{name.split()[0]}-json", f"catalog|show|{name}|--json")]
    catalogue += [("unknown", "catalog|show|6909X")]
    explained = [(name, f"explain|{name}") for name in CHECKS.split()]
    explained += [(f"{name}-json", f"explain|{name}|--json") for name in CHECKS.split()]
    helps = [
        ("help-root", "--help"),
        ("help-version", "--version"),
        ("help-torque", "torque|--help"),
    ]
    helps += [(f"help-{name}", f"{name}|--help") for name in COMMANDS.split()]
    helps += [(f"help-torque-{name}", f"torque|{name}|--help") for name in TORQUE_COMMANDS]
    return [
        _steps("", "catalog", *catalogue),
        _steps("", "schema", ("text", "schema"), ("json", "schema|--json")),
        _steps("", "doctor", ("json", "doctor|--json")),
        _steps("", "explain", ("all", "explain"), ("all-json", "explain|--json"), *explained),
        Job("help", tuple(Step(name, tuple(line.split("|"))) for name, line in helps)),
    ]


def _errors() -> list[Job]:
    """Designs and usages that are refused."""
    designs = [(name, f"check|bad-{name}.toml") for name in BAD]
    designs += [
        (f"{command}-{name}", f"{command}|bad-{name}.toml|--json")
        for name in ("undercut", "overlap", "curtate")
        for command in ("analyse", "tolerance", "inertia", "bench", "simulate", "export", "report")
    ]
    usages = {
        "no-file": "check|none.toml",
        "no-file-json": "check|none.toml|--json",
        "folder": "check|designs",
        "no-command": "chekc",
        "no-option": "check|DESIGN|--assemble",
        "no-argument": "check",
        "no-kind": "export|DESIGN|--to|dxf,stp",
        "no-law": "analyse|DESIGN|--contact-law|hertz",
        "few-angles": "analyse|DESIGN|--angles|4",
        "unit": "analyse|DESIGN|--torque|15 mm|--json",
        "bare": "analyse|DESIGN|--torque|15",
        "ratio": "size|--ratio|3",
        "no-ratio": "size",
        "motor": "size|--ratio|10|--motor|cheese",
        "negative": "size|--ratio|10|--peak-torque|-3 N*m",
        "measurement": "bench|DESIGN|--only|torque_rippel",
        "calibration": "bench|DESIGN|--calibration|measured.csv",
        "motor-file": "simulate|DESIGN|--motor-file|measured.csv",
        "reference": "simulate|DESIGN|--reference|measured.csv",
        "rows": "calibrate|DESIGN|--measured|reference.csv",
        "teeth": "compare|DESIGN|--teeth|12,36",
        "material": "compare|DESIGN|--material|cheese",
        "explain": "explain|GEO-K2",
        "model": "torque|export|none.npz",
        "not-model": "torque|export|log.csv|--json",
        "evaluate": "torque|evaluate|--data|none",
    }
    return [
        _steps("", "errors", *designs),
        _steps("sized-7", "errors", *usages.items()),
    ]


def job_list() -> list[Job]:
    """Every job, the longest first."""
    return [*_dear_jobs(), *_variants(), *_errors(), *_lookups(), *_cheap_jobs()]
