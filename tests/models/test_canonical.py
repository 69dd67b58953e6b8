"""The MJCF kept in models/canonical/ is what the builder writes; `make models` writes it anew."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

import models
from analytic.kinematics import solve
from models.files import load_scene
from models.mjcf import build

FOLDER = Path(models.__file__).parent / "canonical"
NUMBER = re.compile(r"-?\d+\.\d+(?:e-?\d+)?")


def written(name: str) -> str:
    scene = load_scene(name)
    return build(scene, solve(scene, np.zeros(1)).state())


def same(kept: str, new: str) -> bool:
    """The same text; numbers may differ in their last digits, as processors' sines do."""
    if NUMBER.split(kept) != NUMBER.split(new):
        return False
    pairs = [np.array(NUMBER.findall(text), dtype=float) for text in (kept, new)]
    return bool(np.allclose(*pairs, rtol=1e-13, atol=1e-15))


@pytest.mark.parametrize("name", ["fourbar-lecture-1", "slider-crank-central"])
def test_kept_file_is_what_the_builder_writes(name: str) -> None:
    assert same((FOLDER / f"{name}.xml").read_text(encoding="utf-8"), written(name))


def test_comparison_sees_a_changed_number_and_a_changed_word() -> None:
    text = written("fourbar-lecture-1")
    assert not same(text, text.replace("0.25", "0.25000001"))
    assert not same(text, text.replace("RK4", "Euler"))
