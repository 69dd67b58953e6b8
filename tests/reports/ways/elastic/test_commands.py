"""What stores, compares and shows cells takes those of elastic links; and their logs are judged as
runs are, beside the beam and the exact chain."""

import json
import shlex
from pathlib import Path

import pandas as pd
import pytest

import crankcheck as face
from models.errors import CrankcheckError
from models.files.reading import find_scene, load_scene
from reports.judge.cell import Cell
from reports.plan.chosen_study import StudyChoice, chosen_study
from reports.plan.grid import grid
from reports.plan.requirements import counted_released, scenes_of, under_control
from reports.plan.study import load_study
from tests.worlds.command_line import crank_alone

MUJOCO = ["--engine", "mujoco", "--profile", "tuned", "--jobs", 1]
TURN = ["--steps-per-turn", "720", "--turns", "1"]
NAME, PULSE, CONTROLLED = (f"fourbar-elastic{end}" for end in ("", "-pulse", "-controlled"))


def crankcheck(*words: object, code: int = 0) -> str:
    """The output of a command, with its lines as one."""
    result = crank_alone(*words)
    assert result.exit_code == code, result.output
    return " ".join(result.output.split())


def test_a_verification_is_kept_with_what_links_were_given_as(tmp_path: Path) -> None:
    asked = [*MUJOCO, "--segments", 4, "--no-convergence", *TURN]
    told = crankcheck("verify", NAME, *asked, "-o", tmp_path / "verified")
    assert "against the solved motion of the beam with foreshortening" in told
    assert "closed form" not in told
    rows = json.loads((tmp_path / "verified" / "verify.json").read_text())["cells"]
    assert {(row["segments"], row["springs"]) for row in rows} == {(4, "plain")}
    assert rows[0]["place_pure"] == rows[0]["deflection_pure"]
    assert rows[0]["chain_pure"] == pytest.approx(0.05, rel=0.1)
    assert "0 worse" in crankcheck("diff", *[tmp_path / "verified"] * 2)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("verify fourbar-lecture-1 --segments 4", "no scene has elastic links"),
        ("verify elastic --segments 1", "an elastic link has 2 to 64 segments"),
        ("verify elastic --springs soft", "use plain, corrected or beam"),
        (f"verify {NAME} --free", "free motion has no known period"),
        (f"tune {NAME} --engine mujoco --target 1e-3", f"`crankcheck sweep {NAME} --segm"),
        (
            f"tune {CONTROLLED} --engine mujoco --target 1e-3",
            f"`crankcheck sweep {CONTROLLED} --free --segments 4,8,16 -o DIR`",
        ),
        (
            f"sweep {CONTROLLED} --engine mujoco --segments 4 -o none",
            "it has no turns; `crankcheck sweep --free` runs it so",
        ),
        (f"advise {NAME} --dt 0.01 --speed 7 --target 1e-3", "takes rigid links"),
    ],
)
def test_what_makes_no_sense_is_refused(words: str, said: str) -> None:
    assert said in crankcheck(*words.split(), code=2)


@pytest.mark.parametrize("name", [PULSE, CONTROLLED])
def test_a_log_of_elastic_links_that_were_let_go_is_not_judged(name: str, tmp_path: Path) -> None:
    log = tmp_path / "log.csv"
    asked = ["--segments", "2", "--duration", "0.05"]
    assert "next:" not in crankcheck("run", name, *asked, "-o", log)
    said = "logs of elastic links in free motion are not judged yet"
    assert said in crankcheck("judge", name, log, "--target", "1e-3", code=2)
    with pytest.raises(CrankcheckError, match=said):
        face.compare(name, pd.read_csv(log), segments=2)


def test_what_a_controller_drives_keeps_it_when_it_is_let_go_and_has_no_turns() -> None:
    (own,) = scenes_of([CONTROLLED], free=True)
    assert own.is_free
    assert own == under_control(load_scene(CONTROLLED))
    assert own.loads
    with pytest.raises(CrankcheckError, match="it has no turns; `run` runs it"):
        face.check(CONTROLLED, segments=4)


def test_a_sweep_steps_elastic_links_as_their_segments_ask() -> None:
    """With the shipped study's steps, and let go at 4 ms, all would come apart."""

    def cells(*names: str, **choice: object) -> list[Cell]:
        asked = StudyChoice(list(names), ["mujoco"], ["tuned"], **choice)  # type: ignore[arg-type]
        study = chosen_study(load_study(None), asked, is_shipped=True)
        return [task.cell for task in grid(study).tasks]

    both = cells(NAME, "fourbar-lecture-1", segments=[3])
    steps = [cell.steps_per_turn for cell in both if cell.scene.name == NAME]
    assert steps == pytest.approx([steps[0] * each for each in (1.0, 2.0, 4.0)])
    assert len(both) == 3 + 7
    free = {"free": True, "segments": [4], "duration_s": 0.1}
    for name in (PULSE, CONTROLLED):
        held_s, _ = counted_released(under_control(load_scene(name)), None, 0.1, 4, "plain")
        assert [cell.dt_s for cell in cells(name, **free)] == [held_s, held_s / 2, held_s / 4]
        assert [cell.dt_s for cell in cells(name, dt_s=[5e-4], **free)] == [5e-4]


def test_what_is_let_go_is_swept_and_timed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("reports.sweep.measured.REPEAT_S", 1e-5)  # nobody compares these times
    asked = [*MUJOCO, "--free", "--segments", 4, "--dt", "1e-3,5e-4", "--duration", 0.1]
    told = crankcheck("sweep", PULSE, "-o", tmp_path / "s", *asked)
    assert "2 run now" in told
    assert "2 timed now" in told
    asked = [*MUJOCO, "--segments", 4, "--no-convergence", "--duration", 0.1]
    told = crankcheck("verify", PULSE, *asked)  # where it is named
    assert "elastic links, profile tuned" in told
    assert "WITHIN TOLERANCE" in told


def test_a_link_that_stretches_alone_is_a_row_with_its_reason(tmp_path: Path) -> None:
    text, head = find_scene(PULSE).read_text(encoding="utf-8"), "[elastic.coupler]"
    stretched = text.replace(head, f"{head}\nbends = false\nstretches = true")
    (tmp_path / "axial.toml").write_text(stretched)
    told = crankcheck("verify", tmp_path / "axial.toml", "--engine", "mujoco", code=2)
    assert "elastic.coupler stretches, and a chain of segments does not" in told


STEP_S = 0.0011843018022380978
FEW = ["--step", STEP_S, "--segments", "4"]


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("elastic") / "log.csv"


@pytest.fixture(scope="module")
def said(log: Path) -> str:
    """What `run` says when it has written the log."""
    return crankcheck("run", NAME, "--segments", 4, *TURN, "-o", log)


def test_a_log_is_judged_by_the_command_of_its_run(said: str, log: Path, tmp_path: Path) -> None:
    head = log.read_text().splitlines()[0]
    assert "coupler_deflection_m" in head
    assert "coupler-1" not in head
    words = shlex.split(said.partition("next: crankcheck ")[2])
    told = crankcheck(*words, "-o", tmp_path / "log.html")
    assert "deflection of coupler" in told
    assert "segments of coupler" in told
    assert "closed form" not in told
    assert (tmp_path / "log.html").stat().st_size > 100_000


@pytest.mark.parametrize(
    ("column", "factor", "segments", "rule"),
    [
        ("coupler_deflection_m", 0.8, 4, "CC131"),
        ("coupler_deflection_m", 1.0, 8, "CC132"),
        ("coupler_extension_m", 300.0, 4, "CC133"),
        ("rocker_theta_rad", 1.0001, 4, "CC103"),
    ],
)
def test_what_is_wrong_in_a_log_is_seen(
    said: str, log: Path, column: str, factor: float, segments: int, rule: str, tmp_path: Path
) -> None:
    """Other segments than were run as well."""
    frame = pd.read_csv(log)
    frame[column] *= factor
    frame.to_csv(tmp_path / "log.csv", index=False)
    told = crankcheck("judge", NAME, tmp_path / "log.csv", *FEW[:3], segments, code=1)
    assert rule in told
    assert "causes are not searched for elastic links" in told


def test_a_drive_of_its_own_and_a_frame_of_python_are_told(said: str, log: Path) -> None:
    told = crankcheck("judge", NAME, log, *FEW, "--drive", "fitted", code=2)
    assert "leave --drive out" in told
    assert face.judge(NAME, log, step_s=STEP_S, segments=4).verdict == "within"
    errors = face.compare(NAME, pd.read_csv(log), segments=4)
    assert "deflection" in {row.quantity for row in errors.errors.rows}
    with pytest.raises(face.CrankcheckError, match="segments"):
        face.judge("fourbar-lecture-1", log, step_s=STEP_S, segments=4)


def test_a_log_starts_within_the_limit_of_its_run() -> None:
    """Joints are solved for, whatever the beam is off by in its places."""
    given = {"segments": 4, "springs": "beam"}
    run = face.run(NAME, engine="exudyn", steps_per_turn=360, turns=1, **given)
    of_run = face.judge(NAME, run)
    of_log = face.judge(NAME, run.motion, step_s=2.0 * STEP_S, **given)
    assert (of_run.verdict, of_log.verdict) == ("within", "within")
    first, second = (
        next(finding.limit for finding in verdict.findings if finding.rule == "CC116")
        for verdict in (of_run, of_log)
    )
    assert first == pytest.approx(second, rel=1e-6)
