"""Schemes: mobility by sources and a second method, causes by name, links for higher pairs."""

import math
from collections.abc import Mapping
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from analytic.lectures.schemes.joint_chains import replaced, teeth_centres
from analytic.lectures.schemes.scheme_loops import IN_PLANE, DrawingFrame, Loops, settled
from analytic.lectures.schemes.scheme_mobility import SchemeMobility, effect_of, scheme_mobility
from analytic.lectures.schemes.screws import rank, reciprocal, rotation
from models.errors import StructureError
from models.lectures.scheme import HIGHER, Place, Scheme, SchemeJoint
from models.lectures.scheme_files import load_scheme, scheme_text, shipped_schemes
from models.scene import GROUND

SCHEMES = shipped_schemes()
COUNTS = {  # by Kutzbach and Gruebler, where the sources' mobility is another one
    "bennett": -2, "bricard-trihedral": 0, "cardan-shaft": 0, "four-bar-in-space": -2, "hooke": -2,
    "parallelogram-third-crank": 0, "planetary-three-planets": -1, "sarrus": 0, "screw-jack": -3,
    "wedge": 0,
}  # fmt: skip
IDLE = {"cam-roller": 1, "rssr": 1, "rssp": 1, "stewart-platform": 6, "delta-robot": 6}


@cache
def known(name: str) -> SchemeMobility:
    return scheme_mobility(load_scheme(name))


@pytest.mark.parametrize("name", SCHEMES)
def test_a_scheme_has_the_mobility_of_its_source_and_of_a_matrix_of_all_bodies(name: str) -> None:
    mobility = known(name)
    scheme = mobility.scheme
    assert mobility.real == scheme.mobility
    assert scheme.count == COUNTS.get(name, scheme.mobility)
    assert mobility.spare == mobility.real - scheme.count
    assert mobility.idle_count == IDLE.get(name, 0)
    assert not mobility.near.others
    assert not mobility.margin_is_small
    assert mobility.near.here == by_bodies(scheme)


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
def test_the_derivative_of_the_closure_is_that_of_differences_and_of_each_joint(name: str) -> None:
    """And a motion in a joint opens the loops as its own freedoms do."""
    loops, at = Loops.of(load_scheme(name)), known(name).near.at
    open_by, slope = loops.closure(at)
    assert np.abs(open_by).max(initial=0.0) < 1e-9
    way = np.random.default_rng(5).standard_normal(loops.freedoms)
    ahead, behind = (loops.closure(at + step * way)[0] for step in (1e-5, -1e-5))
    assert np.allclose((ahead - behind) / 2e-5, slope @ way, atol=1e-7)
    rows = IN_PLANE if loops.scheme.dimension == 3 else list(range(6))
    own = loops.joint_twists(at)
    for joint in loops.scheme.joints:
        opened = effect_of(loops, joint) @ own[joint.name][rows]
        assert np.allclose(opened, slope[:, loops.columns[joint.name]], atol=1e-9)


def moved(scheme: Scheme, seed: int, far: float = 1.0) -> Scheme:
    """The scheme turned, shifted, and with its links and joints in another order."""
    draw, flat = np.random.default_rng(seed), scheme.dimension == 3
    turns = [0.0, 0.0, draw.uniform(0.0, 6.0)] if flat else draw.uniform(-3.0, 3.0, 3)
    turn = Rotation.from_rotvec(turns).as_matrix()
    shift = far * np.array([0.4, -0.3, 0.0 if flat else 0.2])

    def place(vector: Place, by: float = 1.0) -> Place:
        return tuple((turn @ vector + by * shift).tolist())

    axes = [tuple(place(axis, 0.0) for axis in each.axes) for each in scheme.joints]
    pairs = zip(scheme.joints, axes, strict=True)
    joints = [replace(each, at=place(each.at), axes=own) for each, own in pairs]
    order = draw.permutation(len(joints))
    return replace(scheme, links=scheme.links[::-1], joints=tuple(joints[each] for each in order))


MOVED = ["bennett", "cam-roller", "planetary-three-planets", "rssr", "sarrus", "stretched-bars"]


@pytest.mark.parametrize("name", MOVED)
def test_mobility_is_that_of_any_frame_and_order(name: str) -> None:
    here = known(name)
    for far in (1.0, 1e4):
        there = scheme_mobility(moved(load_scheme(name), 6, far))
        assert (there.real, there.rank, there.idle_count) == (here.real, here.rank, here.idle_count)
        assert there.near.here == here.near.here


def renamed(scheme: Scheme, links: Mapping[str, str]) -> tuple[SchemeJoint, ...]:
    ends = [tuple(links.get(end, end) for end in each.between) for each in scheme.joints]
    return tuple(replace(j, between=own) for j, own in zip(scheme.joints, ends, strict=True))


@pytest.mark.parametrize("name", ["bennett", "shaper", "peaucellier", "rscr", "gear-pair"])
def test_mobility_is_that_of_any_link_as_the_ground(name: str) -> None:
    scheme = load_scheme(name)
    joints = renamed(scheme, {scheme.links[0]: GROUND, GROUND: scheme.links[0]})
    assert scheme_mobility(replace(scheme, joints=joints)).real == scheme.mobility


@pytest.mark.parametrize("name", COUNTS)
def test_without_what_is_passive_the_count_is_the_mobility(name: str) -> None:
    mobility = known(name)
    passive = mobility.passive
    fewer = mobility.scheme.without_links(*passive.links).without_joints(*passive.joints)
    assert not fewer.loose()
    assert fewer.count + len(passive.single) == mobility.real
    assert scheme_mobility(fewer).real == mobility.real


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
    one = SchemeJoint("A", "revolute", (GROUND, "shaft"), (0.0, 0.0, 0.0), ((1.0, 0.0, 0.0),))
    bearings = (one, replace(one, name="B", at=(0.3, 0.0, 0.0)))
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
    assert (flat.near.is_singular, shaky.near.is_singular) == (True, False)
    assert (flat.near.here, flat.real, flat.yielding) == (2, 1, 0)
    assert (shaky.near.here, shaky.real, shaky.yielding) == (1, 0, 1)


def test_a_shaky_part_on_a_crank_is_told_from_the_motion_of_the_crank() -> None:
    bars = load_scheme("stretched-bars")
    pivot = SchemeJoint("O", "pin", (GROUND, "crank"), (-0.1, -0.2, 0.0))
    joints = (pivot, *renamed(bars, {GROUND: "crank"}))
    mobility = scheme_mobility(replace(bars, links=("crank", *bars.links), joints=joints))
    assert (mobility.near.here, mobility.real, mobility.yielding) == (2, 1, 1)


def test_a_twist_of_the_frame_is_one_about_the_drawings_origin() -> None:
    frame = DrawingFrame((1.0, 2.0, 3.0), 0.5)
    axis, place = (0.0, 0.6, 0.8), (1.5, 1.0, 2.0)
    there = frame.in_drawing(rotation(frame.at(place), axis))
    assert np.allclose(there, rotation(place, axis))


def test_lengths_that_are_a_little_off_are_told() -> None:
    scheme = load_scheme("bennett")
    joints = {joint.name: joint for joint in scheme.joints}
    x, y, z = joints["A"].at
    joints["A"] = replace(joints["A"], at=(x + 1e-5, y, z))
    mobility = scheme_mobility(replace(scheme, joints=tuple(joints.values())))
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


PLANAR = [scheme for scheme in map(load_scheme, SCHEMES) if scheme.space == "planar"]
WITH_HIGHER = [one.name for one in PLANAR if HIGHER & {joint.kind for joint in one.joints}]
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


def gears(one: str, other: str, radii: tuple[float, float], pressure: float) -> SchemeJoint:
    along = ((1.0, 0.0, 0.0),)
    return SchemeJoint("T", "gear", (one, other), axes=along, radii=radii, pressure=pressure)


@pytest.mark.parametrize(("radii", "distance"), [((0.05, 0.1), 0.15), ((-0.11, 0.03), 0.08)])
def test_teeth_have_their_centres_on_the_base_circles(
    radii: tuple[float, float], distance: float
) -> None:
    pressure = math.radians(20.0)
    first, second = teeth_centres(gears(GROUND, "wheel", radii, pressure))
    bases = np.abs(radii) * math.cos(pressure)
    ends = np.hypot(*first[:2]), np.hypot(second[0] - distance, second[1])
    assert ends == pytest.approx(tuple(bases))


@pytest.mark.parametrize(
    ("radii", "ratio"), [((0.05, 0.03), -0.05 / 0.03), ((-0.11, 0.03), 0.11 / 0.03)]
)
def test_wheels_on_fixed_centres_turn_by_the_ratio_of_their_radii(
    radii: tuple[float, float], ratio: float
) -> None:
    joints = (
        SchemeJoint("A", "pin", (GROUND, "one")),
        SchemeJoint("B", "pin", (GROUND, "two"), (abs(sum(radii)), 0.0, 0.0)),
        gears("one", "two", radii, 0.3),
    )
    loops = Loops.of(Scheme("gears", "planar", "", ("one", "two"), joints))
    (move,) = loops.moves(np.zeros(loops.freedoms)).T
    assert move[1] / move[0] == pytest.approx(ratio)


def test_a_spatial_scheme_is_refused() -> None:
    with pytest.raises(StructureError, match="spatial"):
        replaced(load_scheme("three-ball-table"))


def test_the_new_link_has_a_name_of_its_own() -> None:
    scheme = load_scheme("cam-flat-follower")
    joints = renamed(scheme, {"cam": "B-link"})
    taken = replace(scheme, links=("B-link", "follower"), joints=joints)
    assert replaced(taken).links == ("B-link", "follower", "B-link-2")
