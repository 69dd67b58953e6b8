"""`crankcheck graph`: the table, errors over divisions, an engine's log, and what is refused."""

from __future__ import annotations

from pathlib import Path

from typer.testing import Result

from tests.worlds.command_line import crank


def graph(*arguments: object) -> Result:
    return crank("graph", "fourbar-lecture-1", "--of", "rocker", *arguments)


def test_without_a_file_the_table_is_shown() -> None:
    told = graph("--divisions", "8").output.splitlines()
    assert told[0].split() == [
        *("no.", "crank", "deg", "phi", "rad", "omega", "rad/s", "exact"),
        *("epsilon", "rad/s²", "exact"),
    ]
    assert told[2].split()[:3] == ["0.5", "112.50", "4.9897"]
    assert told[-1].endswith("in 8 parts; omega off by up to 5.4 %, epsilon off by up to 11 %")


def test_orders_are_fitted_and_the_log_of_an_engine_ends_in_its_own_error(tmp_path: Path) -> None:
    # That an engine's log goes through: `run` writes it, and names and instants are its own.
    log, sheet = tmp_path / "run.csv", tmp_path / "orders.svg"
    options = ("--engine", "pymunk", "--profile", "as-shipped", "--turns", "1", "-o", log)
    assert crank("run", "fourbar-lecture-1", *options).exit_code == 0
    result = graph("--divisions", "24,48,96", "--log", log, "-o", sheet)
    assert result.exit_code == 0
    first, *_, last, floor = (line.split() for line in result.output.splitlines())
    assert first[0] == f"{sheet}:"
    assert (last[0], last[1]) == ("order", "1.99")
    assert last[3:] == ["-"] * 4  # of the log, in 96 parts: its own error is most of it
    assert "down to its own" in " ".join(floor)
    assert "reference, omega: order 1.99" in sheet.read_text(encoding="utf-8")
