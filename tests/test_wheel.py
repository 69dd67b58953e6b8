"""The wheel: built once without a network, listed, and installed beside this environment."""

import os
import re
import shutil
import subprocess
import sys
import tarfile
from pathlib import Path
from zipfile import ZipFile

import pytest
from hatchling.build import build_editable

from hatch_build import RelocationError, relocated
from tests.worlds.command import VARIABLE, shadows
from tests.worlds.tiers import slow, slowly

ROOT = Path(__file__).parents[1]
PACKAGES = ("models", "analytic", "sim", "reports")
COMMANDS = [
    "tests/test_face.py",
    "tests/test_readme.py",
    "tests/reports/cli/test_ending.py",
    "tests/reports/cli/test_interrupt.py",
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
    subprocess.run([*pip, "--no-compile", "--no-deps", "--no-index", str(wheel)], check=True)
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
    env = {name: text for name, text in os.environ.items() if name != "PYTHONPATH"} | variables
    words = [str(part) for part in command]
    return subprocess.run(words, cwd=cwd, env=env, capture_output=True, text=True, check=False)


def test_it_installs_one_name_and_but_for_our_names_the_code_of_the_checkout(wheel: Path) -> None:
    with ZipFile(wheel) as archive:
        code = {name: archive.read(name) for name in archive.namelist()}
    other, ours = sorted({name.partition("/")[0] for name in code}, reverse=True)
    assert ours == "crankcheck"
    assert re.fullmatch(r"crankcheck-[\d.]+\.dist-info", other)
    files = {
        f"{'' if package == ours else 'crankcheck/'}{path.relative_to(ROOT).as_posix()}": path
        for package in (ours, *PACKAGES)
        for path in (ROOT / package).rglob("*")
        if path.is_file() and path.suffix != ".pyc"
    }
    assert {name for name in code if not name.startswith(other)} == set(files)
    assert {"crankcheck/py.typed", "crankcheck/models/scenes/kinematics/shaper.toml"} <= set(files)
    changed = [name for name, path in files.items() if code[name] != path.read_bytes()]
    assert len(changed) > 100
    for name, path in files.items():
        before = path.read_bytes()
        assert re.sub(rb"\bfrom crankcheck\.(?!__)", b"from ", code[name]) == before, name


@slow("two more builds, of which a release needs the first")
def test_the_archive_of_the_sources_builds_the_same_wheel(wheel: Path, tmp_path: Path) -> None:
    with tarfile.open(built(ROOT, tmp_path / "sdist", "sdist")) as archive:
        archive.extractall(tmp_path, filter="data")
    (source,) = tmp_path.glob("crankcheck-*")
    assert built(source, tmp_path / "wheel", "wheel").read_bytes() == wheel.read_bytes()


def test_an_editable_install_is_the_checkout(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(ROOT)
    with ZipFile(tmp_path / build_editable(str(tmp_path))) as archive:
        code = [name for name in archive.namelist() if "dist-info" not in name]
        assert code == ["_crankcheck.pth"]
        assert archive.read("_crankcheck.pth").decode().strip() == str(ROOT)


@pytest.mark.parametrize(
    "module", [False, slowly(True, reason="a second start: `python -m` looks into the folder")]
)
@slow("a wheel and an environment of its own: 9 s")
def test_packages_of_our_names_in_the_users_folder_hide_nothing(
    installed: Path, mine: Path, module: bool
) -> None:
    start = [installed / "python", "-m", "crankcheck"] if module else [installed / "crankcheck"]
    done = ran(*start, "verify", "fourbar-lecture-1", "--engine", "mujoco", "--jobs", 2, cwd=mine)
    assert (done.returncode, done.stderr) == (0, "")
    assert "WITHIN TOLERANCE" in done.stdout


TYPED = {
    "solve('shaper', [0.0]).frame()": "pandas.core.frame.DataFrame",
    "check('shaper').findings[0].level": "Literal['pass'] | Literal['advice'] | Literal['fail']",
    "judge('shaper', 'log.csv', target=1e-3)": "crankcheck.reports.requests.judge.LogVerdict",
    "judge('shaper', cc.run('shaper'))": "crankcheck.reports.requests.compare.CellVerdict",
    "report('out')": "pathlib.Path",
}
"""What a user's type checker makes of calls."""
REFUSED = {
    "solve(3)": "arg-type",
    "run('shaper', steps=90)": "call-arg",
    "judge('shaper', cc.run('shaper'), step_s=1e-3)": "call-overload",
    "undo": "attr-defined",
}


@slow("ten seconds of mypy; that types are right in the checkout, `make lint` says")
def test_a_type_checker_sees_through_the_wheel(installed: Path, mine: Path) -> None:
    lines = [*(f"reveal_type(cc.{call})" for call in TYPED), *(f"cc.{call}" for call in REFUSED)]
    head = "from pathlib import Path\nimport numpy as np, crankcheck as cc\n"
    text = "from crankcheck.testing import assert_within\nassert_within('a', 'b', angle='x')\n"
    (mine / "script.py").write_text(head + "\n".join(lines) + "\n" + text)
    checker = [sys.executable, "-m", "mypy", "--python-executable", installed / "python"]
    kept = ("--cache-dir", ROOT / ".mypy_cache" / "wheel")  # of numpy and pandas, which take long
    done = ran(*checker, *kept, "--strict", "script.py", cwd=mine)
    told = done.stdout.replace("Union[", "").replace("builtins.", "")
    revealed = re.findall('Revealed type is "(.*)"', told)
    assert revealed == list(TYPED.values()), done.stdout
    assert re.findall(r"error: .*\[(.*)\]", told) == [*REFUSED.values(), "arg-type"], done.stdout


FIVE_LINES = """\
import crankcheck

verdict = crankcheck.check("fourbar-lecture-1", "mujoco")
print(verdict.verdict)
print(verdict)
"""
SOLVES = """
motion = crankcheck.solve(crankcheck.load_scene("shaper"), [0.0])
print(type(motion).__module__, crankcheck.__file__)
"""


def test_import_is_the_wheel_and_five_lines_print_a_verdict(
    wheel: Path, mine: Path, tmp_path: Path
) -> None:
    """What is in the wheel, as pip would lay it out: before the checkout, which is on the path as
    well."""
    (mine / "five.py").write_text(FIVE_LINES + SOLVES)
    with ZipFile(wheel) as archive:
        archive.extractall(tmp_path / "site")
    done = ran(sys.executable, "five.py", cwd=mine, PYTHONPATH=str(tmp_path / "site"))
    assert (done.returncode, done.stderr) == (0, "")
    module, path = done.stdout.splitlines()[-1].split()
    assert module == "crankcheck.reports.requests.solution"
    assert Path(path).is_relative_to(tmp_path / "site")
    assert done.stdout.startswith("within\nprofile tuned (gated)\n")
    assert "\nok fourbar-lecture-1      mujoco 1.2e-07 " in done.stdout
    assert "\nWITHIN TOLERANCE: 1 cell (1 scene x 1 engine)\n" in done.stdout


@slow("a minute: all tests that start the command as a process, once more with that of the wheel")
def test_tests_of_the_command_pass_against_that_of_the_wheel(installed: Path) -> None:
    command = [sys.executable, "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider", *COMMANDS]
    done = ran(*command, cwd=ROOT, **{VARIABLE: str(installed / "crankcheck")})
    assert done.returncode == 0, done.stdout


@slow("pip, a contract and a sweep in 12 s; what only it finds is an engine beside the wheel")
def test_an_engine_that_pip_installs_beside_the_wheel_holds_the_contract(
    installed: Path, mine: Path
) -> None:
    """In an environment of its own, as a package of others is no guest in that of all tests."""
    site = mine / "site"
    pip = [sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--no-build-isolation"]
    shutil.copytree(ROOT / "examples" / "engine", mine / "source")
    subprocess.run([*pip, "--target", str(site), str(mine / "source")], check=True)
    path = {"PYTHONPATH": str(site)}
    done = ran(installed / "crankcheck", "engines", "check", "penalty", cwd=mine, **path)
    assert (done.returncode, "1.0, 25 of 25 clauses" in done.stdout) == (0, True), done.stdout
    sweep = "sweep fourbar-lecture-1 --engine penalty --profile tuned --no-timing -o out"
    steps = ("--steps-per-turn", "90,180")
    done = ran(installed / "crankcheck", *sweep.split(), *steps, cwd=mine, **path)
    assert (done.returncode, "2 cells: 2 run now" in done.stdout) == (0, True), done.stderr
    done = ran(installed / "crankcheck", "report", "out", "-o", "page.html", cwd=mine)
    assert done.returncode == 0, done.stderr
    assert "penalty 1.0" in (mine / "page.html").read_text(encoding="utf-8")


MOVED = {"analytic", "analytic.prepared", "analytic.dyads", "analytic.dyads.rrr", "sim", "sim.run"}


@pytest.mark.parametrize(
    ("code", "fault"),
    [
        ("import analytic", "`import analytic`: write `from"),
        ("def f():\n    import numpy, sim.run as run", "`import sim.run`: write `from"),
        ("HOME = 'sim.run'", "sim.run in a string: take the name"),
        ("HOMES = {'a': ('sim',)}", "sim in a string: take the name"),
        ("START = f'import sys; from sim.run import {name}; run()'", "sim.run in a string"),
        ("START = '''\nimport analytic.prepared\n'''", "analytic.prepared in a string"),
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
TEXT = "a floating base, see analytic.prepared"
"""from sim.run import run"""
'''
    moved = code.replace("True: from sim", "True: from crankcheck.sim")
    moved = moved.replace("from analytic.dyads.rrr", "from crankcheck.analytic.dyads.rrr")
    assert relocated(code.encode(), MOVED, "place.py").decode() == moved
    moved = relocated("x = 'é'; from sim import run".encode(), MOVED, "place.py").decode()
    assert "é'; from crankcheck.sim import run" in moved
