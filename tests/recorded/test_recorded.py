"""What a test reaches is recorded, also in children and in what several share; and mutants."""

import shutil
from pathlib import Path

import pytest

from benchmarks.mutants import reaching, statement
from benchmarks.mutants_drawn import COUNT, KINDS, Mutant, listed, mutants_of
from tests.recorded import quick
from tests.recorded.reached import Reached
from tests.recorded.recording import PACKAGES, ROOT
from tests.worlds.tiers import slow

CODE = """\
from functools import cache

LIMIT = 3


def low(number):
    return number < LIMIT


@cache
def doubled(number):
    if number < 0:
        raise ValueError
    return 2 * number


def alone():
    return 1


def in_child():
    return 5
"""
TESTS = """\
import subprocess, sys
import pytest
from models.code import LIMIT, alone, doubled, low

def test_low(): assert low(2)
def test_doubled(): assert doubled(4) == 8
def test_doubled_again(): assert doubled(4) == 8

def test_refused():
    with pytest.raises(ValueError): doubled(-1)

@pytest.fixture(scope="module")
def made(): return alone()

def test_made(made): assert made == 1
def test_made_again(made): assert made == 1

def test_child():
    code = "from models.code import in_child; print(in_child())"
    assert subprocess.check_output([sys.executable, "-c", code]) == b"5\\n"
"""


@pytest.fixture(scope="module")
def reached(tmp_path_factory: pytest.TempPathFactory) -> Reached:
    root = tmp_path_factory.mktemp("checkout")
    for name, text in {"models/code.py": CODE, "tests/test_code.py": TESTS}.items():
        (root / name).parent.mkdir()
        (root / name).write_text(text)
    (root / "models" / "__init__.py").touch()
    shutil.copytree(ROOT / "tests" / "recorded", root / "tests" / "recorded")
    (root / "tests" / "recorded" / "test_recorded.py").unlink()
    quick.record(root / ".recorded", root, tier="")
    return Reached(root / ".recorded", root)


@slow("pytest with two workers and a child, measured: what it finds is a record that is not whole")
def test_a_line_is_reached_by_whoever_gets_what_it_made(reached: Reached) -> None:
    every = {"low", "doubled", "doubled_again", "refused", "made", "made_again", "child"}
    for text, tests in {
        "return number < LIMIT": {"low"},
        "return 2 * number": {"doubled", "doubled_again"},
        "raise ValueError": {"refused"},
        "return 1": {"made", "made_again"},
        "return 5": {"child"},
        "LIMIT = 3": every,
    }.items():
        line = CODE[: CODE.index(text)].count("\n") + 1
        found = reaching(Mutant(1, "constant", "models/code.py", line, 0, 0, "", ""), reached)
        assert {name.removeprefix("tests/test_code.py::test_") for name in found} == tests
    assert not reached.failed


def test_a_statement_has_all_its_lines_and_a_block_its_head(tmp_path: Path) -> None:
    path = tmp_path / "a.py"
    path.write_text(
        "A = (\n    1 +\n    2\n)\ndef f(\n    a,\n):\n    if (\n        a\n    ):\n        g(a)\n"
    )
    assert [statement(path, line) for line in (2, 6, 9, 11)] == [
        (1, 4, False),
        (5, 7, False),
        (8, 10, True),
        (11, 11, True),
    ]


def test_a_mutant_changes_one_piece_of_its_line_and_knows_when_the_line_has_changed() -> None:
    one = Mutant(1, "constant", "a.py", 2, 4, 5, "3", "5")
    assert one.applied("a\nb = 3\nc\n") == "a\nb = 5\nc\n"
    with pytest.raises(ValueError, match=r"a\.py:2 does not read '3' any more"):
        one.applied("a\nb = 4\nc\n")


def test_the_list_has_every_package_and_kind_and_is_drawn_of_what_can_be_changed() -> None:
    every = listed()
    assert [each.number for each in every] == list(range(1, COUNT + 1))
    assert {each.file.partition("/")[0] for each in every} == set(PACKAGES)
    assert {each.kind for each in every} == set(KINDS)
    made = mutants_of(ROOT / "benchmarks" / "mutants_drawn.py")
    assert all(made[kind] for kind in KINDS)
