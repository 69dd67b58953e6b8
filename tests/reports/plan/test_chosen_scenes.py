"""What is run where scenes are named, a kind of them, or none."""

from __future__ import annotations

from models.files import shipped
from reports.plan.chosen import chosen_scenes, left_out_note


def test_no_name_means_the_scenes_of_kinematics_alone() -> None:
    assert [scene.name for scene in chosen_scenes(())] == list(shipped())


def test_a_kind_stands_for_all_its_scenes_each_once() -> None:
    names = [scene.name for scene in chosen_scenes(["shaper", "compressor", "forces"])]
    assert names[:2] == ["shaper", "compressor"]
    left = {"compressor", "slider-crank-self-locking"}
    assert names[2:] == [name for name in shipped("forces") if name not in left]


def test_what_a_kind_has_for_the_reference_alone_is_left_out_with_a_note() -> None:
    note = left_out_note(["forces", "shaper"])
    assert note.startswith("slider-crank-self-locking: left out, as engines are given no friction")
    assert left_out_note(["forces", "slider-crank-self-locking"]) == ""
    assert left_out_note(["kinematics", "shaper"]) == left_out_note(()) == ""


def test_elastic_links_that_are_let_go_are_run_where_they_are_named() -> None:
    note = left_out_note(["elastic"])
    assert "fourbar-elastic-controlled and fourbar-elastic-pulse: left out" in note
    assert "run where they are named" in note
    assert left_out_note(["elastic", "fourbar-elastic-pulse", "fourbar-elastic-controlled"]) == ""
