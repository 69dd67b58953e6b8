"""`crankcheck synth`: what it lists, writes and proves, and what it refuses."""

from pathlib import Path

import pandas as pd
import pytest
from typer.testing import CliRunner, Result

from analytic.lectures.synthesis import coupler, solutions
from analytic.lectures.synthesis.solutions import solutions_of
from models.files.reading import read_scene
from models.lectures.tasks import find_task, load_task
from reports.cli import app
from reports.lectures.design import synth as command
from reports.lectures.design.design_tables import solution_frame
from tests.worlds.command_line import flat, refused
from tests.worlds.tiers import slowly


def synth(*arguments: str) -> Result:
    return CliRunner(env={"COLUMNS": "160"}).invoke(app, ["synth", *arguments])


def written(folder: Path, text: str, head: str = 'name = "x"\nsource = "a test"\n') -> str:
    """The path of a task's file with such a text."""
    (folder / "task.toml").write_text(f"{head}{text}\n", encoding="utf-8")
    return str(folder / "task.toml")


def frame_of(kind: str, task: str) -> pd.DataFrame:
    return solution_frame(solutions_of(load_task(kind, task)).examined)


def test_kinds_and_shipped_tasks_are_listed() -> None:
    told = synth().output
    assert "coupler" in told
    assert "three-positions" in told
    assert "coupler" not in synth("stroke").output


def test_solutions_and_proof_are_written_and_what_was_left_there_is_told(tmp_path: Path) -> None:
    left = ("construction-3.html", "construction-3.svg", "solution-3.toml")
    for name in (*left, "mine.toml"):
        (tmp_path / name).write_text("x = 1\n", encoding="utf-8")
    result = synth("coupler", "three-positions", "--prove", "-o", str(tmp_path))
    assert result.exit_code == 0, result.output + result.stderr
    assert "2 mechanisms tried, 2 examined, 2 without a defect" in result.output
    assert "PROVEN" in result.output
    told = f"left there by an earlier run: {', '.join(left)}"
    assert flat(result.output).endswith(told)
    frame = pd.read_csv(tmp_path / "solutions.csv")
    scene = read_scene(tmp_path / "solution-1.toml")
    assert scene.links["input"].points["D"][0] == frame.loc[0, "input_O4D_m"]
    assert scene.ground["O2"][0] == frame.loc[0, "O2_x_m"]
    page = (tmp_path / "index.html").read_text(encoding="utf-8")
    assert "Every position is met." in page
    for number in (1, 2):
        for name in (f"solution-{number}.toml", f"construction-{number}.html"):
            assert (tmp_path / name).exists()
            assert f'href="{name}"' in page
    proof = pd.read_csv(tmp_path / "proof.csv")
    assert set(proof["engine"]) == {"reference", "mujoco", "pymunk"}
    assert proof["within"].all()


LEVER = 'mechanism = "slotted-lever"\ntime_ratio = {}\nstroke_m = {}\nrod_m = {}'


def test_what_an_engine_misses_or_only_defects_answer_is_an_exit_code(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    tight = written(tmp_path, "swing_deg = 60.0\nrocker_m = 0.2\ntolerance_deg = 1e-12")
    options = ("--prove", "--best", "1", "--engine", "mujoco")
    missed = synth("rocker", tight, *options)
    # The nearest task, which test_tasks.py looks for, takes five seconds.
    monkeypatch.setattr(solutions, "nearest", lambda task, solve: ("", []))
    ram = written(tmp_path, LEVER.format(8.0, 0.3, 0.1))  # it turns back before its lever does
    ram = synth("quick-return", ram, "--prove")
    for result, *words in (
        (missed, "NOT PROVEN", "OUT"),
        (ram, "goes 0.301", "nothing to prove"),
    ):
        assert result.exit_code == 1
        assert [part for part in words if part not in flat(result.output)] == []


def test_tolerances_are_told_but_not_near_a_change_point(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(command, "SAMPLES", 20)
    result = synth("stroke", "central", "--best", "1", "--vary", "1e-5")
    assert "of 20 mechanisms meet the task" in result.output
    assert "radial clearance" in result.output
    told = flat(synth("stroke", "isosceles", "--vary", "1e-4").output)
    assert "no sensitivity: isosceles-1: it passes a position in which links are in line" in told


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (("couplr", "x"), "did you mean coupler"),
        (("coupler", "three-position"), "three-positions"),
        (("coupler", "three-positions", "--prove", "--engine", "bulletz"), "bulletz"),
        (("coupler", "three-positions", "--vary", "0"), "--vary"),
        (("coupler", "three-positions", "--best", "0"), "--best"),
        (("coupler", "three-positions", "--prove", "--steps-per-turn", "0"), "--steps-per-turn"),
        (("coupler", "three-positions", "--engine", "mujoco"), "engines are run by --prove"),
        (("coupler", "three-positions", "-o", "/proc/nowhere"), "/proc"),
    ],
)
def test_bad_input_is_one_message(arguments: tuple[str, ...], says: str) -> None:
    refused(synth(*arguments), says)


def poses(*each: tuple[float, float, float]) -> str:
    texts = (f"{{ point_m = [{x}, {y}], angle_deg = {angle} }}" for x, y, angle in each)
    return f"positions = [{', '.join(texts)}]\n"


@pytest.mark.parametrize(
    ("kind", "task", "says"),
    [
        (
            "path",
            "points_m = [[0.0, 0.0], [0.1, 0.05], [0.22, 0.06], [0.3, 0.02], [0.34, -0.06]]\n"
            "starts = 2",
            "a search from 2 starts, no proof that there are no others",
        ),
        ("function", "power-4-points", "open starts are tried on a grid, no proof"),
        slowly("coupler", "driving-dyad", "16 examined", reason="it goes on as of a function"),
    ],
)
def test_a_search_tells_how_far_it_is_and_what_it_does_not_prove(
    kind: str, task: str, says: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(command, "TOLD_S", 0.0)
    result = synth(kind, written(tmp_path, task) if kind == "path" else task, "--best", "1")
    assert result.exit_code == 0, result.output
    assert says in flat(result.stdout)
    shares = [int(line.split()[-2]) for line in result.stderr.splitlines() if "searching" in line]
    assert len(shares) > 3
    assert shares == sorted(shares)


SAME, TURNED = (poses((0.1, 0.0, one), (0.1, 0.0, other)) for one, other in ((10, 10), (0, 90)))
LOAD = '[loads.x]\nlink = "{}"\npoint = "{}"\nforce_n = {}\ndirection_deg = {}\n'


@pytest.mark.parametrize(
    ("kind", "text", "says"),
    [
        ("rocker", poses((0, 0, 10), (0.1, 0.2, 10)), "pole is at infinity, along 153.4 deg"),
        ("coupler", f"{SAME}moving_m = [[0.0, 0.1], [0.1, 0.0]]", "positions 1 and 2 coincide"),
        ("rocker", SAME, "positions 1 and 2 coincide"),
        ("rocker", TURNED, "P is the pole, and so the rocker's pivot O4: give rocker_m"),
        (
            "stroke",
            f"stroke_m = 0.1\n{LOAD.format('rid', 'A', 1, 0)}",
            "loads.x.link: found rid; use one of crank, rod",
        ),
        ("quick-return", LEVER.format(1.5, 0.1, 0.0001), "take a longer rod"),
    ],
)
def test_what_no_mechanism_does_is_said(tmp_path: Path, kind: str, text: str, says: str) -> None:
    refused(synth(kind, written(tmp_path, text)), says)


def test_fixed_pivots_stand_where_wished(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(coupler, "CHOSEN", 4)
    four = poses((0.0, 0.0, 10.0), (0.2, 0.1, 35.0), (0.35, 0.3, 80.0), (0.5, 0.35, 100.0))
    region = "pivots_in = { from_m = [-0.3, -0.3], to_m = [0.8, 0.8] }\n"
    frame = frame_of("coupler", written(tmp_path, four + region))
    assert len(frame) == 4
    for column in ("O2_x_m", "O2_y_m", "O4_x_m", "O4_y_m"):
        assert frame[column].between(-0.3, 0.8).all()


THREE = find_task("coupler", "three-positions").read_text(encoding="utf-8")


def test_wishes_that_are_not_fulfilled_are_told_and_ranked_behind(tmp_path: Path) -> None:
    task = written(tmp_path, "least_transmission_deg = 50.0", THREE)
    assert [*frame_of("coupler", task)["remarks"]] == ["", "transmission below 50 deg"]


def test_loads_are_weighed(tmp_path: Path) -> None:
    torques = []
    for force in (100.0, 200.0):
        load = LOAD.format("coupler", "C", force, -90.0)
        task = written(tmp_path, f"speed_rad_s = 0.01\n{load}", THREE)
        torques.append(frame_of("coupler", task)["largest_torque_n_m"][0])
    assert torques[1] == pytest.approx(2.0 * torques[0], rel=1e-3)


def test_a_rocker_about_a_point_of_the_body_does_its_task(tmp_path: Path) -> None:
    task = written(tmp_path, f"rocker_m = 0.2\n{TURNED}")
    assert synth("rocker", task, "--best", "1").exit_code == 0
