"""What a test reaches is recorded, also in children and in what several share; and mutants."""

import pytest

from benchmarks.mutants_drawn import COUNT, KINDS, Mutant, listed, mutants_of
from tests.recorded.recording import PACKAGES, ROOT


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
