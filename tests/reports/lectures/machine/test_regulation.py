"""`crankcheck cycle` and `crankcheck flywheel`: what they print and write, and mistakes."""

import json
import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import crankcheck
from models.files.assemble import scene_text
from models.files.reading import load_scene
from models.scene.characteristics import Constant, Polynomial, Sine
from tests.analytic.lectures.regulation.worked import shaft, yoke
from tests.worlds.command_line import crank, refused
from tests.worlds.tiers import few


@pytest.fixture(autouse=True)
def _in_a_folder_with_the_shaft_of_40_j(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    scene = shaft({"pull": (Sine(20.0, math.tau), "angle")})
    Path("shaft.toml").write_text(scene_text(scene), encoding="utf-8")


def told(line: str) -> str:
    """What a line of the command prints."""
    result = crank(*line.split())
    assert result.exit_code == 0, result.output
    assert max(len(line.rstrip()) for line in result.output.splitlines()) <= 100
    return result.output


def numbers(output: str, start: str) -> list[float]:
    """The numbers of the one row that begins so."""
    (words,) = re.findall(rf"^{re.escape(start)} +(.*)$", output, flags=re.MULTILINE)
    return [float(each) for each in re.findall(r"[-+]?[\d.]+(?:e[-+]?\d+)?(?= |$)", words)]


FLYWHEEL = "flywheel shaft.toml --delta 0.02"


def test_a_cycle_is_told() -> None:
    output = told("cycle shaft.toml")
    assert numbers(output, "largest speed") == [11.0, 180.0]
    assert numbers(output, "smallest speed")[0] == 9.0
    assert numbers(output, "coefficient of fluctuation") == [0.2]
    assert numbers(output, "surplus of work") == [40.0]
    assert numbers(output, "loads.pull") == [0.0, 0.0]
    assert "closes the balance of work." in " ".join(output.split())


def test_the_drive_that_closes_the_balance_is_told() -> None:
    scene = shaft({"brake": (Constant(-3.0), "time")})
    Path("braked.toml").write_text(scene_text(scene), encoding="utf-8")
    output = told("cycle braked.toml")
    assert numbers(output, "torque of the drive")[0] == 3.0
    assert numbers(output, "drive")[0] == pytest.approx(3.0 * math.tau, rel=1e-5)
    assert "here it gives 3 N m" in " ".join(output.split())


def test_a_flywheel_is_told() -> None:
    output = told(FLYWHEEL)
    assert numbers(output, "exact, of the full equation") == [18.0]
    assert numbers(output, "coefficient of fluctuation") == [0.2, 0.02]
    assert numbers(output, "largest speed") == [11.0, 10.1]
    assert "tan psi_max = 51.005" in " ".join(output.split())


def test_files_hold_all_digits_and_what_is_written_is_shown_as_well() -> None:
    assert told("cycle shaft.toml -o c.csv").endswith(told("cycle shaft.toml"))
    for ending in ("csv", "json"):
        told(f"{FLYWHEEL} -o f.{ending}")
    frame = pd.read_csv("c.csv")
    assert len(frame) == 721
    theta, omega = (frame[f"crank_{name}"].to_numpy() for name in ("theta_rad", "omega_rad_s"))
    np.testing.assert_allclose(frame["work_j"], 20.0 * (1.0 - np.cos(theta)), atol=1e-9)
    np.testing.assert_allclose(frame["energy_j"], omega**2, rtol=1e-12)
    np.testing.assert_allclose(frame["returning_n_m"], 20.0 * np.sin(theta), atol=1e-9)
    both = pd.read_csv("f.csv")
    np.testing.assert_allclose(both["bare_crank_omega_rad_s"], omega, rtol=1e-9)
    assert np.ptp(both["crank_omega_rad_s"]) == pytest.approx(0.2, rel=1e-4)
    found = json.loads(Path("f.json").read_text())
    assert found["flywheel_kg_m2"]["exact"] == pytest.approx(18.0, rel=1e-11)
    assert found["without"]["delta"] == pytest.approx(0.2, rel=1e-12)
    assert found["cycle"]["largest_at_deg"] == pytest.approx(180.0)


@pytest.mark.parametrize("free", few([False, True], {True}, "the driven scene: half a second"))
def test_the_written_scene_has_the_flywheel(free: bool) -> None:
    told(f"flywheel compressor --delta 0.03 --write w.toml {'--free' * free}")
    assert "flywheel_kg_m2 = 0.0" in Path("w.toml").read_text()
    scene = load_scene("w.toml")
    assert scene.is_free is free
    assert ("drive" in scene.loads) is free
    told("cycle w.toml -o again.json")
    delta = json.loads(Path("again.json").read_text())["cycle"]["delta"]
    # Let go its mean speed is that of its start, which the cycle has elsewhere.
    assert delta == pytest.approx(0.03, rel=0.1 if free else 1e-9)


def pictures(page: str) -> int:
    return Path(page).read_text(encoding="utf-8").count("data:image/svg+xml;base64,")


def test_a_page_is_written() -> None:
    Path("yoke.toml").write_text(scene_text(yoke(40.0)), encoding="utf-8")
    told("flywheel yoke.toml --delta 0.02 -o p.html")
    assert pictures("p.html") == 3
    text = Path("p.html").read_text(encoding="utf-8")
    body = text.partition("<main")[2].partition("<script")[0]
    assert "Wittenbauer" in body
    assert "nan" not in body.lower().split()


def test_a_shaft_of_constant_moment_of_inertia_has_no_energy_mass_diagram() -> None:
    told("cycle shaft.toml -o s.html --figures two")
    assert pictures("s.html") == 2
    names = {"speed.svg", "speed.pdf", "torques.svg", "torques.pdf"}
    assert {path.name for path in Path("two").iterdir()} == names


MISTAKES = {
    "no cycle": ("cycle toggle-press", "it comes to rest near crank"),
    "no flywheel of 0": ("flywheel shaft.toml --delta 0", "--delta 0: "),
    "2": ("flywheel shaft.toml --delta 2 -o f.csv", "--delta 2: "),
    "met": (
        "flywheel shaft.toml --delta 0.3 --write f.toml",
        "no flywheel is needed for a coefficient of 0.3: without one more it is 0.2 already",
    ),
    "ending": ("cycle shaft.toml -o out.txt", "found '.txt'"),
    "scene ending": ("flywheel shaft.toml --delta 0.1 --write f.csv", "found .csv; use .toml"),
    "over itself": ("flywheel shaft.toml --delta 0.1 --write shaft.toml", "which is read"),
    "free alone": ("flywheel shaft.toml --delta 0.1 --free", "give --write FILE.toml"),
    "no scene": ("cycle shafts.toml", "shafts.toml"),
    "a folder": ("cycle shaft.toml --figures shaft.toml", "--figures"),
}


@pytest.mark.parametrize("name", MISTAKES)
def test_a_mistake_ends_with_2_one_message_and_nothing_written(name: str) -> None:
    line, words = MISTAKES[name]
    before = set(Path().iterdir())
    result = crank(*line.split())
    refused(result, words)
    assert result.stdout == ""
    assert set(Path().iterdir()) == before


MOTOR = {"pull": (Sine(20.0, math.tau), "angle"), "motor": (Polynomial((30.0, -3.0)), "omega")}
MOTORISED = shaft(MOTOR, free=True)  # type: ignore[arg-type]  # literals


def test_in_python_results_are_small_values_that_print_as_the_commands() -> None:
    found = crankcheck.cycle(MOTORISED)
    assert found.mean_rad_s == pytest.approx(10.0, rel=0.01)
    assert "Let go: the loads alone settle the speed." in str(found)
    assert found.frame()["crank_omega_rad_s"].max() == pytest.approx(
        found.extreme_speeds_rad_s[0], rel=1e-5
    )
    wheel = crankcheck.flywheel("shaft.toml", 0.01)
    again = crankcheck.cycle(wheel.scene)
    assert again.delta == pytest.approx(0.01, rel=1e-10)
    assert again.extreme_angles_deg == pytest.approx(wheel.cycle.extreme_angles_deg)
    assert "<table" in wheel._repr_html_()
    free = wheel.cycle.scene_let_go(2.0)
    assert free.driver.law.period_s == pytest.approx(2.0 * wheel.cycle.details.period_s)


def test_in_python_messages_name_arguments() -> None:
    scene = replace(MOTORISED, name="shaft")
    for delta in (0.0, "much", True):
        with pytest.raises(crankcheck.CrankcheckError, match=r"^delta"):
            crankcheck.flywheel(scene, delta)  # type: ignore[arg-type]  # that is what is refused
