"""How processes end: bugs, missing libraries, Ctrl-C, closed pipes, full disks; their imports."""

import json
import os
import signal
import subprocess
import sys

import pytest

HEAVY = ("cadquery", "torch", "dask", "numba", "mujoco", "OCP", "vtkmodules", "matplotlib")


@pytest.fixture
def python(tmp_path):
    """Run a piece of Python in a fresh interpreter."""

    def run(code: str, **options) -> subprocess.CompletedProcess:
        return subprocess.run(
            [sys.executable, "-c", code],
            cwd=tmp_path,
            capture_output=True,
            text=True,
            timeout=120,
            check=False,
            **options,
        )

    return run


def breaking(exception: str, *arguments: str) -> str:
    """Code that runs the command line with a library call that raises."""
    return f"""
import sys
import cqdd_design.design.toml as toml

def broken(path):
    raise {exception}

import cqdd_design.design
cqdd_design.design.load_design = broken
sys.argv = ["cqdd-design", *{list(arguments)!r}]
from cqdd_design.__main__ import main
sys.exit(main())
"""


def test_a_bug_names_its_log(python, tmp_path):
    done = python(
        breaking("ZeroDivisionError('by zero')", "check", "d.toml"),
        env={**os.environ, "TMPDIR": str(tmp_path)},
    )
    assert done.returncode == 1
    assert "Traceback" not in done.stderr
    assert "this is a bug in cqdd-design" in done.stderr
    (log,) = tmp_path.glob("cqdd-design-*.log")
    assert str(log) in done.stderr
    assert "ZeroDivisionError: by zero" in log.read_text()
    assert "['check', 'd.toml']" in log.read_text()


def test_a_bug_shows_its_traceback_with_debug(python):
    done = python(breaking("ZeroDivisionError('by zero')", "check", "d.toml", "--debug"))
    assert done.returncode == 1
    assert "Traceback" in done.stderr


@pytest.mark.parametrize(
    ("exception", "said"),
    [
        (
            "ImportError('libGL.so.1: cannot open shared object file: No such file or directory')",
            "apt-get install -y libgl1",
        ),
        ("ModuleNotFoundError(\"No module named 'ezdxf'\", name='ezdxf')", "'ezdxf' is missing"),
    ],
)
def test_a_missing_library_says_what_to_install(python, exception, said):
    done = python(breaking(exception, "check", "d.toml", "--json"))
    assert done.returncode == 5
    assert said in done.stderr
    assert "doctor" in done.stderr
    assert said in json.loads(done.stdout)["error"]["message"]


def test_an_import_error_of_our_own_is_a_bug(python, tmp_path):
    done = python(
        breaking("ImportError('cannot import name', name='cqdd_design.design')", "check", "d.toml"),
        env={**os.environ, "TMPDIR": str(tmp_path)},
    )
    assert done.returncode == 1


def test_interruption_is_quiet(python):
    done = python(breaking("KeyboardInterrupt", "check", "d.toml"))
    assert done.returncode == 130
    assert done.stderr.strip() == "cqdd-design: interrupted"


@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_signal_leaves_nothing_half_written(tmp_path, number, code):
    script = """
import sys, time, pathlib
from cqdd_design.files import atomic_path
import cqdd_design.design

def slow(path):
    with atomic_path(pathlib.Path("result.txt")) as temporary:
        temporary.write_text("half")
        print("writing", file=sys.stderr, flush=True)
        # Not one long sleep: a signal just before it begins would wait for its end.
        for _ in range(1200):
            time.sleep(0.05)

cqdd_design.design.load_design = slow
sys.argv = ["cqdd-design", "check", "d.toml"]
from cqdd_design.__main__ import main
sys.exit(main())
"""
    process = subprocess.Popen(
        [sys.executable, "-c", script], cwd=tmp_path, stderr=subprocess.PIPE, text=True
    )
    assert process.stderr is not None
    assert process.stderr.readline().strip() == "writing"
    process.send_signal(number)
    rest = process.communicate(timeout=30)[1]
    assert process.returncode == code
    assert "Traceback" not in rest
    assert list(tmp_path.iterdir()) == []


@pytest.fixture
def loose(paper_design_file, tmp_path):
    """Teeth that never touch: `check` says no without gearboxes to draw."""
    path = tmp_path / "loose.toml"
    text = paper_design_file.read_text()
    assert 'equidistant = "6 um"' in text
    path.write_text(text.replace('equidistant = "6 um"', 'equidistant = "400 um"'))
    return path


@pytest.mark.skipif(os.name != "posix", reason="pipes of POSIX")
def test_a_closed_pipe_keeps_the_exit_code(loose, tmp_path):
    reader, writer = os.pipe()
    os.close(reader)
    done = subprocess.run(
        [sys.executable, "-m", "cqdd_design", "check", str(loose)],
        stdout=writer,
        stderr=subprocess.PIPE,
        text=True,
        cwd=tmp_path,
        check=False,
    )
    os.close(writer)
    assert done.returncode == 4
    assert all(line.startswith(("warning: ", "[")) for line in done.stderr.splitlines())


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs /dev/full")
@pytest.mark.parametrize("option", [[], ["--json"]])
def test_a_full_disk_behind_stdout(tmp_path, option):
    with open("/dev/full", "w") as full:
        done = subprocess.run(
            [sys.executable, "-m", "cqdd_design", "explain", *option],
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            cwd=tmp_path,
            check=False,
        )
    assert done.returncode == 2
    assert done.stderr.strip().endswith("cannot write to standard output: No space left on device.")


@pytest.mark.skipif(os.name != "posix", reason="shell of POSIX")
def test_closed_standard_output(loose, tmp_path):
    done = subprocess.run(
        f"{sys.executable} -m cqdd_design check {loose} >&-",
        shell=True,
        cwd=tmp_path,
        stderr=subprocess.PIPE,
        text=True,
        check=False,
    )
    assert done.returncode == 4
    assert "Traceback" not in done.stderr


def test_what_libraries_print_goes_to_stderr(python):
    code = """
import os, sys
from cqdd_design.cli.session import Output
out = Output("check", as_json=True, quiet=False)
print("python prints", flush=True)
os.write(1, b"C++ prints\\n")
out.document({"answer": 42})
"""
    done = python(code)
    assert json.loads(done.stdout)["results"] == {"answer": 42}
    assert "python prints" in done.stderr
    assert "C++ prints" in done.stderr


@pytest.mark.parametrize(
    "arguments",
    [["--help"], ["size", "--help"], ["catalog"], ["explain"], ["schema"], ["check", "DESIGN"]],
)
def test_what_a_command_does_not_import(python, paper_design_file, arguments):
    given = [str(paper_design_file) if a == "DESIGN" else a for a in arguments]
    done = python(
        f"""
import sys
sys.argv = ["cqdd-design", *{given!r}]
from cqdd_design.__main__ import main
main()
loaded = sorted({{name.partition(".")[0] for name in sys.modules}})
print("LOADED", *loaded, file=sys.stderr)
"""
    )
    loaded = set(done.stderr.partition("LOADED")[2].split())
    assert "cqdd_design" in loaded
    # Stress of discs and ring is judged by the compiled equilibrium.
    assert loaded.isdisjoint(set(HEAVY) - ({"numba"} if "check" in arguments else set()))
    if "--help" in arguments:
        assert loaded.isdisjoint({"numpy", "pint", "rich", "scipy", "jinja2"})
    if given == ["--help"]:
        assert "pydantic" not in loaded


def test_the_screen_alone_imports_no_model_of_a_verdict(python, tmp_path):
    """They take as long to come as it takes to look."""
    given = ["size", "--ratio", "10", "--quick", "--out", str(tmp_path / "q.toml")]
    done = python(
        f"""
import sys
sys.argv = ["cqdd-design", *{given!r}]
from cqdd_design.__main__ import main
try:
    main()
finally:
    print("LOADED", *sys.modules, file=sys.stderr)
"""
    )
    loaded = set(done.stderr.partition("LOADED")[2].split())
    assert "cqdd_design.sizing.screen" in loaded
    rooms = {".".join(name.split(".")[:2]) for name in loaded}
    assert rooms.isdisjoint({"cqdd_design.verdict", "cqdd_design.actuator", "scipy.optimize"})


DOORS = (
    "cqdd_design.roads.size",
    "cqdd_design.gearbox",
    "cqdd_design.sizing",
    "cqdd_design.solids",
    "cqdd_design.exporting",
    "cqdd_design.report",
    "cqdd_design.planetary",
)


def test_no_room_imports_heavy_packages_at_its_door(python):
    """One after another: what the first of them imports is told with its name."""
    done = python(
        f"""
import importlib, sys
for door in {DOORS!r}:
    importlib.import_module(door)
    print(door, *{{name.partition(".")[0] for name in sys.modules}})
"""
    )
    assert done.returncode == 0, done.stderr
    told = [line.split() for line in done.stdout.splitlines()]
    assert [door for door, *_ in told] == list(DOORS)
    for door, *loaded in told:
        assert set(loaded).isdisjoint(HEAVY), door


@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
def test_a_signal_waits_for_the_end_of_an_import(tmp_path):
    """Compiled packages crash when an exception is thrown through their initialisation."""
    (tmp_path / "slow.py").write_text(
        "import time\nprint('importing', flush=True)\n"
        "for _ in range(20): time.sleep(0.05)\nprint('imported', flush=True)\n"
    )
    script = """
import sys, time
import cqdd_design.design

def importing(path):
    import slow
    for _ in range(1200):
        time.sleep(0.05)

cqdd_design.design.load_design = importing
sys.argv = ["cqdd-design", "check", "d.toml"]
from cqdd_design.__main__ import main
sys.exit(main())
"""
    process = subprocess.Popen(
        [sys.executable, "-c", script],
        cwd=tmp_path,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert process.stderr is not None
    assert process.stderr.readline().strip() == "importing"
    process.send_signal(signal.SIGINT)
    rest = process.communicate(timeout=30)[1]
    assert process.returncode == 130
    assert rest.split("\n")[:2] == ["imported", "cqdd-design: interrupted"]


@pytest.mark.parametrize("stated", [None, "3"])
def test_linear_algebra_of_a_command_keeps_to_one_core_unless_told(python, stated):
    code = """
import sys
sys.argv = ["cqdd-design", "--version"]
from cqdd_design.__main__ import main
code = main()
import numpy
from threadpoolctl import threadpool_info
blas = [one for one in threadpool_info() if one["internal_api"] == "openblas"]
print("threads", [one["num_threads"] for one in blas])
sys.exit(code)
"""
    mine = {k: v for k, v in os.environ.items() if not k.endswith("_NUM_THREADS")}
    told = {} if stated is None else {"OPENBLAS_NUM_THREADS": stated}
    done = python(code, env={**mine, **told})
    assert done.returncode == 0
    # A command that has ended gives its standard output away.
    if "threads []" in done.stderr:
        pytest.skip("this numpy has another library")
    assert f"threads [{min(int(stated or 1), os.cpu_count())}]" in done.stderr
