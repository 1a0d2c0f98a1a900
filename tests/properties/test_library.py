"""What ``import cqdd_design`` gives: names, arguments, errors, results."""

import dataclasses
import functools
import inspect
import re
import subprocess
import sys
import warnings
from pathlib import Path

import numpy as np
import pint
import pytest

import cqdd_design as cq
from cqdd_design.actuator.bench.metric import Metric
from cqdd_design.errors import CqddError, DependencyError, DesignError, UsageError
from cqdd_design.library.asked import Asked, AskedOfScenario
from cqdd_design.library.results import Result
from cqdd_design.verdict.headline import Figure

REPOSITORY = Path(__file__).resolve().parents[2]
PAPER = REPOSITORY / "designs" / "cqdd-10.toml"
FUNCTIONS = [name for name in cq.__all__ if inspect.isfunction(getattr(cq, name))]
HEAVY = ("numpy", "pydantic", "pint", "cadquery", "torch", "scipy", "numba", "pandas", "jinja2")
UNITS = pint.UnitRegistry()


def python(code: str) -> list[str]:
    """Lines that a fresh interpreter prints."""
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, cwd=REPOSITORY, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()


@pytest.fixture(scope="module")
def analysed():
    return cq.analyse(PAPER, torque="40 N*m", angles=12)


def test_the_names_are_those_that_were_promised():
    promised = "analyse bench calibrate check compare export inertia load report simulate size"
    promised = {*promised.split(), "tolerance", "Design", "Machine", "Requirements", "Verdict"}
    assert set(cq.__all__) == promised | {"__version__"}
    assert dir(cq) == sorted(cq.__all__)
    with pytest.raises(AttributeError, match="no attribute 'sise'"):
        cq.sise  # noqa: B018


def test_importing_loads_nothing_that_takes_time():
    (loaded,) = python("import sys, cqdd_design; print(*sys.modules)")
    assert {name.partition(".")[0] for name in loaded.split()}.isdisjoint(HEAVY)
    ours = [name for name in loaded.split() if name.startswith("cqdd_design.")]
    assert sorted(ours) == ["cqdd_design.report", "cqdd_design.version"]


def test_help_reads_no_files_room():
    """A fifth of its time once, for the table of kinds alone."""
    code = (
        "import sys; sys.argv = ['cqdd-design', '--help']\n"
        "from cqdd_design.__main__ import main\nmain()\n"
        "print('LOADED', *sys.modules, file=sys.stderr)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, cwd=REPOSITORY, check=True
    )
    loaded = done.stderr.partition("LOADED")[2].split()
    assert "cqdd_design.library.calls" in loaded
    assert "cqdd_design.files" not in loaded


def test_the_room_report_never_takes_the_place_of_the_function():
    told = python(
        "import cqdd_design as cq\n"
        "import cqdd_design.report.build\n"
        "from cqdd_design.report import build_report, read_comments\n"
        "print(callable(cq.report), build_report.__module__, read_comments.__module__)"
    )
    assert told == ["True cqdd_design.report.build cqdd_design.report.judgement.origins"]


@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_function_says_what_it_takes_and_gives(name):
    function = getattr(cq, name)
    text = inspect.getdoc(function) or ""
    for heading in ("Parameters", "Returns", "Raises", "Examples"):
        assert f"\n{heading}\n{'-' * len(heading)}\n" in text, (name, heading)
    assert f"cq.{name}(" in text
    signature = inspect.signature(function)
    assert signature.return_annotation is not inspect.Signature.empty
    told = text.partition("\nParameters\n")[2].partition("\nReturns\n")[0]
    for parameter in signature.parameters.values():
        assert parameter.annotation is not inspect.Parameter.empty, (name, parameter.name)
        named = rf"(?m)^(?:[\w, *]*, )?\**{parameter.name}\b"
        assert re.search(named, told), (name, parameter.name)


@pytest.mark.parametrize("name", [name for name in FUNCTIONS if name != "load"])
def test_a_result_is_frozen_and_says_what_it_holds(name):
    function = getattr(cq, name)
    kind = getattr(sys.modules[function.__module__], function.__annotations__["return"])
    assert issubclass(kind, Result)
    assert kind.command == name
    assert kind.__dataclass_params__.frozen
    text = inspect.getdoc(kind)
    for field in dataclasses.fields(kind):
        whole = text + inspect.getdoc(Result)
        assert re.search(rf"(?m)^{field.name} : ", whole), (name, field.name)


def test_size_tells_what_of_a_file_it_does_not_read(tmp_path):
    path = tmp_path / "asked.toml"
    text = "[requirements]\nratio = 10\npeak_torque = '20 N*m'\n"
    path.write_text(text)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        plain = cq.size(requirements=path, quick=True)
    path.write_text(text + "[environment]\nambient = '40 degC'\n")
    with pytest.warns(UserWarning, match=r"but not \[environment\].*; ambient states") as told:
        found = cq.size(requirements=path, quick=True)
    assert told[0].filename == __file__
    assert found.design == plain.design


def test_designs_and_alternatives_are_called_after_the_file(tmp_path):
    found = cq.size(10, peak_torque="20 N*m", quick=True, out=tmp_path / "hip.toml")
    names = [found.design.name, *(one.design.name for one in found.found.sizing.alternatives)]
    assert names[0] == found.found.sizing.design.name == "hip"
    assert len(names) > 1
    assert all(re.fullmatch("hip-[bcd]", name) for name in names[1:])


def test_arguments_of_size_are_the_keys_of_requirements():
    own = set(inspect.signature(cq.size).parameters) - {"asked"}
    keys = set(Asked.__annotations__)
    assert keys | (own & {"ratio", "motor"}) == set(cq.Requirements.model_fields)
    assert not keys & own


def test_arguments_of_simulate_are_the_options_of_the_command():
    from cqdd_design.cli.simulate import simulate

    options = set(inspect.signature(simulate).parameters)
    options -= {"out", "design", "motor", "motor_file", "target", "calibration", "force"}
    own = set(inspect.signature(cq.simulate).parameters) - {"design", "asked", "progress"}
    own -= {"out", "calibration", "force"}
    assert own | set(AskedOfScenario.__annotations__) == options


def test_an_example_a_file_and_a_design_are_the_same():
    example, file = cq.load("cqdd-10"), cq.load(PAPER)
    assert example.sha256 == file.sha256 == cq.load(str(PAPER)).sha256
    assert cq.load(file) == file


def test_what_is_no_design_is_told_with_what_there_is():
    with pytest.raises(UsageError, match=r"neither a file cqdd-11 nor such an example; .*cqdd-10"):
        cq.load("cqdd-11")
    with pytest.raises(UsageError, match="design must be a Design or the path"):
        cq.load(11)


def test_another_motor_tells_what_it_replaces(tmp_path):
    text = PAPER.read_text(encoding="utf-8")
    path = tmp_path / "own.toml"
    path.write_text(text.replace("[motor]\n", '[motor]\nresistance = "0.2 ohm"\n'))
    expected = r"^motor .* goes before \[motor\] of .*resistance"
    with pytest.warns(UserWarning, match=expected) as told:
        found = cq.load(path, motor="CubeMars RO100 KV55")
    assert told[0].filename == __file__
    assert "resistance" not in found.motor.data
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        cq.load(path)


@pytest.mark.parametrize(
    ("given", "told"),
    [
        (40.0, r'^torque: 40.0 has no unit; write it like "40.0 N\*m"\.$'),
        (UNITS.Quantity(40.0, "joule"), "^torque: 'joule' is not a unit of torque"),
        (UNITS.Quantity([1.0, 2.0], "N*m"), "^torque: a torque is one number"),
        ("-3 N*m", r"^torque: -3 N\*m is outside 0.001 to 100000 N\*m; the nearest is 0.001 N"),
        ("1e-6 N*m", r"^torque: 1e-06 N\*m is outside 0.001 to 100000 N\*m; the nearest is 0.001 "),
        (UNITS.Quantity(40.0, "N*m/kg"), "^torque: .* is not a unit of torque"),
    ],
)
def test_a_torque_that_is_none_is_refused_by_its_name(given, told):
    with pytest.raises(UsageError, match=told):
        cq.analyse("cqdd-10", torque=given)


@pytest.mark.parametrize(
    ("call", "told"),
    [
        (lambda: cq.check("cqdd-10", angles=0), "^angles 0 must be from 1 to 100000; the nearest"),
        (lambda: cq.tolerance("cqdd-10", samples=2.5), "^samples 2.5 is not a whole number"),
        (
            lambda: cq.tolerance("cqdd-10", angles=7),
            "^angles 7 must be at least 8; .* 8",
        ),
        (lambda: cq.compare("cqdd-10", teeth=(12, 36)), r"^teeth \(12, 36\) must be four numbers"),
        (lambda: cq.size(), "^size needs ratio N or requirements FILE"),
        (lambda: cq.size(10, peak_troque="3 N*m"), "peak_troque .*did you mean 'peak_torque'"),
        (lambda: cq.size(10, pick="e"), "^pick 'e' is none of b, c, d"),
        (lambda: cq.simulate("cqdd-10", mas="1 kg"), "^simulate has no argument mas; .*mass"),
        (lambda: cq.simulate("cqdd-10", wall_angle="1 rad"), "^wall_angle does not belong to load"),
        (lambda: cq.simulate("cqdd-10", amplitude=3.0), "amplitude of command torque: .*no unit"),
        (lambda: cq.bench("cqdd-10", beside=["x"]), "x"),
        (lambda: cq.export("cqdd-10", "dfx"), "dfx"),
        (lambda: cq.calibrate("printed-13"), "give them with measured FILE"),
        (lambda: cq.analyse("cqdd-10", friction="OFF"), "^friction 'OFF' is none of .* 'off'"),
        (lambda: cq.analyse("cqdd-10", friction=None), "^friction None is none of drive, back"),
        (lambda: cq.analyse("cqdd-10", friction=False), "^friction False is none of"),
        (lambda: cq.analyse("cqdd-10", contact_law="hertz"), "^contact_law 'hertz' is none of pal"),
        (lambda: cq.analyse("cqdd-10", contact_law=None), "^contact_law None is none of"),
        (lambda: cq.analyse("cqdd-10", speed="-5 rpm"), '^speed -5 rpm .* use "5 rpm", for'),
        (
            lambda: cq.analyse("cqdd-10", temperature=UNITS.Quantity(40.0, "delta_degC")),
            "^temperature: '40.0 delta_degree_Celsius' is a difference; .*1 degC",
        ),
        (lambda: cq.analyse("cqdd-10", tempreature="4 degC"), "^analyse has no .*'temperature'"),
        (lambda: cq.analyse(), "^analyse: missing a required argument: 'design'; it takes design"),
        (lambda: cq.analyse("cqdd-10", "3 N*m"), "^analyse: too many .* by name"),
        (lambda: cq.check({"requirements": {}}), "^design must .* Design.from_mapping"),
        (lambda: cq.size(10, objective="weight"), "^objective 'weight' is none of mass, inertia"),
        (lambda: cq.size(requirements=10), "^requirements 10 are none: .*mapping"),
        (lambda: cq.size(requirements={"peak": 3}), "^size needs ratio N"),
        (lambda: cq.size(10, motor=3), "^motor 3 is not a text"),
        (lambda: cq.size(10, ambient="250 degC"), "^ambient: 250 degC is outside -60 .* 90 degC"),
        (lambda: cq.compare("cqdd-10", teeth=None), "^teeth None must be four numbers"),
        (lambda: cq.compare("cqdd-10", teeth="12,36,22"), "^teeth 12,36,22 must be four numbers"),
        (lambda: cq.compare("cqdd-10", planets="3"), "^planets '3' is not a whole .* 1 to 24"),
        (lambda: cq.compare("cqdd-10", material=3), "^material 3 is not a text"),
        (
            lambda: cq.compare("cqdd-10", settings={"aplication_factor": 1.5}),
            "^settings: 'aplication_factor' is no setting; did you mean 'application_factor'",
        ),
        (
            lambda: cq.compare("cqdd-10", settings={"life_hours": None}),
            "^life_hours = None is not a number, such as 1000",
        ),
        (
            lambda: cq.calibrate("cqdd-10", {"continuous_torque": "37 kg"}),
            r"^continuous_torque: 'kg' is not a unit of torque; .* a number in N\*m",
        ),
        (lambda: cq.calibrate("cqdd-10", {"efficiency_peak": "80 %"}), "not a number, such as 0.8"),
        (lambda: cq.simulate("cqdd-10", load=None), "^load None is none of free, locked"),
        (lambda: cq.simulate("cqdd-10", friction=None), "^friction None is none of clip, lugre"),
        (lambda: cq.bench("cqdd-10", only=3), r'^only 3 is not a name; .*\("mass",\)'),
        (lambda: cq.bench("cqdd-10", only=["mass", 3]), "^only 3 is not a name"),
        (lambda: cq.bench("cqdd-10", only=()), "^no measurement is selected; .* backlash"),
        (lambda: cq.bench("cqdd-10", only=" , "), "^no measurement is selected"),
        (lambda: cq.bench("cqdd-10", beside="foo, bar"), "no motor 'foo'"),
        (lambda: cq.export("cqdd-10", 3), "^to 3 is not a name"),
        (lambda: cq.export("cqdd-10", "gcode", passes="4"), "^passes '4' is not a whole number"),
        (lambda: cq.export("cqdd-10", "dxf", seed=3), "^seed draws .*with to mjcf or urdf"),
        (lambda: cq.load("cqdd-10", motor=3), "^motor 3 is not a text"),
        (lambda: cq.report("cqdd-10", format=3), "^format 3: a report is html or pdf"),
    ],
)
def test_errors_name_arguments_and_are_of_one_family(call, told):
    with pytest.raises(CqddError, match=told) as caught:
        call()
    assert "--" not in str(caught.value).partition("`")[0]
    assert caught.value.message == str(caught.value)


def test_requirements_and_designs_refuse_in_our_own_words():
    with pytest.raises(DesignError, match=r"ratio = 300: .*nearest allowed is 119"):
        cq.Requirements(ratio=300)
    with pytest.raises(DesignError, match=r"reducer.eccentricity is missing"):
        cq.Design(reducer={"ratio": 10})
    half = cq.Requirements(ratio=10, peak_torque=UNITS.Quantity(0.05, "kN*m"))
    assert half.peak_torque == 50.0
    assert half.continuous_torque == pytest.approx(19.0)


@pytest.mark.parametrize("peak", [30, "-3 N*m", "3 kg", "1e9 N*m"])
def test_of_a_peak_torque_that_is_refused_nothing_else_is_complained_of(peak):
    for ask in (cq.Requirements, functools.partial(cq.size, quick=True)):
        with pytest.raises(CqddError, match="peak_torque") as caught:
            ask(ratio=10, peak_torque=peak)
        assert "continuous_torque" not in caught.value.message


def test_requirements_may_be_a_mapping_of_their_keys():
    told = {"ratio": 8, "peak_torque": "15 N*m", "yield_share": 0.9}
    found = cq.size(requirements=told, peak_torque="20 N*m", quick=True)
    asked = found.design.requirements
    assert (asked.ratio, asked.peak_torque, asked.yield_share) == (8, 20.0, 0.9)


def test_numbers_of_numpy_are_numbers_and_a_whole_float_is_whole():
    asked = cq.Requirements(ratio=np.int64(10), efficiency=np.float32(0.5))
    assert (asked.ratio, asked.efficiency) == (10, 0.5)
    assert type(asked.ratio) is int
    paper = cq.load("cqdd-10")
    changed = paper.replacing({"reducer.eccentricity": np.float64(0.0015), "reducer.ratio": 10.0})
    assert changed.reducer.eccentricity == 0.0015
    plain = cq.compare(paper, planets=3).to_dict()["results"]
    teeth = np.array([12, 36, 22, 70])
    assert cq.compare(paper, teeth=teeth, planets=np.int32(3)).to_dict()["results"] == plain
    assert cq.compare(paper, teeth="12, 36, 22, 70", planets=3.0).to_dict()["results"] == plain
    assert len(cq.tolerance(paper, samples=np.uint8(2), angles=110.0, seed=3.0).found.values) == 2
    for wrong in (True, np.bool_(True), 2.5, np.float64("nan"), "2", None):
        with pytest.raises(UsageError, match=r"^samples .* is not a whole number; .* from 1 to"):
            cq.tolerance(paper, samples=wrong)


def test_quantities_of_pint_are_those_of_strings():
    paper = cq.load("cqdd-10")
    texts = {"reducer.eccentricity": "1.5 mm", "environment.ambient": "40 degC"}
    values = {
        "reducer.eccentricity": UNITS.Quantity(0.0015, "m"),
        "environment.ambient": UNITS.Quantity(313.15, "kelvin"),
    }
    assert paper.replacing(texts).sha256 == paper.replacing(values).sha256 != paper.sha256
    speed = UNITS.Quantity(1.0, "rad/s") * 10.0
    run = cq.simulate("cqdd-10", load="driven", output_speed=speed, duration="20 ms")
    same = cq.simulate("cqdd-10", load="driven", output_speed="10 rad/s", duration="20 ms")
    assert (run.to_pandas() == same.to_pandas()).all().all()


def test_requirements_over_requirements_keep_what_was_stated():
    from cqdd_design.library.inputs import read_wanted

    base = cq.Requirements(ratio=10, peak_torque="50 N*m", **{"yield": 0.9})
    found = read_wanted({"peak_torque": "60 N*m"}, base).requirements
    assert (found.peak_torque, found.yield_share) == (60.0, 0.9)
    # What followed from the torque that was replaced follows again.
    assert found.continuous_torque == pytest.approx(0.38 * 60.0)
    assert read_wanted({}, base).requirements is base


def test_a_result_is_told_in_a_few_lines(analysed):
    lines = repr(analysed).splitlines()
    assert lines[0].startswith("Analysed cqdd-10: does NOT meet its requirements: of ")
    figures = analysed.verdict.headline
    assert [line.strip() for line in lines[1:]] == [one.told for one in figures]
    assert len(figures) == 7
    assert repr(analysed.verdict).splitlines()[1:] == lines[1:]


def test_a_figure_is_told_with_what_is_asked_and_not_guessed():
    known = Figure("mass", "mass", 0.8, "kg", 1.0, "pass", "")
    assert known.told == "pass     mass: 0.8 kg, 1 asked"
    assert dataclasses.replace(known, value=None, required=None).told.endswith("mass: not known")


def test_a_design_and_a_machine_are_told_in_a_line(analysed):
    paper = cq.load("cqdd-10")
    told = "Design cqdd-10: ratio 10, ring 72 mm, 2 x 8 mm of disc, CubeMars RO100 Lite KV55"
    assert repr(paper) == told
    assert repr(analysed.machine) == f"Machine of {told}; cam bearing 6902"


def test_a_notebook_shows_a_design_in_a_table():
    shown = cq.load("cqdd-10").replacing({"name": "R&D"})._repr_html_()
    assert shown.startswith("<table><caption>R&amp;D</caption>")
    for cell in ("10", "72 mm", "2 x 8 mm", "CubeMars RO100 Lite KV55"):
        assert f"<td>{cell}</td>" in shown


def test_a_notebook_shows_the_reports_own_figures(analysed):
    import html

    from cqdd_design.report.judgement.verdict import verdict

    shown = analysed._repr_html_()
    page = html.unescape(re.search(r'srcdoc="([^"]*)"', shown)[1])
    assert page.count("<h1>cqdd-10</h1>") == 1
    for figure in verdict(analysed.verdict, ())["figures"]:
        assert f'<td>{figure["title"]}</td><td class="number">{figure["value"]}</td>' in page
    assert 'id="front-view-svg"' in page
    assert '<section id="contact"' in page
    # Nothing of it reaches out of its frame, or to the network.
    assert "<script" not in page
    assert not re.search(r"(?:src|href)=\"(?:https?:)?//", page)


def shown_page(found):
    """The page that a notebook shows of a result."""
    import html

    return html.unescape(re.search(r'srcdoc="([^"]*)"', found._repr_html_())[1])


def test_an_export_tells_what_its_files_allow_and_the_gearbox_does_not_carry(tmp_path):
    found = cq.export("cqdd-10", "urdf", out=tmp_path)
    (warning,) = found.warnings
    assert "the effort limit in these files; the gearbox does not carry it" in warning
    assert repr(found).splitlines()[-1] == f"  warning: {warning}"
    assert "the gearbox does not carry it" in shown_page(found)


def test_a_notebook_has_words_and_units_where_the_document_has_keys():
    from cqdd_design.actuator.columns import SUMMARY

    run = cq.simulate("cqdd-10", command="open", duration="5 ms")
    page = shown_page(run)
    for key, words, _ in SUMMARY:
        assert key in run.found.summary()[0]
        assert f"<td>{words}</td>" in page
        assert key not in page
    assert "<td>N·m</td>" in page
    # Its lines are dark: in a dark notebook the drawing keeps a light sheet of its own.
    assert re.search(r'<figure id="front-view" class="drawing">', page)
    one = shown_page(cq.bench("cqdd-10", only=("mass",)))
    assert "1 measurement on the simulation" in one


def test_a_notebook_tells_its_line_without_code_marks(analysed):
    assert "`" in analysed._told()
    assert "(check draws toleranced ones too)" in shown_page(analysed)


def test_calibrated_rows_are_named_and_have_units_as_printed():
    import types

    from cqdd_design.library.actuators import Calibrated

    row = types.SimpleNamespace(
        name="backdrive_static",
        unit="N*m",
        measured=1.99,
        before=2.35,
        after=None,
        relation="given",
    )
    (section,) = Calibrated._sections(
        types.SimpleNamespace(found=types.SimpleNamespace(rows=[row]))
    )
    assert section.values["rows"]["rows"] == [
        ("backdrive torque, breakaway", "N·m", "1.99", "2.35", "", "given")
    ]


def test_a_table_has_a_row_for_every_contact(analysed):
    table = analysed.to_pandas()
    reducer = analysed.design.reducer
    teeth = table[table.contact == "tooth"]
    assert len(teeth) == 12 * reducer.disc_count * reducer.ring_tooth_count
    assert len(table) - len(teeth) == 12 * reducer.disc_count * reducer.output_pins.count
    # A tooth's place in the table is its place in the arrays.
    force = analysed.found.contact.sweep.ring_force
    one = teeth[(teeth.disc == 2) & (teeth.number == 4)]
    assert one.force_N.to_numpy() == pytest.approx(force[:, 1, 3])


def test_no_pandas_is_told_as_a_missing_package(monkeypatch):
    monkeypatch.setitem(sys.modules, "pandas", None)
    run = cq.simulate("cqdd-10", command="open", duration="5 ms")
    with pytest.raises(DependencyError, match="to_pandas needs the Python package pandas"):
        run.to_pandas()


@pytest.mark.parametrize(
    ("asked", "told"),
    [
        ({"frequency": "400 Hz"}, []),
        ({"frequency": "900 Hz"}, ["the signal swings at up to 900 Hz, and 1000 records a second"]),
        ({"frequency": "900 Hz", "rate": "2 kHz"}, []),
        (
            {"frequency": "900 Hz", "rate": "2 kHz", "command": "position"},
            ["frequency 900 Hz is above half of the drive's control_rate, 1 kHz; lower it"],
        ),
        ({"end_frequency": "600 Hz", "duration": "5 ms"}, ["the signal swings at up to 600 Hz"]),
    ],
)
def test_a_command_too_fast_to_be_sampled_is_told(asked, told):
    run = cq.simulate("cqdd-10", **({"amplitude": None, "duration": "5 ms"} | asked))
    fast = [one for one in run.warnings if "above half" in one or "records a second" in one]
    assert len(fast) == len(told)
    assert all(one.startswith(words) for one, words in zip(fast, told, strict=True))


def test_a_simulation_of_an_open_circuit_stays_at_rest():
    table = cq.simulate("cqdd-10", command="open", duration="20 ms").to_pandas()
    assert len(table) == 20
    assert (table["motor_angle [rad]"].diff().dropna().abs() < 1e-9).all()


def test_a_calibration_of_another_design_is_told():
    from cqdd_design.actuator.bench.unknowns import Fit
    from cqdd_design.library.actuators import Calibrated, specimen_given

    paper, other = cq.load("cqdd-10"), cq.load("printed-13")
    fitted = Calibrated(paper, (), type("Found", (), {"factors": Fit({"motor_coulomb": 2.0}, ())}))
    specimen, told = specimen_given(paper, 3, fitted)
    assert (specimen.seed, dict(specimen.factors), told) == (3, {"motor_coulomb": 2.0}, ())
    _, (sentence,) = specimen_given(other, None, fitted)
    assert sentence.startswith("the calibration is of another design (cqdd-10)")


def test_what_a_result_holds_cannot_be_changed() -> None:
    """Statistics, pages and files are of it."""
    drawn = cq.tolerance("cqdd-10", samples=4)
    for column in drawn.found.columns.values():
        with pytest.raises(ValueError, match="read-only"):
            column[0] = 1.0
    with pytest.raises(ValueError, match="read-only"):
        drawn.found.numbers[0] = 7


def test_traces_of_the_bench_cannot_be_changed() -> None:
    trace = np.arange(3.0)
    metric = Metric("mass", 1.0, "predicted", "weighed", trace={"t_s": trace})
    with pytest.raises(ValueError, match="read-only"):
        metric.trace["t_s"][0] = 1.0
    trace[0] = 5.0  # its maker's own array stays writable


@pytest.mark.deep
def test_a_figure_that_was_not_drawn_says_so() -> None:
    found = cq.analyse("cqdd-10")
    (line,) = (one for one in repr(found.verdict).splitlines() if "backlash" in one)
    assert "not known (no toleranced gearboxes were drawn here; `check` draws them)" in line


def test_gearboxes_are_drawn_with_another_motor_too():
    drawn = cq.tolerance(PAPER, samples=2, angles=110, motor="CubeMars RO100 KV55")
    assert drawn.design.motor.name == "CubeMars RO100 KV55"
    assert cq.load(PAPER).motor.name != drawn.design.motor.name
    with pytest.raises(UsageError, match=r"motor 5 is not a text"):
        cq.tolerance(PAPER, samples=2, motor=5)
