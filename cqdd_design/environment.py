"""What this package needs from the machine: Python packages, system libraries, a browser."""

from __future__ import annotations

import os
import re
import shutil
import sys
from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Literal

from cqdd_design.errors import DependencyError, UsageError, shown

DISTRIBUTION = "cqdd-design"

#: Shared libraries that the CAD kernel loads, and the Debian package that brings them.
SYSTEM_LIBRARIES = {"libGL.so.1": "libgl1", "libX11.so.6": "libx11-6"}
#: One line for a bare server; libgl1 depends on libx11-6.
APT_LINE = "apt-get install -y libgl1"
#: The end of the year 9999, past which dates have no usual form.
_LAST_SECOND = 253402300799
#: Names on the path; beside them where macOS and Windows keep theirs.
BROWSERS = (
    *("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "microsoft-edge"),
    "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome",
    "/Applications/Microsoft Edge.app/Contents/MacOS/Microsoft Edge",
    r"C:\Program Files\Google\Chrome\Application\chrome.exe",
    r"C:\Program Files (x86)\Microsoft\Edge\Application\msedge.exe",
)


@dataclass(frozen=True)
class Finding:
    """One line of ``doctor``.

    Attributes
    ----------
    name : str
        What was looked for.
    state : {"ok", "missing", "optional"}
        Present; missing and needed; missing and not needed for the main road.
    detail : str
        Version or place, or what to do.
    extra : str
        Extra of the package that brings what is optional; empty where none does.
    """

    name: str
    state: Literal["ok", "missing", "optional"]
    detail: str
    extra: str = ""


EXTRAS = {
    "torque": "torque networks",
    "sim": "MuJoCo",
    "sweep": "clusters and sensitivities",
    "parquet": "Parquet files",
    "docs": "building the site",
    "dev": "tests and development",
}
"""What each extra of the package is for."""


@dataclass(frozen=True)
class _Wanted:
    distribution: str
    least: str
    extra: str


def examine(folder: Path) -> list[Finding]:
    """Look at everything the package uses.

    Parameters
    ----------
    folder : Path
        What the folders of outputs would stand in.

    Returns
    -------
    list of Finding
    """
    return [
        _python(),
        _ourselves(),
        *(_package(wanted) for wanted in _each_once(_wanted())),
        *(_library(name, package) for name, package in SYSTEM_LIBRARIES.items()),
        _browser(),
        *(writable(folder / name) for name in OUTPUTS),
    ]


def source_date() -> datetime | None:
    """The moment of the environment variable ``SOURCE_DATE_EPOCH``, or None where it is not set.

    Files that hold a date take it from here, so that the same input gives the same bytes
    (https://reproducible-builds.org/docs/source-date-epoch/).

    Raises
    ------
    UsageError
        When it is no whole number of seconds from 1970 to 9999.
    """
    told = os.environ.get("SOURCE_DATE_EPOCH", "")
    if not told:
        return None
    if re.fullmatch(r"[0-9]{1,12}", told) is None or int(told) > _LAST_SECOND:
        raise UsageError(
            f"the environment variable SOURCE_DATE_EPOCH is {shown(told)}; it must be a whole "
            f"number of seconds since 1970, from 0 to {_LAST_SECOND}, or not be set."
        )
    return datetime.fromtimestamp(int(told), UTC)


PROJECT = "CQDD_DESIGN_PROJECT"
"""Environment variable of the project's folder; `cqdd-design --project` sets it."""
OUTPUTS = {
    "designs": "designs that `size` writes",
    "exports": "files for makers and simulators, recordings, data and networks",
    "reports": "reports, as HTML or PDF",
}
"""Folders that commands write into where they are told no other, and what comes there."""


def project_folder() -> Path:
    """What the folders of outputs stand in: ``CQDD_DESIGN_PROJECT``, or the current folder."""
    return Path(os.environ.get(PROJECT, ""))


def output_folder(name: str) -> Path:
    """One of `OUTPUTS` in the project's folder."""
    if name not in OUTPUTS:
        raise ValueError(f"{name} is none of {', '.join(OUTPUTS)}")
    return project_folder() / name


def give_memory_back() -> None:
    """Hand back to the system what was freed: glibc keeps it, by threads, after every search.

    Other C libraries hand it back by themselves, or have no call for it.
    """
    import ctypes

    if sys.platform == "linux":
        with suppress(OSError, AttributeError):
            ctypes.CDLL(None).malloc_trim(0)


def cache_folder() -> Path:
    """Where costly results are kept: ``CQDD_DESIGN_CACHE``, or the user's cache folder."""
    told = os.environ.get("CQDD_DESIGN_CACHE", "")
    if told:
        return Path(told)
    from platformdirs import user_cache_path

    return user_cache_path(DISTRIBUTION, appauthor=False)


def missing_dependency(error: ImportError) -> DependencyError | None:
    """The error to show for a failed import of something foreign, or None for one of our own.

    Parameters
    ----------
    error : ImportError
        As raised while some room imported what it needs.
    """
    text = str(error)
    library = re.match(r"(lib[\w+.-]+\.so[\w.]*): cannot open shared object", text)
    if library:
        line = APT_LINE
        if library[1] not in SYSTEM_LIBRARIES:
            line = f"apt-file search {library[1]}"
        return DependencyError(
            f"the system library {library[1]} is missing, which the CAD kernel needs; "
            f"run `{line}` (on Debian and Ubuntu), then `cqdd-design doctor`."
        )
    name = (error.name or "").partition(".")[0]
    if not name or name == "cqdd_design":
        return None
    return DependencyError(
        f"the Python package that provides '{name}' is missing or broken ({text}); "
        "run `pip install -c constraints.txt .` in the project, then `cqdd-design doctor`."
    )


def _python() -> Finding:
    version = ".".join(str(part) for part in sys.version_info[:3])
    return Finding("Python", "ok", f"{version} at {sys.executable}")


def _ourselves() -> Finding:
    from importlib import metadata

    try:
        return Finding(DISTRIBUTION, "ok", metadata.version(DISTRIBUTION))
    except metadata.PackageNotFoundError:
        fix = "is not installed; run `pip install -c constraints.txt .` in the project"
        return Finding(DISTRIBUTION, "missing", fix)


def _wanted() -> Iterator[_Wanted]:
    """Packages by the metadata of the installed distribution, so that pyproject.toml decides."""
    from importlib import metadata

    try:
        lines = metadata.requires(DISTRIBUTION) or []
    except metadata.PackageNotFoundError:
        lines = []
    for line in lines:
        requirement, _, marker = line.partition(";")
        name = re.match(r"[\w.-]+", requirement)
        least = re.search(r">=\s*([\w.]+)", requirement)
        extra = re.search(r"extra\s*==\s*['\"]([\w-]+)['\"]", marker)
        if name:
            yield _Wanted(name[0], least[1] if least else "0", extra[1] if extra else "")


def _each_once(wanted: Iterable[_Wanted]) -> list[_Wanted]:
    """Every package once, with the highest version asked for; needed is needed, whatever else asks.

    An extra that holds another's packages repeats them in the metadata, and so does the project.
    """
    kept: dict[str, _Wanted] = {}
    for one in wanted:
        other = kept.get(one.distribution, one)
        least = max(one.least, other.least, key=_numbers)
        # The main road needs what no extra names; who runs no tests wants the smaller extra.
        extra = min(other.extra, one.extra, key=lambda name: (name != "", name == "dev"))
        kept[one.distribution] = _Wanted(one.distribution, least, extra)
    return list(kept.values())


def _package(wanted: _Wanted) -> Finding:
    from importlib import metadata

    found: str | None
    try:
        found = metadata.version(wanted.distribution)
    except metadata.PackageNotFoundError:
        found = None
    if found is not None and _numbers(found) >= _numbers(wanted.least):
        return Finding(wanted.distribution, "ok", found)
    has = "is not installed" if found is None else f"is {found}, at least {wanted.least} is needed"
    if wanted.extra:
        fix = f"{has}; for the extra: pip install 'cqdd-design[{wanted.extra}]'"
        return Finding(wanted.distribution, "optional", fix, wanted.extra)
    fix = f"{has}; run pip install '{wanted.distribution}>={wanted.least}'"
    return Finding(wanted.distribution, "missing", fix)


def _numbers(version: str) -> tuple[int, ...]:
    return tuple(int(part) for part in re.findall(r"\d+", version)[:3])


def _library(name: str, package: str) -> Finding:
    if sys.platform != "linux":
        return Finding(name, "ok", "not needed on this system")
    import ctypes

    try:
        ctypes.CDLL(name)
    except OSError:
        return Finding(
            name, "missing", f"needed by the CAD kernel (package {package}): run {APT_LINE}"
        )
    return Finding(name, "ok", "found")


def find_browser() -> str | None:
    """A browser of the Chromium family, which prints and is driven in one way; None without one."""
    found = (shutil.which(name) for name in BROWSERS)
    return next((place for place in found if place), None)


def _browser() -> Finding:
    place = find_browser()
    if place:
        return Finding("browser", "ok", place)
    return Finding(
        "browser",
        "optional",
        "no Chromium found; `report --format pdf` prints through it: apt-get install -y chromium",
    )


def writable(folder: Path) -> Finding:
    """Whether a folder can be written, or made where none stands."""
    standing = folder
    while not standing.exists() and standing != standing.parent:
        standing = standing.parent
    if standing.is_dir() and os.access(standing, os.W_OK | os.X_OK):
        return Finding(f"{folder.name}/", "ok", f"{folder} can be written")
    return Finding(
        f"{folder.name}/",
        "missing",
        f"{standing} cannot be written; run in another folder or give --out",
    )
