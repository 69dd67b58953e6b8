"""Every option of a command is a field of its request, written once."""

from __future__ import annotations

from dataclasses import fields
from importlib import import_module
from pathlib import Path

import pytest

from reports.cli import changes, checking, measuring, regulating, showing
from tests.worlds.command_line import crank, refused

LEAST = {
    "verify": ("verify", checking.VerifyRequest()),
    "diff old new": ("run_diff", changes.DiffRequest(Path("old"), Path("new"))),
    "history mujoco 1 2": ("run_history", changes.HistoryRequest("mujoco", ["1", "2"])),
    "selftest": ("selftest", checking.SelftestRequest()),
    "sweep -o out": ("sweep", measuring.SweepRequest(Path("out"))),
    "tune a b --engine c --target 1": ("run_tune", measuring.TuneRequest(["a", "b"], "c", 1.0)),
    "advise --dt 1 --speed 2 --target 3": ("run_advise", measuring.AdviseRequest(1.0, 2.0, 3.0)),
    "stability": ("stability", measuring.StabilityRequest()),
    "solve a": ("run_solve", showing.SolveRequest("a")),
    "cycle a": ("run_cycle", regulating.CycleRequest("a")),
    "flywheel a --delta 1": ("run_flywheel", regulating.FlywheelRequest("a", 1.0)),
}


def asked(monkeypatch: pytest.MonkeyPatch, line: str, function: str) -> object:
    """The request that a command line makes."""
    requests: list[object] = []

    def run(request: object, *_: object) -> int:
        requests.append(request)
        return 1

    command = line.split()[0]
    room = function if function == "verify_model" else command
    monkeypatch.setattr(import_module(f"reports.cli.commands.{room}"), function, run)
    result = crank(*line.split())
    assert result.exit_code == (command != "solve"), result.output
    (request,) = requests
    return request


@pytest.mark.parametrize("line", LEAST)
def test_what_is_not_given_keeps_the_default_of_the_request(
    line: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    function, request = LEAST[line]
    assert asked(monkeypatch, line, function) == request


SECONDS = {
    "verify --dt {}": ("verify", "dt_s"),
    "run a --dt {}": ("run_run", "dt_s"),
    "judge a b --step {}": ("run_judge", "step_s"),
    "advise --dt {} --speed 1 --target 1": ("run_advise", "dt_s"),
}


@pytest.mark.parametrize("line", SECONDS)
def test_seconds_may_be_a_fraction(line: str, monkeypatch: pytest.MonkeyPatch) -> None:
    function, field = SECONDS[line]
    for text, number in {"1/60": 1 / 60, "1e-3/4": 2.5e-4, "0.02": 0.02}.items():
        assert getattr(asked(monkeypatch, line.format(text), function), field) == number
    for wrong in ("1/0", "1/", "/60", "1/60/2", "a", "60 Hz"):
        command = [word.format(wrong) for word in line.split()]
        refused(crank(*command), "no number of seconds")


def test_every_option_reaches_its_field(monkeypatch: pytest.MonkeyPatch) -> None:
    line = (
        "verify a b --engine c --engine d --profile e --dt 0.1 --steps-per-turn 2 --turns 3 "
        "--tol angle=1 --drive servo --no-convergence --jobs 4 --junit f --csv g --json h -o i "
        "--baseline j --factor 5 --forces --free --duration 6 --segments 7 --springs k"
    )
    request = checking.VerifyRequest(
        ["a", "b"], ["c", "d"], ["e"], 0.1, 2.0, 3.0, ["angle=1"], "servo", False, 4, Path("f"),
        Path("g"), Path("h"), Path("i"), Path("j"), 5.0, True, True, 6.0, 7,
        "k",
    )  # fmt: skip
    of_models = (
        "verify --mjcf a --speed 1 --key b --start 2 --branch c=1 --write-scene d --limit-s 3 "
        "--memory-gb 4"
    )
    model = checking.VerifyRequest(
        mjcf=Path("a"), speed_rad_s=1.0, key="b", start_deg=2.0, branch=["c=1"],
        write_scene=Path("d"), limit_s=3.0, memory_gb=4.0,
    )  # fmt: skip
    assert asked(monkeypatch, line, "verify") == request
    assert asked(monkeypatch, of_models, "verify_model") == model
    default = checking.VerifyRequest()
    for name in (each.name for each in fields(default)):
        given = [getattr(one, name) != getattr(default, name) for one in (request, model)]
        assert sum(given) == 1, name
