"""Batches on the command line: the verdict on all worlds, a row for each size, and refusals."""

import json
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from analytic.kinematics import solve
from models.errors import EngineError
from models.files.reading import load_scene
from reports.judge.cell import Cell, check, examined
from reports.plan.batches import batch_length
from reports.protocol.length import Length
from reports.selftest.worlds import FAULTS
from reports.ways.driven.faults import batch as in_batch
from sim.engine import Log
from sim.registry import Fewer, engine
from sim.run.worlds import run_worlds
from tests.worlds.command_line import crank_alone, flat, refused

FOURBAR = load_scene("fourbar-lecture-1")
SHORT = ("--steps-per-turn", "90", "--turns", "0.5")


def test_each_size_is_a_row_and_all_worlds_count(tmp_path: Path) -> None:
    file = tmp_path / "cells.json"
    words = ["verify", "fourbar-lecture-1", "--engine", "mujoco", *SHORT, "--json", file]
    told = crank_alone(*words, "--worlds", "1,6")
    assert told.exit_code == 0
    assert "of the worlds, numbered from 0, start spread over a turn" in flat(told.output)
    cells = json.loads(file.read_text(encoding="utf-8"))["cells"]
    alone, *many = cells
    assert (alone["worlds"], alone["threads"], alone["steps_per_turn"]) == (1, 1, 90.0)
    assert {one["worlds"] for one in many} == {6}
    for one in cells:
        assert (one["verdict"], one["batch_exact"], one["batch_difference"]) == ("within", True, 0)
        assert (one["batch_lost"], one["batch_swapped"], one["trend"]) == (0, "", None)
        assert 0 <= one["batch_worst"] < one["worlds"]
        assert one["batch_us_per_step"] > 0 < one["batch_us_alone"]
        assert 0 <= one["batch_error_in"] < one["worlds"]
    assert many[0]["batch_error"] >= alone["batch_error"] == alone["place_pure"]


def test_the_verdict_is_that_of_the_worst_world() -> None:
    cell = replace(in_batch(FOURBAR, "mujoco", 90, converge=False), steps=10)
    sound = check(cell)
    limit = 0.999 * sound.batch.error
    assert sound.verdict == "within"
    other = check(replace(cell, tolerance={"angle": limit}))
    assert (other.verdict, other.batch.worst) == ("out", sound.batch.error_in)
    assert other.failures[0].text.startswith(f"world {sound.batch.error_in}: link ")
    alone = check(replace(cell, worlds=0, tolerance={"angle": limit}))
    assert (alone.verdict, alone.batch) == ("within", None)


def test_the_page_draws_the_error_over_the_cost_of_a_world(tmp_path: Path) -> None:
    page = tmp_path / "verify.html"
    words = ["verify", "fourbar-lecture-1", "--engine", "mujoco", "--steps-per-turn", "90"]
    for more, number in ((("--worlds", "1,2"), 1), (("--profile", "tuned"), 0)):
        assert crank_alone(*words, *more, "-o", page).exit_code == 0
        text = page.read_text(encoding="utf-8")
        assert text.count("cost per world and step") == number
        page.unlink()


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.name)
def test_a_faulty_batch_is_seen_and_a_sound_one_passes(fault: Any) -> None:
    cell: Cell = in_batch(FOURBAR, "mujoco", 90, converge=False)
    wrong, right = (examined(cell, fault.plant(size))[0] for size in (fault.size, 0.0))
    assert right.failures == ()
    (found,) = (each for each in wrong.failures if each.rule == fault.rule)
    assert all(word in found.text for word in fault.says)


def test_stored_batches_are_no_baseline_of_runs_alone(tmp_path: Path) -> None:
    words = ["verify", "fourbar-lecture-1", "--engine", "mujoco", "--steps-per-turn", "90"]
    assert crank_alone(*words, "--worlds", "2", "-o", tmp_path / "kept").exit_code == 0
    told = crank_alone(*words, "--turns", "1", "--baseline", tmp_path / "kept")
    refused(told, "cells of batches (--worlds) are not compared")


def test_more_logs_than_worlds_are_refused() -> None:
    motion = solve(FOURBAR, np.zeros(1))
    own = engine("mujoco")

    def doubled(*asked: Any) -> Sequence[Log]:
        return [*own.batches.record(*asked)] * 2

    wrong = replace(own, batches=replace(own.batches, record=doubled))
    with pytest.raises(EngineError, match="mujoco: 2 logs of 1 worlds"):
        run_worlds(FOURBAR, [motion.state()], wrong, dt_s=1e-3, steps=10)


def test_no_log_at_all_is_a_crash() -> None:
    cell = in_batch(FOURBAR, "mujoco", 90, converge=False)
    lost, _ = examined(cell, lambda *_, **__: [])
    assert (lost.status, lost.reason) == ("crashed", "no world of the batch was logged")


def test_an_engine_without_batches_is_unsupported_and_only_where_it_is_named() -> None:
    words = ["verify", "fourbar-lecture-1", *SHORT, "--worlds", "2,3"]
    told = crank_alone(*words, "--engine", "pymunk")
    refused(told, "pymunk, tuned, 2 worlds: pymunk runs one world at a time")
    assert "3 worlds" not in told.output
    usual = crank_alone(*words)
    assert usual.exit_code == 0
    assert "pymunk" not in usual.output


@pytest.mark.parametrize(
    ("more", "message"),
    [
        (("--worlds", "0"), "--worlds: found 0; a batch has 1 to"),
        (("--worlds", "2,x"), "write whole numbers with commas between, such as 1,16,256"),
        (("--worlds", "2", "--forces"), "--worlds and --forces: not offered for batches"),
        (("--worlds", "2", "--baseline", "nowhere"), "--worlds and --baseline"),
        (("--worlds", "2", "--known", "known.toml"), "--worlds and --known"),
        (("double-pendulum", "--worlds", "2"), "is in free motion or elastic"),
    ],
)
def test_what_batches_do_not_have_is_refused(more: tuple[str, ...], message: str) -> None:
    refused(crank_alone("verify", "fourbar-lecture-1", "--engine", "mujoco", *more), message)


@pytest.mark.parametrize(
    ("fewer", "asked", "steps_per_turn", "turns"),
    [
        (None, Length(), None, 1.0),
        (None, Length(turns=2.0), None, 2.0),
        (Fewer(steps_per_turn=90.0), Length(), 90.0, 1.0),
        (Fewer(steps_per_turn=80.0, batch_steps=20), Length(), 80.0, 0.25),
        (Fewer(batch_steps=20), Length(None, 40.0), 40.0, 0.5),
        (Fewer(batch_steps=20), Length(None, 40.0, 3.0), 40.0, 3.0),
    ],
)
def test_batches_of_slow_engines_are_short_by_default(
    monkeypatch: pytest.MonkeyPatch,
    fewer: Fewer | None,
    asked: Length,
    steps_per_turn: float | None,
    turns: float,
) -> None:
    import reports.plan.batches as module

    known = replace(module.declaration("mujoco"), fewer=fewer)
    monkeypatch.setattr(module, "declaration", lambda _: known)
    length = batch_length("mujoco", FOURBAR, asked, named=True)
    assert (length.steps_per_turn, length.turns, length.least) == (steps_per_turn, turns, 1)
    if fewer:
        assert batch_length("mujoco", load_scene("shaper"), asked, named=False) is None
