"""What runs where nothing is asked for: the profiles of an engine, and less of slow ones."""

from types import SimpleNamespace

import pytest

from models.files.reading import load_scene
from reports.plan import requirements
from reports.plan.requirements import chosen_profiles, usual_length
from reports.protocol.length import Length
from reports.verify.table import footer
from sim.registry import declaration
from tests.worlds.turns import of_turns

SLOW = "newton"


@pytest.mark.parametrize("named", [True, False])
def test_a_slow_engine_runs_fewer_steps_unless_it_is_asked_for_more(named: bool) -> None:
    scene, fewer = load_scene("fourbar-lecture-1"), declaration(SLOW).fewer
    assert fewer is not None
    usual = usual_length(SLOW, scene, Length(), named=named)
    assert usual == Length(steps_per_turn=fewer.steps_per_turn, turns=fewer.turns)
    asked = Length(steps_per_turn=720.0)
    assert usual_length(SLOW, scene, asked, named=named) == asked
    assert usual_length("mujoco", scene, Length(), named=named) == Length()


def test_a_slow_engine_runs_few_scenes_unless_they_are_named() -> None:
    other = load_scene("sixbar-watt")
    assert usual_length(SLOW, other, Length(), named=False) is None
    assert usual_length(SLOW, other, Length(), named=True) is not None


def test_the_table_says_what_a_slow_engine_runs_by_default() -> None:
    cells = [
        SimpleNamespace(cell=of_turns("fourbar-lecture-1", name), errors=None)
        for name in (SLOW, "mujoco")
    ]
    lines = footer(cells, {"made": "now"}).splitlines()  # type: ignore[arg-type]  # all it reads
    (told,) = (line for line in lines if "slow" in line)
    assert told.startswith("newton: slow on a processor; by default 90 steps a turn, 1 turn, and 3")


def test_all_profiles_of_an_engine_are_shown_and_tuned_is_gated(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    profiles = {"as-shipped": None, "tuned": None, "another": None}
    monkeypatch.setattr(requirements, "engine", lambda _: SimpleNamespace(profiles=profiles))
    gated = {"tuned": True, "as-shipped": False, "another": False}
    assert chosen_profiles((), ["an engine"]) == list(gated.items())
    assert chosen_profiles(["another"], ["an engine"]) == [("another", True)]
