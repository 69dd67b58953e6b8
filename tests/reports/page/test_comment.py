"""The summary for a comment on a pull request: short enough, whole, and telling what matters."""

import itertools
import re
from pathlib import Path

import pytest

from reports.page.comment import summary
from reports.store.reader import Stored, read_store
from tests.reports.output.test_output import NASTY
from tests.reports.results.made import Row, cell, stored, untimed
from tests.worlds.tiers import slowly

LIMIT = 60_000
JUDGED: Row = {"gated": False, "verdict": "within", "reason": "", "failed_rules": "",
               "crankcheck": "0.0.0", "turns": 2.0}  # fmt: skip


def made(number: int, variant: str = "v", **other: object) -> Stored:
    """A store of ``number`` lines with three steps each; other columns are those of the finest."""
    rows = []
    for i, steps in itertools.product(range(number), (90, 180, 360)):
        more = JUDGED | (other if steps == 360 else {})
        more["asked"] = {f"setting_{k}": i for k in range(12)}
        error, name = 1e-3 * (90 / steps) ** 2, f"{variant}{i // 40}"
        rows.append(cell(f"scene-{i % 40}", name, steps, error, 1.0, **more))
    return stored(rows)


def tables(text: str) -> list[list[str]]:
    return [block.split("\n") for block in re.findall(r"(?:^\|.*\n)*^\|.*", text, re.MULTILINE)]


def assert_whole(text: str) -> None:
    assert len(text.encode()) < LIMIT
    assert tables(text)
    for rows in tables(text):
        cells = {len(re.split(r"(?<!\\)\|", row)) for row in rows}
        assert len(cells) == 1, rows[0]
        assert re.fullmatch(r"\|( (---|--:) \|)+", rows[1])
    assert text.count("<details>") == text.count("</details>") > 0
    assert len(re.findall("^```", text, re.MULTILINE)) % 2 == 0


def test_it_is_whole_and_says_what_a_reviewer_asks(store: Path) -> None:
    text = summary(read_store(store))
    assert_whole(text)
    head, *_ = text.split("### What to set")
    assert head.startswith("## crankcheck: within tolerance\n")
    assert "all 8 tuned cells" in head
    assert "1 did not end well" in head
    assert "space.step(dt)" in text
    assert "<option timestep" in text
    assert re.search(r"\| slotted-lever \| mujoco tuned \| order 2\.\d, no floor seen \|", text)
    assert "| fourbar-lecture-1 | pymunk as-shipped | order 1.0, no floor seen |" in text
    failed = r"| slotted-lever | pymunk no bias | diverged | 720 | came apart \| \`at\` 1 s |"
    assert failed in text
    assert "crankcheck 0.0.0, mujoco" in text
    assert "abacus" in text
    assert "| pymunk no bias | error\\_bias 0 |" in text


@pytest.mark.parametrize("number", [1, 40, slowly(80, reason="240 cells, of which more is cut")])
def test_a_large_store_fits_into_a_comment(number: int) -> None:
    failed = {"failed_rules": "CC103 CC105", "reason": "r" * 3000}
    text = summary(made(number, gated=True, verdict="out", **failed))
    assert_whole(text)
    assert ("more" in text) == (number > 1)


@pytest.mark.parametrize("number", [80, slowly(160, reason="480 cells, of which more is cut")])
def test_a_large_store_of_failures_with_long_names_fits(number: int) -> None:
    names = f"{NASTY} " * 4
    assert_whole(summary(made(number, variant=names, status="diverged", reason=NASTY * 40)))


def test_what_is_out_of_tolerance_is_named_with_its_rules() -> None:
    text = summary(made(2, gated=True, verdict="out", failed_rules="CC103"))
    assert text.startswith("## crankcheck: OUT OF TOLERANCE\n")
    (row,) = [r for r in tables(text)[0] if r.startswith("| scene-1 ")]
    assert "mujoco v0" in row
    assert "360" in row
    assert "CC103 " in row
    inside = summary(made(2))
    assert "### Out of tolerance" not in inside
    assert inside.startswith("## crankcheck: no verdict")


def test_the_time_to_reach_an_error_is_given_or_on_how_many_scenes_it_is_reached() -> None:
    def line(scene: str, variant: str, first: float) -> list[Row]:
        errors = {n: first * (90 / n) ** 2 for n in (90, 180, 360)}
        return [cell(scene, variant, n, error, 2.0, **JUDGED) for n, error in errors.items()]

    rows = line("a", "name [of]", 1e-2) + line("b", "name [of]", 1e-2)
    rows += line("a", "late", 1e-2) + [untimed(row) for row in line("b", "late", 1e-1)]
    text = summary(stored(rows))
    assert r"| mujoco name \[of\] | 2.00 | 2.20 | 0.18 | 0.569 | 0/2 | 0/2 |" in text
    assert "| mujoco late | 2.00 (1/2) | 2.20 |  | 1/2 | 0/2 | 0/2 |" in text
    assert "Time to reach" not in summary(stored(map(untimed, rows)))
