"""The README and the tour are true: every command in them runs, and prints what stands below it.

A block of ``console`` starts with ``$ command``; below it stands what the command prints
(`tests.worlds.pages`). Examples that share no file are tried each by themselves, so that those that
take their time can wait for `make slow`.
"""

import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import pytest

from reports.selftest.trial import FAULTS
from reports.stability.grading import CATALOGUE
from tests.worlds.pages import IN_PARTS, blocks, commands, faults_of, parts, same
from tests.worlds.tiers import slowly

ROOT = Path(__file__).parents[1]
README, *PAGES = (
    (ROOT / name).read_text(encoding="utf-8")
    for name in ("README.md", *(f"docs/{page}.md" for page in IN_PARTS))
)
LONG = {
    "crankcheck sweep fourbar-lecture-1 slotted-lever -o out --steps-per-turn 90,180,360": "15 s: "
    "a sweep, shown in every way; each is tested by its room",
    "crankcheck selftest": "26 s: every fault is planted by tests/reports/selftest",
    "crankcheck stability grashof-excess n-fourbar": "10 s: every case runs in tests/reports",
    "crankcheck stability grashof-excess --engine mujoco --profile as-shipped --at 1e-4": "2 s: "
    "tests/reports/stability has the verdict at a value",
}
"""Commands that take their time, and where else what they do is tested."""
MOST_BYTES = 12_000
"""Of the README, which points on: what needs more has a page."""


def _cases(page: str) -> Iterator[object]:
    """The parts of a page, by their first command or script."""
    for first, part in parts(page).items():
        name = re.sub(r"\s+", " ", first)[:60]
        reason = LONG.get(first)
        yield slowly(part, reason=reason, id=name) if reason else pytest.param(part, id=name)


@pytest.mark.parametrize("part", [case for page in (README, *PAGES) for case in _cases(page)])
def test_readme_and_tour_are_true(part: str, tmp_path: Path) -> None:
    """One after the other in one folder, as a reader would: later commands use what earlier ones
    left."""
    assert not faults_of(part, tmp_path)


@pytest.mark.parametrize("page", [README, *PAGES])
def test_every_command_of_a_page_is_tried_once_in_one_of_its_parts(page: str) -> None:
    whole, tried = (commands(page), blocks(page, "python")), (list[object](), list[str]())
    for part in parts(page).values():
        tried[0].extend(commands(part))
        tried[1].extend(blocks(part, "python"))
    assert [sorted(each, key=str) for each in tried] == [sorted(each, key=str) for each in whole]
    assert len({command for command, _, _ in whole[0]}) == len(whole[0])


def test_the_readme_is_short_without_what_takes_long_and_says_the_two_commands() -> None:
    assert not set(LONG) - {first for page in PAGES for first in parts(page)}
    assert len(README.encode()) <= MOST_BYTES
    assert len(parts(README)) >= 3
    assert not set(LONG) & set(parts(README))
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    for target in ("verify", "test"):
        assert f"make {target}" in README
        assert re.search(rf"^{target}:", makefile, flags=re.MULTILINE)


def test_pages_count_all_faults_that_are_planted_and_hard_cases_that_run_unnamed() -> None:
    of = Counter(fault.kind for fault in FAULTS.values())
    motions = of["motion"] + of["contact"] + of["batch"]  # planted together
    driven = sum(case.way == "driven" for case in CATALOGUE.values())
    counts = {
        f"plants {motions} faults": "reference/tolerances",
        f" {motions} of {motions} faults caught by the named rule ": "reference/tolerances",
        f"plants {of['forces']} faults of force": "forces",
        f"plants {of['free']} faults of dynamics": "free",
        f"`selftest --elastic` plants {of['elastic']} faults": "elastic",
        f"in them, and {of['beam']} in beams": "elastic",
        f"The whole catalogue, {driven} families": "tour",
    }
    text = {name: (ROOT / "docs" / f"{name}.md").read_text("utf-8") for name in counts.values()}
    lost = [said for said, name in counts.items() if said not in " ".join(text[name].split())]
    assert lost == []


def test_comparison_sees_differences() -> None:
    for shown, alike, other in (
        ("rocker 4.676 rad", "rocker  4.676 rad", "rocker 4.677 rad"),
        ("ok rocker 4.676", "ok  rocker 4.700", "ok  rocker 5.700"),
        ("rocker ... rad", "rocker 4.677 rad", "rocker 4.677 deg"),
    ):
        assert same(shown, alike)
        assert not same(shown, other)
