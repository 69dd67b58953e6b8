"""What the sections say, on made-up stores."""

import itertools
import math
import re
from collections.abc import Sequence
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pandas as pd
import pytest

from models.files.reading import load_scene
from reports.output.numbers import duration
from reports.page.build import render
from reports.page.sections import SECTIONS
from reports.page.sections.copied import reading_forces as build_forces
from reports.page.sections.copied import recommendation as build_recommendation
from reports.page.sections.errors import precision as build_precision
from reports.page.sections.section import PageReport, Section, chosen, steps_held
from reports.page.sections.stability import holds
from reports.page.sections.verdict import build as build_verdict
from reports.results.overview import Report
from tests.reports.results.made import Row, cell, stored, untimed

STEPS = (90, 180, 360, 720)


def line(scene: str, variant: str, errors: Sequence[float], **other: object) -> list[Row]:
    """The cells of a line; an error that is not finite has come apart."""
    limit, found = other.pop("limit", 1.0), []
    for steps, error in zip(STEPS, errors, strict=True):
        verdict = "within" if error <= limit else "out"
        status = "ok" if math.isfinite(error) else "diverged"
        known = {"gated": variant == "tuned", "verdict": verdict, "status": status, **other}
        found.append(cell(scene, variant, steps, error, 2.0, **known))
    return found


def second_order(first: float) -> list[float]:
    return [first / 4.0**n for n in range(4)]


TUNED = line("a", "tuned", second_order(1e-3))


def report_of(*rows: list[Row]) -> Report:
    return Report(stored(row for part in rows for row in part))


def sentences(*rows: list[Row]) -> dict[str, str]:
    words = build_verdict(report_of(*rows)).words
    found = {engine: text for engine, _, text in words["sentences"]}
    return {"verdict": words["verdict"], "level": words["level"], **found}


def test_the_verdict_counts_what_is_judged() -> None:
    shipped, out = line("a", "as-shipped", [2.0] * 4), line("b", "tuned", [2.0, 1e-3, 1e-3, 1e-3])
    for rows, level, told in (
        ([TUNED, shipped], "within", r"Within tolerance: all 4 tuned cells of mujoco\.$"),
        ([TUNED, out], "out", r"Out of tolerance: 1 of 8 tuned cells of mujoco.*b \(1\)"),
        ([shipped], "none", "No verdict"),
    ):
        found = sentences(*rows)
        assert found["level"] == level
        assert re.match(told, found["verdict"])


def test_the_sentence_of_an_engine_tells_order_cost_and_floor() -> None:
    shipped = line("a", "as-shipped", [3e-3, 2.1e-3, 2.01e-3, 2e-3], limit=0.0)
    found = sentences(shipped, TUNED)["mujoco"]
    assert "With tuned settings it is within tolerance in 4 of 4 cells" in found
    assert "its error shrinks with order 2.0 of the step; a floor below " in found
    assert "Cheapest for an error of 1e-4 on every scene: tuned at 360 steps a turn" in found
    assert "720 µs a turn" in found
    assert "As shipped it is within tolerance in 0 of 4 cells: on 1 of 1 scene" in found
    assert "the error stops shrinking, at 2.0e-3, however small the step" in found
    told = sentences(TUNED[:2])["mujoco"]
    assert "too few steps to see a floor" in told
    assert "not excluded" not in told


def test_what_reaches_nothing_and_what_fails_is_said() -> None:
    found = sentences(line("a", "tuned", [1e-2, 5e-3, math.inf, math.inf]))["mujoco"]
    assert "2 runs of them failed" in found
    assert "For an error of 1e-4 on every scene: nearest is tuned at" in found
    fails = line("b", "tuned", second_order(1e-6))
    fails[-1]["status"] = "branch-changed"
    (row,) = build_verdict(report_of(TUNED, fails)).words["rows"]
    assert (row.finest, row.worst_scene) == (math.inf, "b")


def test_engines_stand_side_by_side_with_the_cheapest_and_a_steadier_choice_named() -> None:
    other = line("a", "tuned", second_order(1e-1), engine="pymunk")
    found = build_recommendation(report_of(TUNED, other)).words["rows"]
    told = [(row["one"].target, row["one"].best.engine, row["cheapest"]) for row in found]
    assert told[2:4] == [(1e-3, "mujoco", True), (1e-3, "pymunk", False)]
    alone = build_recommendation(report_of(TUNED)).words["rows"]
    assert not any(row["cheapest"] for row in alone)
    wild = report_of(TUNED, line("a", "wild", [1e-4, *[math.inf] * 3]))
    every = build_recommendation(wild).words["rows"]
    told = [(row["one"].best.variant, row["steadier"]) for row in every]
    assert told == [("wild", False), ("tuned", True)] * 3 + [("tuned", False)]


@pytest.mark.parametrize(
    ("ran", "within", "level", "runs", "within_told"),
    [
        ("1111", "1111", "all", "every step", "within: all"),
        ("1111", "0011", "all", "every step", "within: from 360"),
        ("1111", "1010", "all", "every step", "within: 90, 360"),
        ("0011", "0011", "some", "from 360 on; diverged below", "within: from 360"),
        ("1011", "0000", "some", "diverged at 180", "within: none"),
        ("0000", "0000", "none", "diverged at every step", "within: none"),
    ],
)
def test_stability_says_from_which_step_on_a_line_holds(
    ran: str, within: str, level: str, runs: str, within_told: str
) -> None:
    cells = pd.DataFrame({"drive": "prescribed", "steps_per_turn": STEPS})
    cells["status"] = ["ok" if mark == "1" else "diverged" for mark in ran]
    cells["verdict"] = ["within" if mark == "1" else "out" for mark in within]
    found = holds(cells)
    assert (found.level, found.runs, found.within) == (level, runs, within_told)


def test_pages_that_would_grow_too_large_keep_the_ends_of_each_line() -> None:
    lines = report_of(TUNED).lines
    (only,) = lines
    sizes = {str(key): 100 for key in only.cells["key"]}
    keys = list(sizes)
    assert [steps_held(sizes, lines, budget=room) for room in (400, 399, 1)] == [4, 3, 2]
    assert chosen(only, sizes, 2) == [keys[0], keys[-1]]
    assert chosen(only, sizes, 4) == keys
    assert chosen(only, {keys[1]: 100}, 4) == [keys[1]]


def test_the_time_to_reach_an_error_is_given_or_on_how_many_scenes_it_is_reached() -> None:
    rows = line("a", "tuned", second_order(1e-2)) + line("b", "tuned", second_order(1e-2))
    rows += line("a", "late", second_order(1e-2)) + line("b", "late", second_order(1e-1))
    report = report_of(rows)
    section = build_precision(report)
    tuned, late = section.words["costs"]
    assert late["to"][1] == (None, "1/2")
    text = render(report, [section])
    assert '<td class="num" data-value="">1/2</td>' in text
    assert f">{duration(tuned['to'][1][0])}</td>" in text
    nothing = report_of([untimed(row) for row in rows])
    assert "Time to reach" not in render(nothing, [build_precision(nothing)])


def test_settings_are_told_as_what_differs_from_the_engine_as_shipped() -> None:
    """Or from the first, where none is as shipped."""
    usual = {"iterations": 10, "bias": 0.5}
    settings = {"iterations": 10, "bias": 0.5, "close": ""}
    shipped = [
        ("as-shipped", "mujoco", settings, "every setting as the engine is shipped"),
        ("tuned", "mujoco", {**settings, "iterations": 50, "close": "C"}, "iterations 50, close C"),
        ("alone", "pymunk", {"x": 1.0, "y": ""}, "x 1, y none"),
    ]
    none_shipped = [
        ("first", "mujoco", usual, "iterations 10, bias 0.5"),
        ("other", "mujoco", {**usual, "iterations": 50}, "as first, but iterations 50"),
        ("twin", "mujoco", usual, "as first"),
    ]
    for lines in (shipped, none_shipped):
        rows = [line("a", name, [1e-3] * 4, engine=of, asked=own) for name, of, own, _ in lines]
        found = {variant: told for (_, variant, _), told in report_of(*rows).settings_told.items()}
        assert found == {name: told for name, _, _, told in lines}


def test_looks_differ_in_colour_and_in_dash_within_an_engine() -> None:
    named = itertools.product(("mujoco", "pymunk"), "abc")
    found = report_of(*(line("s", v, [1e-3] * 4, engine=engine) for engine, v in named)).looks
    assert len({look.colour for look in found.values()}) == 6
    assert len({look.dash for look in found.values() if look.engine == "mujoco"}) == 3


def test_forces_are_told_at_the_finest_step_with_a_program_where_they_were_asked_for() -> None:
    plain = [*TUNED, *line("b", "tuned", second_order(1e-3))]
    assert build_forces(report_of(plain)) is None
    sizes = [4e-2, 3e-2, 2e-2, 1e-2, 8e-2, 6e-2, 4e-2, 2e-2]
    asked = [{**row, "reaction_pure": size, "torque_pure": 2.0 * size}
             for row, size in zip(plain, sizes, strict=True)]  # fmt: skip
    report = report_of(asked)
    section = build_forces(report)
    (told,) = section.words["rows"]
    assert (told["steps"], told["reaction"], told["reaction_scene"]) == (720, 2e-2, "b")
    assert (told["torque"], told["torque_scene"]) == (4e-2, "b")
    assert "4.0e-2" in render(report, [section])
    asked[-1] = asked[-1] | {"status": "diverged", "reaction_pure": math.nan}
    assert build_forces(report_of(asked)).words["rows"][0]["reaction"] == math.inf


def test_cams_have_their_laws_and_the_pressure_angle_round_their_profiles() -> None:
    def of(name: str) -> Section | None:
        return SECTIONS["cams"](cast(PageReport, SimpleNamespace(scenes={name: load_scene(name)})))

    assert of("fourbar-lecture-1") is None
    section = of("cam-flat")  # a circle of 50 mm, 10 mm off its shaft, under a flat face
    assert section is not None
    assert section.embedded is not None
    (cam,) = cast(Sequence[Any], section.embedded["cams"])
    phi = np.linspace(0.0, 2.0 * np.pi, 360, endpoint=False)
    course = [1.0 - np.cos(phi), np.sin(phi), np.cos(phi), -np.sin(phi), np.zeros(360)]
    for found, true in zip(cam["curves"], course, strict=True):
        assert np.allclose(found, 0.01 * true, atol=1e-12)
    middle = np.mean(cam["x"]), np.mean(cam["y"])
    assert np.hypot(*middle) == pytest.approx(0.01, abs=1e-9)
    assert np.allclose(np.hypot(cam["x"] - middle[0], cam["y"] - middle[1]), 0.05, atol=1e-9)
    assert (cam["name"], cam["unit"]) == ("cam-flat, disc", "m")
