"""`crankcheck vibration`: what it prints and writes, and mistakes."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from typer.testing import CliRunner, Result

from models.files import find_scene, read_text
from reports.cli import app

Crank = Callable[..., Result]
SPEED = "speed_rad_s = 7.3686"


@pytest.fixture
def crank(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Crank:
    """Run the command with arguments in a folder of its own."""
    monkeypatch.chdir(tmp_path)
    runner = CliRunner()
    return lambda *args: runner.invoke(app, ["vibration", *args])


def scene_at(ratio: float, name: str = "own", **changes: str) -> str:
    """A file with the shipped four-bar at another frequency ratio, and other changes of its text;
    its name."""
    text = read_text(find_scene("fourbar-elastic"))
    assert SPEED in text
    text = text.replace(SPEED, f"speed_rad_s = {77.37042596564 / ratio!r}")
    for old, new in changes.items():
        text = text.replace(old, new)
    Path(f"{name}.toml").write_text(text, encoding="utf-8")
    return f"{name}.toml"


def words(result: Result) -> str:
    assert result.exit_code == 0, result.output
    lines = [line.rstrip() for line in result.output.splitlines()]
    assert max(len(line) for line in lines if not line.startswith("out: ")) <= 100
    return " ".join(result.output.split())


def test_a_vibration_is_told(crank: Crank) -> None:
    output = words(crank("fourbar-elastic"))
    assert "coupler across 1 77.3704 12.3139 10.5" in output
    assert re.search(r"coupler 1\.051 0\.14 % 375 12\d\.\d 1\.051 0\.00366", output)
    assert "Stable, without damping" in output
    assert "No resonance is near: 1 % of stiffness changes the deflection by 1.01 %" in output


def test_files_hold_all(crank: Crank) -> None:
    words(crank("fourbar-elastic", "--modes", "2", "-o", "out"))
    assert sorted(path.name for path in Path("out").iterdir()) == [
        "deflection.pdf", "deflection.svg", "natural.csv", "spectrum.csv", "spectrum.pdf",
        "spectrum.svg", "turn.csv", "vibration.json",
    ]  # fmt: skip
    told = json.loads(Path("out/vibration.json").read_text(encoding="utf-8"))
    assert told["stable"] is True
    assert [row["mode"] for row in told["modes"]] == [1, 2]
    turn, orders = pd.read_csv("out/turn.csv"), pd.read_csv("out/spectrum.csv")
    largest = told["deflections"][0]["middle_m"]
    assert turn["coupler_middle_m"].abs().max() == pytest.approx(largest, rel=1e-12)
    assert turn["coupler_middle_m"].mean() == pytest.approx(orders["coupler_m"][0], rel=0.1)
    natural = pd.read_csv("out/natural.csv")
    assert np.allclose(natural["mode_1_rad_s"], 77.3704, rtol=1e-6)


def test_speeds_are_told_and_written(crank: Crank) -> None:
    output = words(crank("fourbar-elastic", "--speeds", "14:21:15", "--modes", "1", "-o", "out"))
    assert re.search(r" 19\.3\d* 4\.00\d* 1 4 0\.\d+ ", output)
    assert re.search(r" 15\.4\d* 5\.00\d* 1 5 0\.\d+ ", output)
    assert "At none of these speeds deviations grow." in output
    speeds, fall = pd.read_csv("out/speeds.csv"), pd.read_csv("out/waterfall.csv")
    assert list(speeds["speed_rad_s"]) == pytest.approx(np.linspace(14.0, 21.0, 15))
    assert len(fall) == 15 * 33
    assert list(pd.read_csv("out/critical.csv")["order"]) == [4, 5]
    assert (Path("out") / "waterfall.svg").exists()


def test_a_map_tells_where_it_is_unstable(crank: Crank) -> None:
    options = ("--map", "rocker", "--factors", "1:30:2", "--speeds", "17:19:3", "--modes", "1")
    output = words(crank("fourbar-elastic", *options, "-o", "out"))
    assert re.search(r"1 0\.\d+ % 1 1\d(\.\d+)? 0 speeds", output)
    table = pd.read_csv("out/map.csv")
    assert list(table["stable"]) == [True] * 3 + list(table["stable"][3:])
    assert not table["stable"][3:].all()
    assert (Path("out") / "map.pdf").exists()


def test_an_unstable_motion_says_so(crank: Crank) -> None:
    name = scene_at(4.15, **{"mass_kg = 0.18225": "mass_kg = 5.4675"})
    output = words(crank(name, "--modes", "1"))
    assert "UNSTABLE: a turn multiplies deviations by 2.58" in output
    assert "Take another speed" in output


def test_damping_and_a_near_resonance_are_told(crank: Crank) -> None:
    damped = scene_at(5.5, **{"height_m = 0.003": "height_m = 0.003\ndamping_s = 1e-4"})
    assert re.search(
        r"Stable: deviations fall to a tenth in \d", words(crank(damped, "--modes", "1"))
    )
    dead = scene_at(500.0, **{"height_m = 0.003": "height_m = 0.003\ndamping_s = 1e-2"})
    assert "Stable: deviations die out within a turn." in words(crank(dead, "--modes", "1"))
    near = words(crank(scene_at(5.05), "--modes", "1"))
    assert "NEAR A RESONANCE with coupler at order 5" in near


def test_a_resonance_ends_with_2(crank: Crank) -> None:
    result = crank(scene_at(5.0), "--modes", "2")
    assert result.exit_code == 2
    text = " ".join(result.output.split())
    assert "a resonance: elastic.coupler vibrates at order 5" in text
    assert "take another speed (14.07 rad/s is half-way to the next), or give elastic" in text


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (("fourbar-lecture-1",), "no link of it is elastic"),
        (("fourbar-elastic", "--speeds", "5:40"), "write FROM:TO:COUNT like 5:40:200"),
        (("fourbar-elastic", "--speeds", "5:x:9"), "write FROM:TO:COUNT like 5:40:200"),
        (("fourbar-elastic", "--speeds", "40:5:9"), "the smaller first"),
        (("fourbar-elastic", "--speeds", "0:5:9"), "two numbers above 0"),
        (("fourbar-elastic", "--speeds", "1:inf:9"), "write FROM:TO:COUNT"),
        (("fourbar-elastic", "--speeds", "1:5:1"), "give 2 or more"),
        (("fourbar-elastic", "--speeds", "1e-9:5:9"), "do not vibrate there; start at 0.0077"),
        (("fourbar-elastic", "--speeds", "1:5:999999"), "give 5000 or fewer"),
        (
            ("fourbar-elastic", "--map", "coupler"),
            "inertia of coupler: it is elastic, and its own mass is that of the beam; use rocker",
        ),
        (
            ("fourbar-elastic", "--map", "crank"),
            "inertia of crank: its speed is told, whatever its inertia; use rocker",
        ),
        (
            ("fourbar-elastic", "--map", "lever"),
            "inertia of lever: no link or slider of that name; use rocker",
        ),
        (("fourbar-elastic", "--factors", "1:2:3"), "give --map LINK"),
    ],
)
def test_mistakes_are_told(crank: Crank, options: tuple[str, ...], told: str) -> None:
    result = crank(*options)
    assert result.exit_code == 2
    assert told in " ".join(result.output.split())
    assert "Traceback" not in result.output


def test_a_law_that_does_not_last_is_refused(crank: Crank) -> None:
    law = {"start_deg": 'law = "from-rest"\nrise_s = 0.2\nstart_deg', '"periodic"': '"straight"'}
    name = scene_at(10.5, **law)
    result = crank(name)
    assert result.exit_code == 2
    assert "vibration is told of a driver at constant speed" in " ".join(result.output.split())
