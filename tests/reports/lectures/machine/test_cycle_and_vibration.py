"""`crankcheck cycle`, `flywheel` and `vibration`: what they print and write, and mistakes."""

import json
import math
import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import crankcheck
from models.files.assemble import scene_text
from models.files.reading import find_scene, load_scene, read_text
from models.scene.characteristics import Constant, Polynomial, Sine
from tests.analytic.lectures.regulation.worked import shaft, yoke
from tests.worlds.command_line import crank, refused
from tests.worlds.tiers import slow, slowly
from tests.worlds.without_pdf import without_pdf


@pytest.fixture(autouse=True)
def _beside_a_shaft_of_40_j(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.chdir(tmp_path)
    scene = shaft({"pull": (Sine(20.0, math.tau), "angle")})
    Path("shaft.toml").write_text(scene_text(scene), encoding="utf-8")
    with without_pdf():
        yield


def told(line: str) -> str:
    result = crank(*line.split())
    assert result.exit_code == 0, result.output
    lines = [line.rstrip() for line in result.output.splitlines()]
    assert max(len(line) for line in lines if not line.startswith("out: ")) <= 100
    return result.output


def joined(line: str) -> str:
    return " ".join(told(line).split())


def numbers(output: str, start: str) -> list[float]:
    (words,) = re.findall(rf"^{re.escape(start)} +(.*)$", output, flags=re.MULTILINE)
    return [float(each) for each in re.findall(r"[-+]?[\d.]+(?:e[-+]?\d+)?(?= |$)", words)]


FLYWHEEL = "flywheel shaft.toml --delta 0.02"


def test_a_cycle_and_the_drive_that_closes_its_balance_are_told() -> None:
    output = told("cycle shaft.toml")
    assert numbers(output, "largest speed") == [11.0, 180.0]
    assert numbers(output, "smallest speed")[0] == 9.0
    assert numbers(output, "coefficient of fluctuation") == [0.2]
    assert numbers(output, "surplus of work") == [40.0]
    assert numbers(output, "loads.pull") == [0.0, 0.0]
    assert "closes the balance of work." in " ".join(output.split())
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


@pytest.mark.parametrize("free", [slowly(False, reason="0.6 s: as in free motion"), True])
def test_the_written_scene_has_the_flywheel(free: bool) -> None:
    loads = {"pull": (Sine(20.0, math.tau), "angle"), "brake": (Constant(-3.0), "time")}
    Path("braked.toml").write_text(scene_text(shaft(loads)), encoding="utf-8")
    told(f"flywheel braked.toml --delta 0.03 --write w.toml {'--free' * free}")
    assert "flywheel_kg_m2 = 1" in Path("w.toml").read_text()
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


@slow("0.7 s: a page with fewer pictures, and figures, as of the yoke")
def test_a_shaft_of_constant_moment_of_inertia_has_no_energy_mass_diagram() -> None:
    told("cycle shaft.toml -o s.html --figures two")
    assert pictures("s.html") == 2
    names = {"speed.svg", "speed.pdf", "torques.svg", "torques.pdf"}
    assert {path.name for path in Path("two").iterdir()} == names


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("cycle toggle-press", "it comes to rest near crank"),
        ("flywheel shaft.toml --delta 0", "--delta 0: "),
        ("flywheel shaft.toml --delta 2 -o f.csv", "--delta 2: "),
        (
            "flywheel shaft.toml --delta 0.3 --write f.toml",
            "no flywheel is needed for a coefficient of 0.3: the machine has 0.2",
        ),
        ("cycle shaft.toml -o out.txt", "found '.txt'"),
        ("flywheel shaft.toml --delta 0.1 --write f.csv", "found '.csv'; use .toml"),
        ("flywheel shaft.toml --delta 0.1 --write shaft.toml", "which is read"),
        ("flywheel shaft.toml --delta 0.1 --free", "give --write FILE.toml"),
        ("cycle shafts.toml", "shafts.toml"),
        ("cycle shaft.toml --figures shaft.toml", "--figures"),
    ],
)
def test_a_mistake_ends_with_2_one_message_and_nothing_written(line: str, words: str) -> None:
    before = set(Path().iterdir())
    result = crank(*line.split())
    refused(result, words)
    assert result.stdout == ""
    assert set(Path().iterdir()) == before


MOTORISED = shaft(
    {"pull": (Sine(20.0, math.tau), "angle"), "motor": (Polynomial((30.0, -3.0)), "omega")},
    free=True,
)


def test_in_python_results_are_small_values_that_print_as_the_commands() -> None:
    found = crankcheck.cycle(MOTORISED)
    assert found.mean_rad_s == pytest.approx(10.0, rel=0.01)
    assert "Free motion: the loads alone settle the speed." in str(found)
    assert found.frame()["crank_omega_rad_s"].max() == pytest.approx(
        found.extreme_speeds_rad_s[0], rel=1e-5
    )
    wheel = crankcheck.flywheel("shaft.toml", 0.01)
    again = crankcheck.cycle(wheel.scene)
    assert again.delta == pytest.approx(0.01, rel=1e-10)
    assert again.details.fastest == pytest.approx(wheel.cycle.details.fastest)
    assert "<table" in wheel._repr_html_()
    free = wheel.cycle.scene_let_go(2.0)
    assert free.driver.law.period_s == pytest.approx(2.0 * wheel.cycle.details.period_s)


def test_in_python_messages_name_arguments() -> None:
    scene = replace(MOTORISED, name="shaft")
    for delta in (0.0, "much", True):
        with pytest.raises(crankcheck.CrankcheckError, match=r"^delta"):
            crankcheck.flywheel(scene, delta)  # type: ignore[arg-type]  # that is what is refused


def scene_at(ratio: float, **changes: str) -> str:
    """A file with the shipped four-bar at another frequency ratio, and other changes of its text;
    its name."""
    text, speed = read_text(find_scene("fourbar-elastic")), "speed_rad_s = 7.3686"
    assert speed in text
    text = text.replace(speed, f"speed_rad_s = {77.37042596564 / ratio!r}")
    for old, new in changes.items():
        text = text.replace(old, new)
    Path("own.toml").write_text(text, encoding="utf-8")
    return "own.toml"


def test_a_vibration_is_told_and_its_files_hold_all() -> None:
    output = joined("vibration fourbar-elastic -o out")
    assert "coupler across 1 77.3704 12.3139 10.5" in output
    assert re.search(r"coupler 1\.051 0\.14 % 375 12\d\.\d 1\.051 0\.00366", output)
    assert "mechanism, mode rad/s, least most over speed order from whole multiplier" in output
    assert "Stable, without damping" in output
    assert "No resonance is near: 1 % of stiffness changes the deflection by 1.01 %" in output
    assert sorted(path.name for path in Path("out").iterdir()) == [
        "deflection.pdf", "deflection.svg", "natural.csv", "spectrum.csv", "spectrum.pdf",
        "spectrum.svg", "turn.csv", "vibration.json",
    ]  # fmt: skip
    found = json.loads(Path("out/vibration.json").read_text(encoding="utf-8"))
    assert found["stable"] is True
    assert [row["mode"] for row in found["modes"]] == [1, 2, 3, 4, 5]
    turn, orders = pd.read_csv("out/turn.csv"), pd.read_csv("out/spectrum.csv")
    largest = found["deflections"][0]["middle_m"]
    assert turn["coupler_middle_m"].abs().max() == pytest.approx(largest, rel=1e-12)
    assert turn["coupler_middle_m"].mean() == pytest.approx(orders["coupler_m"][0], rel=0.1)
    natural = pd.read_csv("out/natural.csv")
    assert np.allclose(natural["mode_1_rad_s"], 77.3704, rtol=1e-6)


def test_speeds_are_told_and_written() -> None:
    output = joined("vibration fourbar-elastic --speeds 15:20:6 --modes 1 -o out")
    assert re.search(r" 19\.3\d* 4\.00\d* 1 4 0\.\d+ ", output)
    assert re.search(r" 15\.4\d* 5\.00\d* 1 5 0\.\d+ ", output)
    assert "Deviations grow at none of these speeds." in output
    speeds, fall = pd.read_csv("out/speeds.csv"), pd.read_csv("out/waterfall.csv")
    assert list(speeds["speed_rad_s"]) == pytest.approx(np.linspace(15.0, 20.0, 6))
    assert len(fall) == 6 * 33
    assert list(pd.read_csv("out/critical.csv")["order"]) == [4, 5]
    assert Path("out/waterfall.svg").exists()


def test_a_map_tells_where_it_is_unstable() -> None:
    options = "--map rocker --factors 1:30:2 --speeds 17:19:3 --modes 1 -o out"
    output = joined(f"vibration fourbar-elastic {options}")
    assert re.search(r"1 0\.\d+ % 1 1\d(\.\d+)? 0 speeds", output)
    table = pd.read_csv("out/map.csv")
    assert list(table["stable"][:3]) == [True] * 3
    assert not table["stable"][3:].all()
    assert Path("out/map.pdf").exists()


BEAM = "height_m = 0.003"


@pytest.mark.parametrize(
    ("ratio", "changes", "words"),
    [
        (4.15, {"mass_kg = 0.18225": "mass_kg = 5.4675"},
         r"UNSTABLE: a turn multiplies deviations by 2\.58.*Use another speed"),
        (5.5, {BEAM: f"{BEAM}\ndamping_s = 1e-4"}, r"Stable: deviations fall to a tenth in \d"),
        slowly(500.0, {BEAM: f"{BEAM}\ndamping_s = 1e-2"},
               r"Stable: deviations die out within a turn\.", reason="as with less damping"),
        (5.05, {}, "NEAR A RESONANCE with coupler at order 5"),
    ],
)  # fmt: skip
def test_growth_and_resonance_are_told(ratio: float, changes: dict[str, str], words: str) -> None:
    assert re.search(words, joined(f"vibration {scene_at(ratio, **changes)} --modes 1"))


SPEEDS = "fourbar-elastic --speeds"
MAP = "fourbar-elastic --map"


@pytest.mark.parametrize(
    ("options", "told"),
    [
        ("fourbar-lecture-1", "no link of it is elastic"),
        (f"{SPEEDS} 5:40", "write FROM:TO:COUNT like 5:40:200"),
        (f"{SPEEDS} 40:5:9", "the smaller first"),
        (f"{SPEEDS} 0:5:9", "two numbers above 0"),
        (f"{SPEEDS} 1:5:1", "give 2 or more"),
        (f"{SPEEDS} 1e-9:5:9", "do not vibrate; start at 0.0077"),
        (f"{SPEEDS} 1:5:999999", "give 5000 or fewer"),
        (
            f"{MAP} coupler",
            "inertia of coupler: it is elastic, and its own mass is that of the beam; use rocker",
        ),
        (f"{MAP} crank", "inertia of crank: its speed is given, whatever its inertia; use rocker"),
        (f"{MAP} lever", "inertia of lever: no link or slider of that name; use rocker"),
        ("fourbar-elastic --factors 1:2:3", "give --map LINK"),
    ],
)
def test_mistakes_are_told(options: str, told: str) -> None:
    refused(crank("vibration", *options.split()), told)


def test_a_resonance_and_a_law_that_does_not_last_end_with_2() -> None:
    refused(
        crank("vibration", scene_at(5.0), "--modes", "2"),
        "a resonance: elastic.coupler vibrates at order 5",
        "take another speed (14.07 rad/s is half-way to the next), or give elastic",
    )
    law = {"start_deg": 'law = "from-rest"\nrise_s = 0.2\nstart_deg', '"periodic"': '"straight"'}
    brief = crank("vibration", scene_at(10.5, **law))
    refused(brief, "vibration needs a driver at constant speed")
