"""`crankcheck vibration`: what it prints and writes, and mistakes."""

import json
import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from models.files.reading import find_scene, read_text
from tests.worlds.command_line import crank, refused

SPEED = "speed_rad_s = 7.3686"


@pytest.fixture(autouse=True)
def _in_a_folder_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def scene_at(ratio: float, **changes: str) -> str:
    """A file with the shipped four-bar at another frequency ratio, and other changes of its text;
    its name."""
    text = read_text(find_scene("fourbar-elastic"))
    assert SPEED in text
    text = text.replace(SPEED, f"speed_rad_s = {77.37042596564 / ratio!r}")
    for old, new in changes.items():
        text = text.replace(old, new)
    Path("own.toml").write_text(text, encoding="utf-8")
    return "own.toml"


def words(scene: str, *options: str) -> str:
    result = crank("vibration", scene, *options)
    assert result.exit_code == 0, result.output
    lines = [line.rstrip() for line in result.output.splitlines()]
    assert max(len(line) for line in lines if not line.startswith("out: ")) <= 100
    return " ".join(result.output.split())


def test_a_vibration_is_told_and_its_files_hold_all() -> None:
    output = words("fourbar-elastic", "-o", "out")
    assert "coupler across 1 77.3704 12.3139 10.5" in output
    assert re.search(r"coupler 1\.051 0\.14 % 375 12\d\.\d 1\.051 0\.00366", output)
    assert "mechanism, mode rad/s, least most over speed order from whole multiplier" in output
    assert "Stable, without damping" in output
    assert "No resonance is near: 1 % of stiffness changes the deflection by 1.01 %" in output
    assert sorted(path.name for path in Path("out").iterdir()) == [
        "deflection.pdf", "deflection.svg", "natural.csv", "spectrum.csv", "spectrum.pdf",
        "spectrum.svg", "turn.csv", "vibration.json",
    ]  # fmt: skip
    told = json.loads(Path("out/vibration.json").read_text(encoding="utf-8"))
    assert told["stable"] is True
    assert [row["mode"] for row in told["modes"]] == [1, 2, 3, 4, 5]
    turn, orders = pd.read_csv("out/turn.csv"), pd.read_csv("out/spectrum.csv")
    largest = told["deflections"][0]["middle_m"]
    assert turn["coupler_middle_m"].abs().max() == pytest.approx(largest, rel=1e-12)
    assert turn["coupler_middle_m"].mean() == pytest.approx(orders["coupler_m"][0], rel=0.1)
    natural = pd.read_csv("out/natural.csv")
    assert np.allclose(natural["mode_1_rad_s"], 77.3704, rtol=1e-6)


def test_speeds_are_told_and_written() -> None:
    output = words("fourbar-elastic", "--speeds", "14:21:15", "--modes", "1", "-o", "out")
    assert re.search(r" 19\.3\d* 4\.00\d* 1 4 0\.\d+ ", output)
    assert re.search(r" 15\.4\d* 5\.00\d* 1 5 0\.\d+ ", output)
    assert "At none of these speeds deviations grow." in output
    speeds, fall = pd.read_csv("out/speeds.csv"), pd.read_csv("out/waterfall.csv")
    assert list(speeds["speed_rad_s"]) == pytest.approx(np.linspace(14.0, 21.0, 15))
    assert len(fall) == 15 * 33
    assert list(pd.read_csv("out/critical.csv")["order"]) == [4, 5]
    assert Path("out/waterfall.svg").exists()


def test_a_map_tells_where_it_is_unstable() -> None:
    options = ("--map", "rocker", "--factors", "1:30:2", "--speeds", "17:19:3", "--modes", "1")
    output = words("fourbar-elastic", *options, "-o", "out")
    assert re.search(r"1 0\.\d+ % 1 1\d(\.\d+)? 0 speeds", output)
    table = pd.read_csv("out/map.csv")
    assert list(table["stable"][:3]) == [True] * 3
    assert not table["stable"][3:].all()
    assert Path("out/map.pdf").exists()


@pytest.mark.parametrize(
    ("ratio", "changes", "told"),
    [
        (
            *(4.15, {"mass_kg = 0.18225": "mass_kg = 5.4675"}),
            r"UNSTABLE: a turn multiplies deviations by 2\.58.*Take another speed",
        ),
        (
            *(5.5, {"height_m = 0.003": "height_m = 0.003\ndamping_s = 1e-4"}),
            r"Stable: deviations fall to a tenth in \d",
        ),
        (
            *(500.0, {"height_m = 0.003": "height_m = 0.003\ndamping_s = 1e-2"}),
            r"Stable: deviations die out within a turn\.",
        ),
        (5.05, {}, "NEAR A RESONANCE with coupler at order 5"),
    ],
    ids=["unstable", "damped", "dead", "near a resonance"],
)
def test_growth_and_resonance_are_told(ratio: float, changes: dict[str, str], told: str) -> None:
    assert re.search(told, words(scene_at(ratio, **changes), "--modes", "1"))


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
        (f"{SPEEDS} 1e-9:5:9", "do not vibrate there; start at 0.0077"),
        (f"{SPEEDS} 1:5:999999", "give 5000 or fewer"),
        (
            f"{MAP} coupler",
            "inertia of coupler: it is elastic, and its own mass is that of the beam; use rocker",
        ),
        (f"{MAP} crank", "inertia of crank: its speed is told, whatever its inertia; use rocker"),
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
    refused(brief, "vibration is told of a driver at constant speed")
