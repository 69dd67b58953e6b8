"""`crankcheck.solve` of a scene with elastic links."""

from __future__ import annotations

import re

import numpy as np
import pytest

import crankcheck

NAME = "fourbar-elastic"


def test_it_is_the_elastic_motion_beside_the_rigid_one() -> None:
    solution = crankcheck.solve(NAME)
    assert isinstance(solution, crankcheck.ElasticSolution)
    assert solution.time_s.size == 361
    shape = solution.elastic["coupler"]
    assert np.max(np.abs(shape.middle)) == pytest.approx(1.05e-3, rel=0.01)
    assert shape.middle[-1] == pytest.approx(shape.middle[0], abs=1e-13)  # it comes back
    apart = solution.links["rocker"].theta - solution.rigid.links["rocker"].theta
    assert 1e-6 < np.max(np.abs(apart)) < 1e-5
    assert solution.forces is None
    assert "coupler_deflection_m" in solution.frame()
    assert "13 of 361 samples" in str(solution)
    assert "<svg" in solution._repr_html_()


def test_of_what_was_asked_for() -> None:
    forces = crankcheck.solve(NAME, [0.2, -0.1], links="coupler", points=(), forces=True)
    assert list(forces.links) == list(forces.elastic) == ["coupler"]
    assert not forces.points
    assert forces.forces is not None
    assert not crankcheck.solve(NAME, 0.1, links="rocker", modes=1).elastic
    linear = crankcheck.solve(NAME, [0.2], elements=2, linear=True)
    assert linear.elastic["coupler"].extension == pytest.approx(0.0, abs=1e-15)


def test_a_straight_start_rings(capsys: pytest.CaptureFixture[str]) -> None:
    """On one mode, and a tenth of a turn: a few tenths of a second."""
    solution = crankcheck.solve(NAME, np.linspace(0.0, 0.085, 50), shape="straight", modes=1)
    middle = solution.elastic["coupler"].middle
    assert abs(middle[0]) < 1e-18
    assert np.max(np.abs(middle)) > 1.2e-3
    print(solution)
    assert "Starts straight: it rings" in " ".join(capsys.readouterr().out.split())


@pytest.mark.parametrize(
    ("name", "asked"),
    [(NAME, {"elements": 1, "shape": "straight"}), ("fourbar-elastic-pulse", {"modes": 1})],
)
def test_the_coarsest_of_all_descriptions_is_not_held_to_itself(
    name: str, asked: dict[str, object]
) -> None:
    (told,) = crankcheck.solve(name, [0.0, 0.02], **asked).certainty  # type: ignore[arg-type]
    found = re.search(r"next finer description.*deflections are off by about (\S+) of", told)
    assert found, told
    assert float(found[1]) > 1e-3


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        ({"shape": "straight", "time_s": [-0.1, 0.1]}, "starts at 0, straight"),
        ({"modes": 2.5}, "modes: found"),
        ({"modes": 2, "elements": 2}, "elements with modes"),
        ({"shape": 3}, "shape 3: unknown"),
        ({"linear": "yes"}, "linear: found"),
        ({"links": "rokcer"}, "rokcer"),
    ],
)
def test_what_can_not_be_asked_is_refused(asked: dict[str, object], said: str) -> None:
    with pytest.raises(crankcheck.CrankcheckError, match=said):
        crankcheck.solve(NAME, **asked)  # type: ignore[arg-type]  # it is wrong


def test_a_rigid_scene_has_nothing_to_be_asked_of_elastic_links() -> None:
    with pytest.raises(crankcheck.CrankcheckError, match="modes: fourbar-lecture-1 has no elastic"):
        crankcheck.solve("fourbar-lecture-1", modes=3)
    with pytest.raises(crankcheck.CrankcheckError, match="shape: fourbar-swing has no elastic"):
        crankcheck.solve("fourbar-swing", shape="straight")
