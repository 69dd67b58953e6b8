"""The wheel: built once without a network, listed, and installed beside this environment."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tarfile
from pathlib import Path
from zipfile import ZipFile

import pytest
from hatchling.build import build_editable

from hatch_build import RelocationError, relocated
from tests.worlds.command import VARIABLE, shadows

ROOT = Path(__file__).parents[1]
PACKAGES = ("models", "analytic", "sim", "reports")
COMMANDS = [
    "tests/test_face.py",
    "tests/reports/cli/test_ending.py::test_an_import_that_ctrl_c_cut_short_is_no_missing_engine",
    "tests/reports/history/test_history.py::"
    "test_packages_of_our_names_in_the_working_folder_change_nothing",
    "tests/reports/sweep/test_faults.py::test_what_stands_in_the_working_folder_is_not_imported",
]
"""Of the tests that start the command as a process, some of each kind."""
ALL_COMMANDS = [
    "tests/test_face.py",
    "tests/test_readme.py",
    "tests/reports/cli/test_ending.py",
    "tests/reports/cli/test_interrupt.py",
    "tests/reports/cli/test_start_up.py",
    "tests/reports/history/test_history.py",
    "tests/reports/sweep",
    "tests/reports/tune/test_tune.py",
]


def built(source: Path, folder: Path, target: str) -> Path:
    """A wheel or an archive of the sources, built by what this environment has."""
    command = [sys.executable, "-m", "hatchling", "build", "-t", target, "-d", str(folder)]
    subprocess.run(command, cwd=source, check=True, capture_output=True)
    (path,) = folder.iterdir()
    return path


@pytest.fixture(scope="session")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return built(ROOT, tmp_path_factory.mktemp("wheel"), "wheel")


@pytest.fixture(scope="session")
def installed(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of the programs of an environment that has the wheel, and borrows from here all
    that it needs; what is installed here as editable is not borrowed."""
    home = tmp_path_factory.mktemp("environment")
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", str(home)], check=True)
    python = home / "bin" / "python"
    pip = [sys.executable, "-m", "pip", "--python", str(python), "install", "--quiet"]
    subprocess.run([*pip, "--no-deps", "--no-index", str(wheel)], check=True)
    (site,) = home.glob("lib/python*/site-packages")
    borrowed = [path for path in sys.path if Path(path).name in ("site-packages", "dist-packages")]
    (site / "borrowed.pth").write_text("\n".join(borrowed) + "\n", encoding="utf-8")
    return python.parent


@pytest.fixture
def mine(tmp_path: Path) -> Path:
    """A user's folder that holds empty packages of our names, and a folder `crankcheck`."""
    (tmp_path / "mine" / "crankcheck").mkdir(parents=True)
    return shadows(tmp_path / "mine")


def ran(*command: object, cwd: Path, **variables: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [str(part) for part in command],
        cwd=cwd,
        capture_output=True,
        text=True,
        check=False,
        env={name: text for name, text in os.environ.items() if name != "PYTHONPATH"} | variables,
    )


def test_it_installs_one_name(wheel: Path) -> None:
    with ZipFile(wheel) as archive:
        names = archive.namelist()
    other, ours = sorted({name.partition("/")[0] for name in names}, reverse=True)
    assert ours == "crankcheck"
    assert re.fullmatch(r"crankcheck-[\d.]+\.dist-info", other)
    files = {
        f"{'' if package == ours else 'crankcheck/'}{path.relative_to(ROOT).as_posix()}"
        for package in (ours, *PACKAGES)
        for path in (ROOT / package).rglob("*")
        if path.is_file() and path.suffix != ".pyc"
    }
    assert {name for name in names if not name.startswith(other)} == files
    assert {"crankcheck/py.typed", "crankcheck/models/scenes/shaper.toml"} <= files


def test_but_for_our_names_the_code_is_letter_for_letter_that_of_the_checkout(wheel: Path) -> None:
    changed = 0
    with ZipFile(wheel) as archive:
        for name in archive.namelist():
            home, _, place = name.partition("/")
            if home == "crankcheck":
                source = ROOT / (place if place.startswith(PACKAGES) else name)
                code, before = archive.read(name), source.read_bytes()
                changed += code != before
                assert re.sub(rb"\bfrom crankcheck\.(?!__)", b"from ", code) == before, name
    assert changed > 100


def test_the_archive_of_the_sources_builds_the_same_wheel(wheel: Path, tmp_path: Path) -> None:
    with tarfile.open(built(ROOT, tmp_path / "sdist", "sdist")) as archive:
        archive.extractall(tmp_path, filter="data")
    (source,) = tmp_path.glob("crankcheck-*")
    again = built(source, tmp_path / "wheel", "wheel")
    assert again.read_bytes() == wheel.read_bytes()


def test_an_editable_install_is_the_checkout(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(ROOT)
    with ZipFile(tmp_path / build_editable(str(tmp_path))) as archive:
        code = [name for name in archive.namelist() if "dist-info" not in name]
        assert code == ["_crankcheck.pth"]
        assert archive.read("_crankcheck.pth").decode().strip() == str(ROOT)


@pytest.mark.parametrize("module", [False, True], ids=["crankcheck", "python -m crankcheck"])
def test_packages_of_our_names_in_the_users_folder_hide_nothing(
    installed: Path, mine: Path, module: bool
) -> None:
    start = [installed / "python", "-m", "crankcheck"] if module else [installed / "crankcheck"]
    done = ran(*start, "verify", "fourbar-lecture-1", "--jobs", 2, cwd=mine)
    assert (done.returncode, done.stderr) == (0, "")
    assert "WITHIN TOLERANCE" in done.stdout


def test_import_crankcheck_is_the_wheel_in_the_users_folder(installed: Path, mine: Path) -> None:
    code = (
        "import crankcheck, numpy as np\n"
        "motion = crankcheck.solve(crankcheck.load_scene('shaper'), np.zeros(1))\n"
        "print(type(motion).__module__, crankcheck.__file__)"
    )
    done = ran(installed / "python", "-c", code, cwd=mine)
    module, path = done.stdout.split()
    assert module == "crankcheck.models.motion"
    assert Path(path).is_relative_to(installed.parent)


def test_a_type_checker_sees_through_the_wheel(installed: Path, mine: Path) -> None:
    (mine / "script.py").write_text(
        "import crankcheck, numpy\n"
        "reveal_type(crankcheck.solve(crankcheck.load_scene('shaper'), numpy.zeros(1)))\n"
    )
    checker = [sys.executable, "-m", "mypy", "--python-executable", installed / "python"]
    done = ran(*checker, "--strict", "script.py", cwd=mine)
    assert done.returncode == 0, done.stdout
    assert 'Revealed type is "crankcheck.models.motion.Motion"' in done.stdout


def test_tests_of_the_command_pass_against_that_of_the_wheel(installed: Path) -> None:
    against(installed, *COMMANDS)


@pytest.mark.slow
def test_all_tests_of_the_command_pass_against_that_of_the_wheel(installed: Path) -> None:
    against(installed, *ALL_COMMANDS)


def against(installed: Path, *tests: str) -> None:
    """Run tests that take the command from `tests.worlds.command` with that of the wheel."""
    command = [sys.executable, "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider", *tests]
    done = ran(*command, cwd=ROOT, **{VARIABLE: str(installed / "crankcheck")})
    assert done.returncode == 0, done.stdout


MOVED = {"analytic", "analytic.reach", "analytic.dyads", "analytic.dyads.rrr", "sim", "sim.run"}


@pytest.mark.parametrize(
    ("code", "fault"),
    [
        ("import analytic", "`import analytic`: write `from"),
        ("def f():\n    import numpy, sim.run as run", "`import sim.run`: write `from"),
        ("HOME = 'sim.run'", "sim.run in a string: take the name"),
        ("HOMES = {'a': ('sim',)}", "sim in a string: take the name"),
        ("START = f'import sys; from sim.run import {name}; run()'", "sim.run in a string"),
        ("START = '''\nimport analytic.reach\n'''", "analytic.reach in a string"),
        ("from  sim.run import run", "write `from sim.run import` in one line"),
    ],
)
def test_a_name_that_the_build_could_not_follow_is_refused(code: str, fault: str) -> None:
    line = code.count("\n", 0, code.find("import")) + 1 if "def" in code else 1
    with pytest.raises(RelocationError, match=re.escape(f"place.py:{line}: {fault}")):
        relocated(code.encode(), MOVED, "place.py")


def test_a_name_in_prose_stays_and_all_else_too() -> None:
    code = '''\
"""See `sim.run`; é, from sim.run import run."""
if True: from sim import run; from analytic.dyads.rrr import (  # from sim import run
    solve,
)\r
from simple import sim
from . import near
TEXT = "a floating base, see analytic.reach"
"""from sim.run import run"""
'''
    moved = code.replace("True: from sim", "True: from crankcheck.sim")
    moved = moved.replace("from analytic.dyads.rrr", "from crankcheck.analytic.dyads.rrr")
    assert relocated(code.encode(), MOVED, "place.py").decode() == moved
    assert (
        "é'; from crankcheck.sim import run"
        in relocated("x = 'é'; from sim import run".encode(), MOVED, "place.py").decode()
    )
