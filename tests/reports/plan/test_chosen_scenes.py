"""What is run where scenes are named, a kind of them, or none."""

from __future__ import annotations

from models.files import shipped
from reports.plan.chosen import chosen_scenes


def test_no_name_means_the_scenes_of_kinematics_alone() -> None:
    assert [scene.name for scene in chosen_scenes(())] == list(shipped())


def test_a_kind_stands_for_all_its_scenes_each_once() -> None:
    names = [scene.name for scene in chosen_scenes(["shaper", "compressor", "forces"])]
    assert names == ["shaper", "compressor", *[n for n in shipped("forces") if n != "compressor"]]
