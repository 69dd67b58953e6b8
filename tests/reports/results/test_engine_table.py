"""Engines side by side: numbers of made-up stores, and the reasons where there are none."""

import math
import re
from collections.abc import Sequence

from reports.results.engine_table import EngineRow, Score, engine_rows, near_ms
from reports.results.looks import looks
from reports.results.overview import Report
from tests.reports.results.made import PERIOD_S, Row, cell, stored

STEPS = (90, 180, 360, 720)
STATUS = ("diverged", "ok")
SECOND = [1e-2 / 4.0**n for n in range(4)]


def line(engine: str, scene: str, errors: Sequence[float], **other: object) -> list[Row]:
    variant = str(other.pop("variant", "tuned"))
    known = {"engine": engine, "gated": variant == "tuned", "reaction_pure": math.nan, **other}
    return [
        cell(scene, variant, steps, error, 2.0, status=STATUS[math.isfinite(error)], **known)
        for steps, error in zip(STEPS, errors, strict=True)
    ]  # fmt: skip


def rows(*parts: list[Row]) -> dict[str, EngineRow]:
    report = Report(stored(row for part in parts for row in part))
    return {row.engine: row for row in engine_rows(report)}


def three() -> list[list[Row]]:
    return [
        *(line("mujoco", scene, SECOND, reaction_pure=0.5) for scene in "ab"),
        line("box2d", "a", [2e-3, 1.1e-3, 1.01e-3, 1e-3]),
        line("box2d", "b", [1e-2, 1e-2, math.inf, math.inf]),
        *(line("simbody", scene, [2e-14] * 4, drive_pure=0.0) for scene in "ab"),
        *(line("drake", scene, SECOND, variant="as-shipped") for scene in "ab"),
    ]


def test_few_engines_are_not_put_side_by_side() -> None:
    parts = three()
    assert rows(*parts[:4]) == {}
    assert list(rows(*parts[:6])) == ["mujoco", "box2d", "simbody"]


def test_engines_of_a_formulation_stand_together_with_their_precision() -> None:
    found = rows(*three())
    assert list(found) == ["mujoco", "drake", "box2d", "simbody"]
    assert [name for name, row in found.items() if row.declaration.precision == "single"] == [
        "box2d"
    ]
    strange = rows(*three(), line("none of ours", "a", SECOND))
    assert strange["none of ours"].declaration.formulation == "own"


def test_each_cell_has_a_number_or_its_reason() -> None:
    found = {name: row.scores for name, row in rows(*three()).items()}
    assert near_ms(Report(stored(row for part in three() for row in part))) == [PERIOD_S / 360] * 2
    good, soft, exact, shipped = (found[e] for e in ("mujoco", "box2d", "simbody", "drake"))
    assert good["near"] == Score("6.3e-4", "worst 6.3e-4, a")
    assert good["order"] == Score("2.0", "")
    assert re.fullmatch(r"< \S+", good["floor"].number)
    assert good["floor"].remark == "not excluded"
    assert good["to 0.001"] == Score("720 \N{MICRO SIGN}s", "tuned, 360 steps a turn")
    assert good["to 0.0001"].remark == "reached on 0 of 2 scenes"
    assert good["forces"] == Score("5.0e-1", "worst 5.0e-1, a")
    assert good["free"] == Score()
    assert soft["near"] == Score("fails", "fails on 1 of 2 scenes")
    assert soft["floor"] == Score("1.0e-3", "on 1 of 2 scenes")
    assert soft["forces"].remark == soft["forces order"].remark == "not reported"
    assert (exact["order"].remark, exact["floor"].remark) == ("at rounding", "at rounding")
    assert (shipped["near"], shipped["to 0.001"].remark) == (
        Score(),
        "as-shipped, 360 steps a turn",
    )


def test_scenes_that_an_engine_can_not_hold_are_told_apart() -> None:
    parts = [part for part in three() if part[0]["engine"] != "simbody"]
    out = [{**row, "status": "unsupported"} for row in line("simbody", "b", SECOND)]
    near = rows(*parts, line("simbody", "a", SECOND), out)["simbody"].scores["near"]
    assert near == Score("6.3e-4", "a; 1 unsupported")
    assert rows(*parts, out)["simbody"].scores["near"].remark == "unsupported"


def test_nine_engines_differ_in_marker_and_colour_and_keep_them_in_both_profiles() -> None:
    engines = [f"engine-{n}" for n in range(9)]
    parts = [line(e, "a", SECOND, variant=v) for e in engines for v in ("as-shipped", "tuned")]
    found = list(looks(Report(stored(row for part in parts for row in part)).lines).values())
    for one in found:
        for other in found:
            if one.engine != other.engine:
                assert one.symbol != other.symbol
                assert one.colour != other.colour
            elif one is not other:
                assert one.dash != other.dash
