"""Known failures: a cell that fails as a file says is `known`; any other failure is out."""

import math
import tomllib
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import pytest

import crankcheck
from models.errors import CrankcheckError
from models.files.reading import every_shipped, load_scene
from reports.judge.cell import Cell, Checked
from reports.judge.known import SHIPPED, KnownFailure, known_of, marked, read_known
from reports.judge.rules.rule import Finding
from reports.judge.tolerance import parse
from sim.registry import ENGINES
from tests.worlds.command_line import crank, flat, refused, told
from tests.worlds.own_models import SLIDER_CRANK
from tests.worlds.tiers import slow

WIDE = "angle=1,position=1,gap=1,velocity=1,velocity-differenced=1"
WIDE += ",acceleration=1,acceleration-differenced=1"
LINE = (
    "verify fourbar-lecture-1 --engine mujoco --profile as-shipped --turns 0.5 --no-convergence "
    f"--tol {WIDE}"
)
OUT = f"{LINE} --tol angle=1e-5"


KNOWN = KnownFailure(scene="s", engine="e", reason="why", rules={"CC103": 2.0, "CC110": math.inf})


def bare(
    *failing: tuple[str, float | None],
    status: str = "ok",
    name: str = "fourbar-lecture-1",
    engine: str = "mujoco",
    judged: str = "CC103 CC110",
) -> Checked:
    """A cell with findings alone: of rules that fail, and of the other ``judged`` ones."""
    return Checked(
        status=status,
        reason="",
        stopped_at_s=0.0,
        errors=None,
        limits={},
        cell=Cell(load_scene(name), engine, "tuned", 1e-3, 1, drive="free"),
        findings=tuple(
            Finding(rule, "fail" if rule in dict(failing) else "pass", "", dict(failing).get(rule))
            for rule in dict.fromkeys([rule for rule, _ in failing] + judged.split())
        ),
        known=KNOWN,
    )


@pytest.mark.parametrize(
    ("one", "verdict", "says"),
    [
        (bare(("CC103", 3.0), ("CC110", 9.0)), "known", ""),
        (bare(("CC103", 3.1), ("CC110", 9.0)), "out", "CC103 has grown from 2 to 3.1"),
        (bare(("CC103", math.nan), ("CC110", 9.0)), "out", "CC103 has grown from 2 to inf"),
        (bare(("CC103", 1.0), ("CC104", 1.0)), "out", "CC104 is not known to fail"),
        (bare(("CC103", 1.0)), "known", "CC110 known to fail, passed: remove"),
        (bare(), "within", "CC103 CC110 known to fail, passed: remove"),
        (bare(judged="CC103"), "within", "CC103 known to fail, passed: remove"),
        (bare(("CC101", None), ("CC103", 1.0), status="locked"), "out", "CC101 is not known"),
    ],
)
def test_a_failure_is_known_by_its_rules_and_by_errors_up_to_half_as_large_again(
    one: Checked, verdict: str, says: str
) -> None:
    assert one.verdict == verdict
    assert says in one.known_text
    assert ("CC110, known: why" in one.known_text) is (says == "")


def test_a_failure_that_ends_in_another_way_is_not_the_known_one() -> None:
    known = KnownFailure(
        scene="s", engine="e", status="diverged", reason="why", rules={"CC101": math.inf}
    )
    diverged = replace(bare(("CC101", None), status="diverged"), known=known)
    assert diverged.verdict == "known"
    crashed = replace(diverged, status="crashed")
    assert crashed.verdict == "out"
    assert "it ended crashed, the known failure diverged" in crashed.known_text


def test_a_file_that_a_run_wrote_turns_its_cells_into_known_ones(tmp_path: Path) -> None:
    written, junit = tmp_path / "known.toml", tmp_path / "j.xml"
    first = told(f"{OUT} --write-known", written, code=1)
    (entry,) = tomllib.loads(written.read_text())["known"]
    assert entry["rules"].keys() == {"CC103"}
    assert f"{entry['rules']['CC103']:.3g} rad at t" in first
    text = written.read_text().replace(entry["reason"], "as it was agreed")
    written.write_text(text)
    output = told(f"{OUT} --strict-known --known", written, "--junit", junit)
    assert "known fourbar-lecture-1" in output
    assert "CC103, known: as it was agreed" in flat(output)
    assert "WITHIN TOLERANCE: 0 of 1 cell (1 scene x 1 engine); 1 known failure" in output
    case = ElementTree.parse(junit).find(".//testcase/skipped")
    assert case is not None
    assert "as it was agreed" in str(case.get("message"))
    # Writing again keeps the reason.
    again = tmp_path / "again.toml"
    told(f"{OUT} --write-known", again, "--known", written)
    assert "as it was agreed" in again.read_text()
    told(f"{OUT} --write-known", written, code=1)
    assert "as it was agreed" in written.read_text()
    asked = {"tolerance": parse([WIDE, "angle=1e-5"]), "turns": 0.5, "converge": False}
    cell = ("fourbar-lecture-1", "mujoco", "as-shipped")
    assert crankcheck.check(*cell, **asked, known=written).verdict == "known"
    # Longer steps have more error; a second rule fails; all is right.
    grown = told(f"{OUT} --steps-per-turn 60 --turns 2 --known", written, code=1)
    assert "CC103 has grown from 0.00065 to" in flat(grown)
    other = told(f"{OUT} --tol velocity=1e-5 --known", written, code=1)
    assert "CC106 is not known to fail" in flat(other)
    assert "CC103 known to fail, passed: remove" in flat(told(f"{LINE} --known", written))
    told(f"{LINE} --strict-known --known", written, code=1)


@slow("a model runs in processes of its own, and causes of a log are searched")
def test_a_log_and_a_model_of_the_user_have_known_failures_too(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    told("run fourbar-lecture-1 --engine mujoco --turns 0.1 -o log.csv")
    judge = "judge fourbar-lecture-1 log.csv --target 1e-12"
    told(f"{judge} --write-known log.toml", code=1)
    assert "KNOWN FAILURE" in told(f"{judge} --known log.toml --junit log.xml")
    suite = ElementTree.parse("log.xml")
    assert suite.find(".//skipped") is not None
    assert suite.find(".//failure") is None
    told("judge fourbar-lecture-1 log.csv --target 1 --known log.toml --strict-known", code=1)
    Path("engine.xml").write_text(SLIDER_CRANK)
    model = "verify --mjcf engine.xml --drive motor --speed 10 --turns 1 --no-convergence"
    model += " --tol displacement=1e-12"
    told(f"{model} --write-known model.toml", code=1)
    assert "KNOWN FAILURE as written" in told(f"{model} --known model.toml")


FAULTY = {
    "[[known]]\nscene = 'a'": "known.1.engine: missing",
    "[[known]]\nscene = 'a'\nengine = 'b'\nreason = 'c'\nrules = { CC13 = 1 }":
        "'CC13' is no rule; did you mean CC1",
    "[[known]]\nscene = 'a'\nengine = 'b'\nreason = 'c'\nrules = {}": "known.1.rules",
    "[[knwon]]\nscene = 'a'": "knwon: unknown key; did you mean known",
    "known": "not valid TOML",
    2 * "[[known]]\nscene = 'a'\nengine = 'b'\nreason = 'c'\nrules = {CC110 = 1}\n":
        "a b prescribed is there twice",
}  # fmt: skip


@pytest.mark.parametrize("text", FAULTY)
def test_a_faulty_file_is_refused_before_anything_runs(text: str, tmp_path: Path) -> None:
    path = tmp_path / "known.toml"
    path.write_text(text)
    with pytest.raises(CrankcheckError, match=FAULTY[text]):
        read_known(path)
    refused(crank(*LINE.split(), "--known", path), "--known")
    refused(crank(*LINE.split(), "--known", path, "--write-known", path), "which is read")


def test_the_shipped_file_is_for_shipped_scenes_alone(tmp_path: Path) -> None:
    shipped = read_known(SHIPPED)
    assert {one.scene for one in shipped} <= every_shipped().keys()
    assert {one.engine for one in shipped} <= ENGINES.keys()
    one = shipped[0]
    own = tmp_path / "own.toml"
    own.write_text(every_shipped()[one.scene].read_text())
    cells = [bare(name=one.scene, engine=one.engine)]
    assert marked(cells, known_of(None, [one.scene]))[0].known == one
    assert marked(cells, known_of(None, [str(own)]))[0].known is None


@slow("a toggle press in pymunk, and the settings that are tried to mend it")
def test_a_shipped_cell_that_is_known_ends_with_0_and_spoilt_with_1() -> None:
    line = "verify toggle-press --engine pymunk --profile tuned --no-convergence"
    assert "300 iterations hold" in flat(told(line))
    output = flat(told(f"{line} --tol displacement=1e-9", code=1))
    assert "CC104 is not known to fail" in output
    assert "OUT OF TOLERANCE: 1 of 1 cell" in output
