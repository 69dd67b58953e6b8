"""Links in place of higher pairs: the count, the velocities and the accelerations stay."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from analytic.structure.drawing_frame import DrawingFrame
from analytic.structure.higher_pairs import replaced, teeth_centres
from analytic.structure.neighbourhood import settled
from analytic.structure.scheme_loops import Loops
from analytic.structure.scheme_mobility import scheme_mobility
from analytic.structure.screws import rank
from models.errors import StructureError
from models.scene import GROUND
from models.scheme import HIGHER, Scheme, SchemeJoint
from models.scheme_files import load_scheme, shipped_schemes

WITH_HIGHER = [
    name
    for name in shipped_schemes()
    if load_scheme(name).space == "planar" and HIGHER & {j.kind for j in load_scheme(name).joints}
]
FRAME = DrawingFrame((0.0, 0.0, 0.0), 0.2)


def motions(scheme: Scheme, links: tuple[str, ...]) -> np.ndarray:
    """The motions (d, 3 n) that some links have in the drawn position."""
    loops = Loops.of(scheme, FRAME)
    q = np.zeros(loops.freedoms)
    placed = loops.placed(q)
    return np.vstack([placed[link].twists[2:5] for link in links] @ loops.moves(q)).T


@pytest.mark.parametrize("name", WITH_HIGHER)
def test_the_count_and_the_velocities_stay(name: str) -> None:
    scheme = load_scheme(name)
    fewer = replaced(scheme)
    assert fewer.count == scheme.count
    assert not HIGHER & {joint.kind for joint in fewer.joints}
    before, after = motions(scheme, scheme.links), motions(fewer, scheme.links)
    assert rank(np.vstack([before, after])) == rank(before) == rank(after)
    if name != "planetary-three-planets":  # whose passive teeth hold in this position alone
        assert scheme_mobility(fewer).real == scheme.mobility


@pytest.mark.parametrize("name", ["cam-flat-follower", "cam-knife-follower"])
def test_a_cam_of_circles_moves_its_follower_as_its_links_do(name: str) -> None:
    scheme = load_scheme(name)
    poses = []
    for each in (scheme, replaced(scheme)):
        loops = Loops.of(each, FRAME)
        move = loops.moves(np.zeros(loops.freedoms))[:, 0]
        crank = loops.columns["A"].start
        move *= 0.3 / move[crank]
        found = settled(loops, move)
        for _ in range(30):  # back to the crank's angle, along the motion
            found[crank] += 0.3 - found[crank]
            found = settled(loops, found)
        poses.append((found[crank], loops.placed(found)["follower"].pose))
    assert poses[0][0] == pytest.approx(poses[1][0], abs=1e-6)
    assert np.allclose(poses[0][1], poses[1][1], atol=1e-5)


def test_a_straight_profile_becomes_a_block_and_a_knife_edge_a_pin() -> None:
    flat = {j.name: j for j in replaced(load_scheme("cam-flat-follower")).joints}
    assert (flat["B-1"].kind, flat["B-2"].kind) == ("pin", "slider")
    assert flat["B-1"].at == pytest.approx((0.02, 0.01, 0.0))
    assert flat["B-2"].between == ("B-link", "follower")
    knife = {j.name: j for j in replaced(load_scheme("cam-knife-follower")).joints}
    assert knife["B-2"].at == pytest.approx((0.02, 0.05, 0.0))


@pytest.mark.parametrize(("radii", "distance"), [((0.05, 0.1), 0.15), ((-0.11, 0.03), 0.08)])
def test_teeth_have_their_centres_on_the_base_circles(
    radii: tuple[float, float], distance: float
) -> None:
    pressure = math.radians(20.0)
    gears = SchemeJoint(
        "T", "gear", (GROUND, "wheel"), axes=((1.0, 0.0, 0.0),), radii=radii, pressure=pressure
    )
    first, second = teeth_centres(gears)
    assert np.hypot(*first[:2]) == pytest.approx(abs(radii[0]) * math.cos(pressure))
    assert np.hypot(second[0] - distance, second[1]) == pytest.approx(
        abs(radii[1]) * math.cos(pressure)
    )


@pytest.mark.parametrize(
    ("radii", "ratio"), [((0.05, 0.03), -0.05 / 0.03), ((-0.11, 0.03), 0.11 / 0.03)]
)
def test_wheels_on_fixed_centres_turn_by_the_ratio_of_their_radii(
    radii: tuple[float, float], ratio: float
) -> None:
    distance = abs(sum(radii))
    joints = (
        SchemeJoint("A", "pin", (GROUND, "one")),
        SchemeJoint("B", "pin", (GROUND, "two"), (distance, 0.0, 0.0)),
        SchemeJoint(
            "T", "gear", ("one", "two"), axes=((1.0, 0.0, 0.0),), radii=radii, pressure=0.3
        ),
    )
    loops = Loops.of(Scheme("gears", "planar", "", ("one", "two"), joints))
    (move,) = loops.moves(np.zeros(loops.freedoms)).T
    assert move[1] / move[0] == pytest.approx(ratio)


def test_a_spatial_scheme_is_refused() -> None:
    with pytest.raises(StructureError, match="spatial"):
        replaced(load_scheme("three-ball-table"))


def test_the_new_link_has_a_name_of_its_own() -> None:
    scheme = load_scheme("cam-flat-follower")
    taken = replace(
        scheme,
        links=("B-link", "follower"),
        joints=tuple(
            replace(j, between=tuple("B-link" if e == "cam" else e for e in j.between))
            for j in scheme.joints
        ),
    )
    assert replaced(taken).links == ("B-link", "follower", "B-link-2")
