"""Tracks of what a run logged, and of what it lacks."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from models.scene import Scene
from reports.compare.beside import Truth
from reports.compare.tracks import tracks
from sim.engine import Run


def test_what_a_run_lacks_is_one_nan_for_all_its_samples(
    fourbar: Scene, disturbed: Callable[..., Run]
) -> None:
    run = disturbed(fourbar)
    rocker = run.motion.links["rocker"]
    lacking = {
        "coupler": rocker,
        "rocker": replace(rocker, omega=np.full_like(rocker.omega, np.nan)),
    }
    part = replace(run, motion=replace(run.motion, links=lacking))
    reference = Truth(fourbar).at(run.motion.time_s)
    errors = {
        track.body: track.error
        for track in tracks(fourbar, part, reference, ("velocity",))
        if track.body_kind == "link"
    }
    assert errors["coupler"].strides == (8,)
    for body in ("crank", "rocker"):
        assert errors[body].shape == run.motion.time_s.shape
        assert errors[body].strides == (0,)
        assert np.isnan(errors[body]).all()
