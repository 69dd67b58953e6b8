"""Every command answers: a line of each, one after the other in one folder, as `make oldest` runs
them with the lower bounds of what crankcheck needs. What they answer, the tests of their rooms say.
"""

from pathlib import Path

import pytest

from reports.cli.commands import COMMANDS
from tests.worlds.command_line import crank_alone
from tests.worlds.tiers import slow

SHORT = "--profile tuned --engine pymunk --jobs 1"
LINES = {
    f"verify fourbar-lecture-1 --turns 0.5 {SHORT} -o old": 0,
    f"verify fourbar-lecture-1 --turns 0.5 {SHORT} -o new --baseline old": 0,
    "diff old new --junit diff.xml": 0,
    f"sweep fourbar-lecture-1 --steps-per-turn 90,180 {SHORT} --no-timing -o swept": 0,
    "report swept -o page.html": 0,
    "figures swept -o figures --only convergence": 0,
    f"stability coarse-step {SHORT} -o hard": 0,
    f"stability coarse-step {SHORT} --baseline hard": 0,
    "tune fourbar-lecture-1 --engine pymunk --target 1e-2 --budget 2 --no-timing": 0,
    "advise fourbar-lecture-1 --engine pymunk --dt 0.01 --speed 10 --target 0.1 --jobs 1": 0,
    "selftest --engine pymunk --fault drive-other --jobs 1": 0,
    "explain CC110": 0,
    "run fourbar-lecture-1 --engine mujoco --turns 1 -o log.parquet": 0,
    "judge fourbar-lecture-1 log.parquet --target 1e-3 -o log.html": 0,
    "fit fourbar-lecture-1 log.parquet": 0,
    "export fourbar-lecture-1 -o loop.xml": 0,
    "verify --mjcf loop.xml --drive crank.A --speed 10 --turns 0.5 -o model": 0,
    "recipe forces --engine mujoco": 0,
    "solve shaper --forces -o shaper.xlsx": 0,
    "scenes": 0,
    "view shaper -o shaper.png": 0,
    "cycle press-motor": 0,
    "flywheel engine-four-stroke --delta 0.02 --figures flywheel": 0,
    "vibration fourbar-elastic --modes 2": 0,
    "rotatability fourbar-double-rocker": 0,
    "equilibria fourbar-swing": 0,
    "sensitivity shaper -o sensitivity.svg": 0,
    "polygon fourbar-lecture-1 --at-deg 60 -o polygon.svg": 0,
    "positions fourbar-lecture-1 -o positions.pdf": 0,
    "centres fourbar-lecture-1 --at-deg 60 -o centres.svg": 0,
    "graph fourbar-lecture-1 --of rocker --divisions 24 -o rocker.svg": 0,
    "synth rocker by-angle --best 2": 0,
    "structure sixbar-watt": 0,
    "chains --links 6 --inversions": 0,
    "joint crossed-cylinders": 0,
    "mobility sarrus": 0,
    "cam": 0,
    "gears planetary": 0,
    "engines": 0,
    "engines check pymunk": 0,
}
"""Lines with their exit codes."""
ELSEWHERE = {"history"}
"""Installs versions of an engine: its tests have an installer of their own."""


def words_of(line: str) -> str:
    return next((two for two in COMMANDS if " " in two and line.startswith(two)), line.split()[0])


def test_every_command_has_a_line() -> None:
    assert {words_of(line) for line in LINES} | ELSEWHERE == set(COMMANDS)


@slow("half a minute: the tests of their rooms say more of each")
def test_every_command_answers(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    codes = {line: crank_alone(*line.split()).exit_code for line in LINES}
    assert codes == LINES
