"""Mobility of schemes: what sources give, by a second method, in other frames, named causes."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from analytic.structure.drawing_frame import DrawingFrame
from analytic.structure.passive import effect_of
from analytic.structure.scheme_loops import IN_PLANE, Loops
from analytic.structure.scheme_mobility import SchemeMobility, scheme_mobility
from analytic.structure.screws import rank, reciprocal, rotation
from models.scene import GROUND
from models.scheme import Place, Scheme, SchemeJoint
from models.scheme_files import load_scheme, shipped_schemes
from models.scheme_text import scheme_text

SCHEMES = shipped_schemes()
COUNTS = {
    # by Kutzbach and Gruebler, where the sources' mobility is another one
    "bennett": -2,
    "bricard-trihedral": 0,
    "cardan-shaft": 0,
    "four-bar-in-space": -2,
    "hooke": -2,
    "parallelogram-third-crank": 0,
    "planetary-three-planets": -1,
    "sarrus": 0,
    "screw-jack": -3,
    "wedge": 0,
}
IDLE = {"cam-roller": 1, "rssr": 1, "rssp": 1, "stewart-platform": 6, "delta-robot": 6}


@cache
def known(name: str) -> SchemeMobility:
    """A shipped scheme, looked at once for all tests."""
    return scheme_mobility(load_scheme(name))


@pytest.mark.parametrize("name", SCHEMES)
def test_a_scheme_has_the_mobility_of_its_source(name: str) -> None:
    mobility = known(name)
    scheme = mobility.scheme
    assert mobility.real == scheme.mobility
    assert scheme.count == COUNTS.get(name, scheme.mobility)
    assert mobility.spare == mobility.real - scheme.count
    assert mobility.idle_count == IDLE.get(name, 0)
    assert not mobility.near.others
    assert not mobility.margin_is_small


def test_there_are_twenty_schemes_and_more_of_both_spaces() -> None:
    spaces = [load_scheme(name).space for name in SCHEMES]
    assert spaces.count("planar") >= 10
    assert spaces.count("spatial") >= 10


def by_bodies(scheme: Scheme) -> int:
    """The motions that the joints leave in the drawn position, from a matrix of all bodies' twists
    and the loads that each joint takes: no loops, no tree."""
    loops = Loops.of(scheme)
    size = scheme.dimension
    columns = IN_PLANE if size == 3 else list(range(6))
    rows = [np.zeros((0, size * len(scheme.links)))]
    for joint in scheme.joints:
        twists = loops.joint_twists(np.zeros(loops.freedoms))[joint.name][columns]
        loads = reciprocal(twists)  # of three numbers in the plane, of six in space
        block = np.zeros((len(loads), size * len(scheme.links)))
        for body, sign in zip(joint.between, (-1.0, 1.0), strict=True):
            if body != GROUND:
                first = size * scheme.links.index(body)
                block[:, first : first + size] = sign * loads
        rows.append(block)
    return size * len(scheme.links) - rank(np.vstack(rows))


@pytest.mark.parametrize("name", SCHEMES)
def test_the_drawn_position_leaves_what_a_matrix_of_all_bodies_leaves(name: str) -> None:
    assert known(name).near.here == by_bodies(load_scheme(name))


@pytest.mark.parametrize("name", SCHEMES)
def test_the_derivative_of_the_closure_is_that_of_differences(name: str) -> None:
    loops, at = Loops.of(load_scheme(name)), known(name).near.at
    open_by, slope = loops.closure(at)
    assert np.abs(open_by).max(initial=0.0) < 1e-9
    way = np.random.default_rng(5).standard_normal(loops.freedoms)
    ahead, behind = (loops.closure(at + step * way)[0] for step in (1e-5, -1e-5))
    assert np.allclose((ahead - behind) / 2e-5, slope @ way, atol=1e-7)


@pytest.mark.parametrize("name", SCHEMES)
def test_a_motion_in_a_joint_opens_the_loops_as_its_own_freedoms_do(name: str) -> None:
    loops, at = Loops.of(load_scheme(name)), known(name).near.at
    rows = IN_PLANE if loops.scheme.dimension == 3 else list(range(6))
    slope, own = loops.closure(at)[1], loops.joint_twists(at)
    for joint in loops.scheme.joints:
        opened = effect_of(loops, joint) @ own[joint.name][rows]
        assert np.allclose(opened, slope[:, loops.columns[joint.name]], atol=1e-9)


def moved(scheme: Scheme, seed: int, far: float = 1.0) -> Scheme:
    """The scheme turned, shifted, and with its links and joints in another order."""
    draw = np.random.default_rng(seed)
    if scheme.dimension == 3:
        turn = Rotation.from_rotvec([0.0, 0.0, draw.uniform(0.0, 6.0)]).as_matrix()
    else:
        turn = Rotation.random(rng=draw).as_matrix()
    shift = far * np.array([0.4, -0.3, 0.0 if scheme.dimension == 3 else 0.2])

    def place(vector: Place, by: float = 1.0) -> Place:
        x, y, z = turn @ vector + by * shift
        return (float(x), float(y), float(z))

    joints = [
        replace(
            each,
            at=place(each.at),
            axes=tuple(place(axis, 0.0) for axis in each.axes),
            between=each.between,
        )
        for each in scheme.joints
    ]
    order = draw.permutation(len(joints))
    return replace(scheme, links=scheme.links[::-1], joints=tuple(joints[each] for each in order))


@pytest.mark.parametrize(
    "name", ["bennett", "cam-roller", "planetary-three-planets", "rssr", "sarrus", "stretched-bars"]
)
def test_mobility_is_that_of_any_frame_and_order(name: str) -> None:
    here = known(name)
    for far in (1.0, 1e4):
        there = scheme_mobility(moved(load_scheme(name), 6, far))
        assert (there.real, there.rank, there.idle_count) == (here.real, here.rank, here.idle_count)
        assert there.near.here == here.near.here


@pytest.mark.parametrize("name", ["bennett", "shaper", "peaucellier", "rscr", "gear-pair"])
def test_mobility_is_that_of_any_link_as_the_ground(name: str) -> None:
    scheme = load_scheme(name)
    link = scheme.links[0]
    swap = {link: GROUND, GROUND: link}
    joints = tuple(
        replace(
            each,
            between=(swap.get(each.between[0], each.between[0]), swap.get(*each.between[1:] * 2)),
        )
        for each in scheme.joints
    )
    assert scheme_mobility(replace(scheme, joints=joints)).real == scheme.mobility


@pytest.mark.parametrize("name", COUNTS)
def test_without_what_is_passive_the_count_is_the_mobility(name: str) -> None:
    mobility = known(name)
    passive = mobility.passive
    fewer = mobility.scheme.without_links(*passive.links).without_joints(*passive.joints)
    assert not fewer.loose()
    assert fewer.count + len(passive.single) == mobility.real
    without = scheme_mobility(fewer)
    assert without.real == mobility.real


def test_what_is_passive_and_idle_is_named() -> None:
    third = known("parallelogram-third-crank").passive
    assert (third.links, third.also) == (("crank-3",), ("crank", "crank-2"))
    planets = known("planetary-three-planets").passive
    assert (planets.links, planets.also) == (("planet-3", "planet-2"), ("planet",))
    assert [joint for joint, _ in known("wedge").passive.single] == ["S"]
    assert [motion for _, motion in known("wedge").passive.single] == ["Qz"]
    space = known("four-bar-in-space").passive.single
    assert [motion for _, motion in space] == ["Qx", "Qy", "Tz"]
    assert [str(each) for each in known("cam-roller").idle] == ["roller: turns about C"]
    (rod,) = known("rssr").idle
    assert str(rod) == "coupler: turns about the line through B and C"
    legs = known("stewart-platform").idle
    assert [each.links for each in legs] == [(f"cylinder-{k}", f"piston-{k}") for k in range(1, 7)]


def test_a_shaft_in_two_bearings_has_one_that_is_passive_and_no_idle_turn() -> None:
    bearings = tuple(
        SchemeJoint(name, "revolute", (GROUND, "shaft"), (x, 0.0, 0.0), ((1.0, 0.0, 0.0),))
        for name, x in (("A", 0.0), ("B", 0.3))
    )
    mobility = scheme_mobility(Scheme("shaft", "spatial", "", ("shaft",), bearings))
    assert (mobility.scheme.count, mobility.real, mobility.idle_count) == (-4, 1, 0)
    assert mobility.passive.joints == ("B",)


def test_a_spare_rod_between_balls_is_redundant_and_has_an_idle_turn() -> None:
    four_bar = load_scheme("four-bar-in-space")
    across = {"C": (0.36, 0.08, 0.0), "D": (0.3, 0.0, 0.0)}  # a parallelogram
    joints = [replace(each, at=across.get(each.name, each.at)) for each in four_bar.joints]
    ends = (("E", "coupler", (0.2, 0.08, 0.05)), ("F", GROUND, (0.14, 0.0, 0.05)))
    joints += [SchemeJoint(name, "spherical", (link, "rod"), at) for name, link, at in ends]
    scheme = replace(four_bar, links=(*four_bar.links, "rod"), joints=tuple(joints))
    mobility = scheme_mobility(scheme)
    assert (scheme.count, mobility.real, mobility.useful) == (-2, 2, 1)
    assert mobility.passive.links == ("rod",)
    assert len(mobility.passive.single) == 3


def test_a_momentary_motion_counts_in_the_drawn_position_alone() -> None:
    flat, shaky = known("parallelogram-flat"), known("stretched-bars")
    assert flat.near.is_singular
    assert (flat.near.here, flat.real, flat.yielding) == (2, 1, 0)
    assert (shaky.near.here, shaky.real, shaky.yielding) == (1, 0, 1)
    assert not shaky.near.is_singular


def test_a_shaky_part_on_a_crank_is_told_from_the_motion_of_the_crank() -> None:
    bars = load_scheme("stretched-bars")
    carried = tuple(
        replace(each, between=tuple("crank" if end == GROUND else end for end in each.between))
        for each in bars.joints
    )
    crank = SchemeJoint("O", "pin", (GROUND, "crank"), (-0.1, -0.2, 0.0))
    scheme = replace(bars, links=("crank", *bars.links), joints=(crank, *carried))
    mobility = scheme_mobility(scheme)
    assert (mobility.near.here, mobility.real, mobility.yielding) == (2, 1, 1)


def test_a_twist_of_the_frame_is_one_about_the_drawings_origin() -> None:
    frame = DrawingFrame((1.0, 2.0, 3.0), 0.5)
    axis, place = (0.0, 0.6, 0.8), (1.5, 1.0, 2.0)
    there = frame.in_drawing(rotation(frame.at(place), axis))
    assert np.allclose(there, rotation(place, axis))


def test_lengths_that_are_a_little_off_are_told() -> None:
    scheme = load_scheme("bennett")
    at = {joint.name: joint.at for joint in scheme.joints}
    off = tuple(
        replace(each, at=(at["A"][0] + 1e-5, *at["A"][1:])) if each.name == "A" else each
        for each in scheme.joints
    )
    mobility = scheme_mobility(replace(scheme, joints=off))
    assert mobility.real == 0
    assert mobility.margin_is_small


@pytest.mark.parametrize("name", SCHEMES)
def test_a_scheme_written_and_read_is_the_same(name: str, tmp_path) -> None:  # type: ignore[no-untyped-def]
    scheme = load_scheme(name)
    (tmp_path / "again.toml").write_text(scheme_text(scheme), encoding="utf-8")
    again = load_scheme(str(tmp_path / "again.toml"))
    assert replace(again, joints=()) == replace(scheme, joints=())
    for one, other in zip(again.joints, scheme.joints, strict=True):
        assert (one.name, one.kind, one.between) == (other.name, other.kind, other.between)
        assert np.allclose(one.axes, other.axes, atol=1e-15)
        assert (one.at, one.radii, one.lead) == (other.at, other.radii, other.lead)
