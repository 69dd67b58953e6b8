"""Every option of a command is a field of its request, written once."""

from pathlib import Path

import pytest

from reports.cli.commands import COMMANDS
from reports.requests.options import named
from reports.requests.verify import VerifyRequest
from tests.worlds.command_line import crank, refused

LEAST: dict[str, tuple[object, ...]] = {
    "verify": (),
    "history mujoco 1 2": ("mujoco", ["1", "2"]),
    "sweep -o out": (Path("out"),),
    "advise --dt 1 --speed 2 --target 3": (1.0, 2.0, 3.0),
    "solve a": ("a",),
}
"""The least that a command takes, and the same as arguments of its request."""


def kind_of(line: str) -> type:
    kind = named(COMMANDS[line.split()[0]].request)
    return named(kind.answered_by) if hasattr(kind, "answered_by") else kind


def asked(monkeypatch: pytest.MonkeyPatch, line: str) -> object:
    requests: list[object] = []

    def run(request: object, *_: object) -> int:
        requests.append(request)
        return 1

    monkeypatch.setattr(kind_of(line), "run", run)
    result = crank(*line.split())
    assert result.exit_code == 1, result.output
    (request,) = requests
    return request


@pytest.mark.parametrize("line", LEAST)
def test_what_is_not_given_is_the_request_s_own(line: str, monkeypatch: pytest.MonkeyPatch) -> None:
    assert asked(monkeypatch, line) == kind_of(line)(*LEAST[line])


SECONDS = ("verify --dt {}", "run a --dt {}", "advise --dt {} --speed 1 --target 1")


@pytest.mark.parametrize("line", SECONDS)
def test_seconds_may_be_a_fraction(line: str, monkeypatch: pytest.MonkeyPatch) -> None:
    for text, number in {"1/60": 1 / 60, "1e-3/4": 2.5e-4, "0.02": 0.02}.items():
        assert vars(asked(monkeypatch, line.format(text)))["dt_s"] == number
    for wrong in ("1/0", "1/", "/60", "1/60/2", "a", "60 Hz"):
        refused(crank(*(word.format(wrong) for word in line.split())), "not a number of seconds")


def test_every_option_reaches_its_field(monkeypatch: pytest.MonkeyPatch) -> None:
    line = (
        "verify a b --engine c --engine d --profile e --dt 0.1 --steps-per-turn 2 --turns 3 "
        "--tol angle=1 --drive servo --no-convergence --jobs 4 --junit f --csv g --json h -o i "
        "--baseline j --factor 5 --forces --free --duration 6 --segments 7 --springs k"
    )
    request = VerifyRequest(
        ["a", "b"], ["c", "d"], ["e"], 0.1, 2.0, 3.0, ["angle=1"], "servo", False, 4, Path("f"),
        Path("g"), Path("h"), Path("i"), Path("j"), 5.0, True, True, 6.0, 7,
        "k",
    )  # fmt: skip
    assert asked(monkeypatch, line) == request
