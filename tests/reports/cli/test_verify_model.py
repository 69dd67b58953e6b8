"""`crankcheck verify --mjcf`: what it takes, what it refuses, and what it writes."""

import json
import re
from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree

import pandas as pd
import pytest
from rich.console import Console

from models.files.reading import load_scene
from reports.own_model.account import CheckedLine, ModelAccount, checked_line, read_here
from reports.own_model.judged import JudgedModel, judged_lines
from reports.requests import verify_model
from reports.requests.verify import VerifyRequest
from reports.requests.verify_model import IN_FOLDER
from tests.worlds.command_line import crank, flat, told
from tests.worlds.own_models import SLIDER_CRANK
from tests.worlds.tiers import slow, slowly

DRIVEN = "verify --mjcf engine.xml --drive motor --speed 10 --turns 1"
ONCE = f"{DRIVEN} --no-convergence"
INCLUDING = SLIDER_CRANK.replace('<option timestep="0.002"/>', '<include file="parts/option.xml"/>')


def run_here(account: ModelAccount, _: object, done: Callable[[CheckedLine], None]) -> JudgedModel:
    return judged_lines(account, checked_line, done)


@pytest.fixture(autouse=True)
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with models; reading and running them takes no process here, as starting one takes
    longer than all of it (tests/test_docs.py has it)."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(verify_model, "read", lambda request, _: read_here(request))
    monkeypatch.setattr(verify_model, "run_lines", run_here)
    Path("engine.xml").write_text(SLIDER_CRANK)
    Path("parts").mkdir()
    head = '<?xml version="1.0"?><!-- as crankcheck writes files, so that it may replace this -->'
    Path("parts/option.xml").write_text(f'{head}<mujoco><option timestep="0.002"/></mujoco>')
    Path("whole.xml").write_text(INCLUDING)
    return tmp_path


REFUSED = {
    "verify --mjcf engine.xml": "--speed is missing: .* rad/s",
    "verify --mjcf engine.xml --speed 10": "engine.xml: --drive is missing: .* drivable: motor",
    f"{DRIVEN} --drive moter": "no joint of that name; did you mean motor",
    f"{DRIVEN} --drive bore": "--drive 'bore': it is a slide, .* drivable: motor",
    f"{DRIVEN} --speed nan": "--speed nan: give",
    f"{DRIVEN} --start inf": "--start inf: give an angle",
    f"{DRIVEN} --branch piston=2": "--branch 'piston=2': give NAME=1",
    f"{DRIVEN} --dt 1e-3 --steps-per-turn 720": "both set the step",
    f"{DRIVEN} shaper": "--mjcf and SCENE: .* leave out one",
    f"{DRIVEN} --json engine.xml": "engine.xml, which is read",
    f"{DRIVEN} --mjcf whole.xml --csv parts/option.xml":
        "--csv parts/option.xml: that is .*parts/option.xml, which is read",
    "verify fourbar-lecture-1 --drive motor": "with --mjcf FILE",
    **{
        f"{DRIVEN} {option}": f"--mjcf and {option.split()[0]}"
        for option in ("--engine mujoco", "--profile tuned", "--jobs 2", "--baseline .", "--free")
    },
    **{
        f"verify fourbar-lecture-1 {option}":
        f"{option.split()[0]}: for a model of your own; name it with --mjcf"
        for option in ("--speed 3", "--key home", "--start 3", "--branch C=1",
                       "--write-scene a.toml", "--limit-s 3", "--memory-gb 3")
    },
}  # fmt: skip


@pytest.mark.parametrize("line", REFUSED)
def test_what_can_not_be_asked_is_refused_before_anything_is_written(line: str) -> None:
    before = sorted(Path().rglob("*"))
    result = crank(*line.split())
    assert result.exit_code == 2, result.output
    said = flat(result.stderr)
    assert said.count("crankcheck: ") == 1
    assert re.search(REFUSED[line], said), said
    assert sorted(Path().rglob("*")) == before
    assert Path("engine.xml").read_text() == SLIDER_CRANK


def test_every_output_is_written_over_an_earlier_one_and_holds_what_it_should() -> None:
    out = Path("out")
    out.mkdir()
    for name in (*IN_FOLDER, "mine.txt"):
        (out / name).write_text("of an earlier run")
    more = "--write-scene mine.toml --json mine.json --steps-per-turn 720"
    told(f"{DRIVEN} -o out {more}", code=1)
    assert {path.name for path in out.iterdir()} == {*IN_FOLDER, "mine.txt"}
    kept = [path.name for path in out.iterdir() if path.read_bytes() == b"of an earlier run"]
    assert kept == ["mine.txt"]
    assert load_scene("mine.toml") == load_scene(out / "scene.toml")
    found = json.loads(Path("mine.json").read_text())
    assert found == json.loads((out / "verify.json").read_text())
    profiles = [cell["profile"] for cell in found["cells"]]
    assert profiles == ["as-written", "contacts-off", "gravity-off", "recommended"]
    assert found["verdict"] == "out"
    assert found["cells"][0]["dt_s"] == pytest.approx(0.000872664625997, rel=1e-12)
    assert found["cells"][-1]["gains"][0] > 100
    assert found["joints"][0]["joint"] == "wrist"
    assert set(found["joints"][0]["gap_m"]) == {"as-written", "contacts-off", "recommended"}
    kinds = {group["kind"]: group for group in found["model"]["disturbances"]}
    assert kinds["contacts"]["texts"] == ["piston touches rod in 100% of the poses"]
    bodies = {row["body"] for row in found["cells"][0]["errors"]}
    assert bodies >= {"crank", "rod", "piston", "wrist"}
    cases = list(ElementTree.parse(out / "verify.junit.xml").iter("testcase"))
    assert [case.find("failure") is not None for case in cases] == [True, False, False, False]
    assert len(pd.read_csv(out / "verify.csv")) == 4
    assert set(pd.read_parquet(out / "errors.parquet")["profile"]) == set(profiles)
    assert (out / "recommended.diff").read_text().startswith("--- engine.xml\n+++ engine.xml\n")
    assert "<title>crankcheck: engine.xml</title>" in (out / "page.html").read_text()


LATIN = '<?xml version="1.0" encoding="ISO-8859-1"?><!-- \xe9 --><mujoco'
LATE = "</worldbody><include file='parts/late.xml'/>"


@pytest.mark.parametrize(
    ("text", "why"),
    [
        slowly(
            SLIDER_CRANK.replace("<mujoco", LATIN, 1), "the file is not UTF-8", reason="as below"
        ),
        (SLIDER_CRANK.replace("</worldbody>", LATE), "its includes override the file itself"),
    ],
)
def test_what_can_not_be_a_diff_is_in_a_text_and_no_diff_is_left(text: str, why: str) -> None:
    Path("parts/late.xml").write_text('<mujoco><option integrator="Euler"/></mujoco>')
    Path("engine.xml").write_bytes(text.encode("latin-1"))
    Path("out").mkdir()
    Path("out/recommended.diff").write_text("--- of an earlier run\n")
    told(f"{ONCE} -o out", code=1)
    assert Path("out/recommended.diff").read_text() == ""
    recommended = Path("out/recommended.txt").read_text()
    assert recommended.startswith(f"Recommended:\n{why}: set in <option>: ")


@slow("a second: two verifications; their cells are compared in tests/reports/diff")
def test_two_such_folders_can_be_compared() -> None:
    told(f"{ONCE} -o old", code=1)
    Path("engine.xml").write_text(SLIDER_CRANK.replace("<option", '<option solver="PGS"'))
    told(f"{ONCE} -o new", code=1)
    result = crank("diff", "old", "new")
    assert result.exit_code in (0, 1), result.output
    assert "0 new, 0 missing" in result.stdout


def test_all_that_is_asked_reaches_the_request() -> None:
    request = VerifyRequest(
        mjcf=Path("engine.xml"), drive="motor", speed_rad_s=-3.0, start_deg=20.0, turns=0.5,
        branch=["piston=+1"], dt_s=1e-3, tolerance=["angle=1e-2"], converge=False,
        write_scene=Path("a.toml"),
    )  # fmt: skip
    nowhere = Console(quiet=True)
    verify_model.verify_model(request, nowhere, nowhere)
    scene = load_scene("a.toml")
    assert scene.driver.law.speed_rad_s == -3.0
    assert scene.branch == {"piston": 1}
    one = verify_model._asked(request)
    assert (one.turns, one.dt_s, one.tolerance, one.converge) == (0.5, 1e-3, {"angle": 1e-2}, False)
