"""`crankcheck.solve` of a scene that is let go."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import crankcheck
from analytic.free.release import release


def test_it_is_the_free_motion_over_the_scenes_duration() -> None:
    solution = crankcheck.solve("fourbar-pulse")
    assert isinstance(solution, crankcheck.FreeSolution)
    assert np.array_equal(solution.time_s, np.linspace(0.0, 5.0, 361))
    free = release(crankcheck.load_scene("fourbar-pulse"), 5.0)
    assert np.array_equal(
        solution.links["crank"].omega, free.at(solution.time_s).links["crank"].omega
    )
    assert solution.bound is not None
    assert solution.sensitivity[-1] == pytest.approx(12.5, rel=0.01)
    assert np.all(solution.error_rad < 1e-10)
    frame = solution.frame()
    assert len(frame) == 361
    assert frame["kinetic_j"].iloc[-1] == pytest.approx(frame["work_j"].iloc[-1], rel=1e-9)
    assert "13 of 361 samples" in str(solution)
    assert "<svg" in solution._repr_html_()


def test_of_what_was_asked_for() -> None:
    solution = crankcheck.solve("fourbar-swing", [0.2, 0.1], links="rocker", points=(), bound=False)
    assert list(solution.links) == ["rocker"]
    assert not solution.points
    assert solution.bound is None
    whole = crankcheck.solve("fourbar-swing", [0.1, 0.2])
    assert solution.links["rocker"].theta == pytest.approx(
        whole.links["rocker"].theta[::-1], abs=1e-11
    )


def test_at_the_start_it_has_the_accelerations_of_being_let_go() -> None:
    scene = crankcheck.load_scene("fourbar-swing")
    law = replace(scene.driver.law, duration_s=0.1)  # type: ignore[type-var]  # free
    scene = replace(scene, driver=replace(scene.driver, law=law))
    solution = crankcheck.solve(scene, 0.0)
    assert solution.links["crank"].omega[0] == pytest.approx(0.0, abs=1e-15)
    assert solution.links["crank"].alpha[0] == pytest.approx(-77.20667, rel=1e-6)


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        ({"time_s": [-0.1, 0.1]}, "it was let go at 0"),
        ({"time_s": 0.1, "forces": True}, "forces=True: fourbar-swing is let go"),
        ({"time_s": 0.1, "links": "rokcer"}, "rokcer"),
        ({"time_s": np.nan}, "finite"),
    ],
)
def test_what_can_not_be_asked_is_refused(asked: dict[str, object], said: str) -> None:
    with pytest.raises(crankcheck.CrankcheckError, match=said):
        crankcheck.solve("fourbar-swing", **asked)  # type: ignore[arg-type]  # it is wrong
