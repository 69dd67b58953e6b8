"""Schemes: mobility by sources and a second method, causes by name, links for higher pairs; screws,
and classes of joints from contacts: the problem book's examples, lower pairs, any frame."""

import math
from dataclasses import replace
from functools import cache

import mpmath
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from analytic.lectures.schemes import screws
from analytic.lectures.schemes.joint_chains import analyse_joint, chain_of, replaced, teeth_centres
from analytic.lectures.schemes.scheme_loops import IN_PLANE, DrawingFrame, Loops, settled
from analytic.lectures.schemes.scheme_mobility import SchemeMobility, effect_of, scheme_mobility
from models.errors import StructureError
from models.lectures.scheme import HIGHER, Place, Scheme, SchemeJoint
from models.lectures.scheme_files import load_scheme, scheme_text, shipped_schemes
from models.lectures.touching import Contact, Touching, load_touching, shipped_contacts
from models.scene import GROUND
from tests.worlds.tiers import few

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


@pytest.mark.parametrize("name", few(SCHEMES, [*COUNTS, *IDLE], "its count is right as it stands"))
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


def by_bodies(scheme: Scheme) -> int:
    """The motions that the joints leave in the drawn position, from a matrix of all bodies' twists
    and the loads that each joint takes: no loops, no tree."""
    loops = Loops.of(scheme)
    size = scheme.dimension
    columns = IN_PLANE if size == 3 else list(range(6))
    rows = [np.zeros((0, size * len(scheme.links)))]
    for joint in scheme.joints:
        twists = loops.joint_twists(np.zeros(loops.freedoms))[joint.name][columns]
        loads = screws.reciprocal(twists)  # of three numbers in the plane, of six in space
        block = np.zeros((len(loads), size * len(scheme.links)))
        for body, sign in zip(joint.between, (-1.0, 1.0), strict=True):
            if body != GROUND:
                first = size * scheme.links.index(body)
                block[:, first : first + size] = sign * loads
        rows.append(block)
    return size * len(scheme.links) - screws.rank(np.vstack(rows))


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


def test_of_two_bearings_or_ball_ended_rods_one_is_passive_and_a_rod_alone_turns_idly() -> None:
    one = SchemeJoint("A", "revolute", (GROUND, "shaft"), (0.0, 0.0, 0.0), ((1.0, 0.0, 0.0),))
    bearings = (one, replace(one, name="B", at=(0.3, 0.0, 0.0)))
    mobility = scheme_mobility(Scheme("shaft", "spatial", "", ("shaft",), bearings))
    assert (mobility.scheme.count, mobility.real, mobility.idle_count) == (-4, 1, 0)
    assert mobility.passive.joints == ("B",)
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


def test_momentary_motions_and_lengths_a_little_off_are_told() -> None:
    flat, shaky = known("parallelogram-flat"), known("stretched-bars")
    assert (flat.near.is_singular, shaky.near.is_singular) == (True, False)
    assert (flat.near.here, flat.real, flat.yielding) == (2, 1, 0)
    assert (shaky.near.here, shaky.real, shaky.yielding) == (1, 0, 1)
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
    assert screws.rank(np.vstack([before, after])) == screws.rank(before) == screws.rank(after)
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


@pytest.mark.parametrize(("radii", "distance"), [((0.05, 0.1), 0.15), ((-0.11, 0.03), 0.08)])
def test_teeth_have_their_centres_on_the_base_circles(
    radii: tuple[float, float], distance: float
) -> None:
    pressure = math.radians(20.0)
    axes = ((1.0, 0.0, 0.0),)
    teeth = SchemeJoint("T", "gear", (GROUND, "wheel"), axes=axes, radii=radii, pressure=pressure)
    first, second = teeth_centres(teeth)
    bases = np.abs(radii) * math.cos(pressure)
    ends = np.hypot(*first[:2]), np.hypot(second[0] - distance, second[1])
    assert ends == pytest.approx(tuple(bases))


def test_new_links_have_names_of_their_own_and_a_spatial_scheme_gets_none() -> None:
    scheme = load_scheme("cam-flat-follower")
    renamed = [tuple({"cam": "B-link"}.get(end, end) for end in j.between) for j in scheme.joints]
    pairs = zip(scheme.joints, renamed, strict=True)
    joints = tuple(replace(joint, between=own) for joint, own in pairs)
    taken = replace(scheme, links=("B-link", "follower"), joints=joints)
    assert replaced(taken).links == ("B-link", "follower", "B-link-2")
    with pytest.raises(StructureError, match="spatial"):
        replaced(load_scheme("three-ball-table"))


def matrix(twist: np.ndarray) -> np.ndarray:
    """A twist as the matrix (4, 4) whose exponential is its motion."""
    whole = np.zeros((4, 4))
    whole[:3, :3], whole[:3, 3] = screws.cross_matrix(twist[:3]), twist[3:]
    return whole


@pytest.mark.parametrize("size", [0.0, 1e-13, 1e-6, 1e-3, 1.0, 2.5])
def test_a_finite_motion_is_the_exponential_of_its_twist(size: float) -> None:
    for twist in np.random.default_rng(1).standard_normal((5, 6)):
        with mpmath.workdps(40):
            exact = mpmath.expm(mpmath.matrix((size * matrix(twist)).tolist())).tolist()
        assert np.allclose(
            screws.displaced(twist, size), np.array(exact, float), atol=4e-15, rtol=0
        )


def test_a_carried_axis_turns_as_its_body_or_frame_and_a_small_gap_is_its_twist() -> None:
    for twist, way in np.random.default_rng(2).standard_normal((5, 2, 6)):
        move = screws.displaced(way, 1.0)
        there = move @ matrix(twist) @ np.linalg.inv(move)
        assert np.allclose(matrix(screws.carried(move, twist)), there, atol=1e-13)
        assert np.allclose(screws.gap(screws.displaced(twist, 1e-7)) / 1e-7, twist, atol=1e-6)
    frame = DrawingFrame((1.0, 2.0, 3.0), 0.5)
    axis, place = (0.0, 0.6, 0.8), (1.5, 1.0, 2.0)
    drawn = frame.in_drawing(screws.rotation(frame.at(place), axis))
    assert np.allclose(drawn, screws.rotation(place, axis))


def test_freedoms_have_names_where_axes_of_the_frame_do_and_places_else() -> None:
    at = (0.1, 0.0, 0.0)
    pair = np.array(
        [
            screws.rotation(at, (0, 0, 1)) + screws.translation((1, 0, 0)),
            screws.translation((1, 0, 0)),
        ]
    ).T
    assert screws.names_of_freedoms(pair, at) == ["Qz", "Tx"]
    skew = screws.rotation((0.5, 0.0, 0.0), (0.0, 0.0, 1.0))[:, None]
    assert screws.names_of_freedoms(skew, at) == ["turn about (0, 0, 1) through (0.5, 0, 0) m"]
    assert screws.axis_in_words(screws.translation((0.0, 3.0, 4.0))) == "slide along (0, 0.6, 0.8)"
    thread = screws.rotation((0.0, 0.2, 0.0), (1.0, 0.0, 0.0), 0.006 / (2 * np.pi))
    words = "screw about (1, 0, 0) through (0, 0.2, 0) m, 0.006 m in a turn"
    assert screws.axis_in_words(thread) == words
    screwed = contact("thread", (0.5, 0.2, 0.0), lead=0.01)
    joint = analyse_joint(Touching("", "", (0.0, 0.1, 0.0), (screwed,)))
    screw = "screw about (0, 0, 1) through (0.5, 0.2, 0) m, 0.01 m in a turn"
    assert joint.alone.freedoms == (screw,)


def contact(kind: str, at: Place = (0.0, 0.0, 0.0), **given: object) -> Contact:
    """A contact of a kind, with its directions along the frame's where none are given."""
    named = {"normal": (0.0, 0.0, 1.0), "along": (1.0, 0.0, 0.0), "axis": (0.0, 0.0, 1.0)}
    return Contact(kind, at, **{**named, "lead": 0.0, "both_ways": False, **given})


@pytest.mark.parametrize(
    ("name", "alone", "guided", "freedoms"),
    [
        ("point-on-curved-surface", 1, None, ["Qx Qy Qz Tx Ty"]),
        ("two-curved-surfaces", 1, None, ["Qx Qy Qz Tx Ty"]),
        ("line-contact", 2, None, ["Qx Qy Tx Tz"]),
        ("cylinder-in-slot", 2, 4, ["Qx Tz"]),
        ("crossed-cylinders", 1, 4, ["Qz Tz", "Qz Ty"]),
        ("spur-gears", 2, 4, ["Qz Tx"]),
    ],
)
def test_the_six_joints_of_exercise_1_1_have_the_classes_of_the_book(
    name: str, alone: int, guided: int | None, freedoms: list[str]
) -> None:
    joint = analyse_joint(load_touching(name))
    assert not joint.touching.is_lower_pair
    assert joint.alone.constraints == alone
    assert {each.constraints for each in joint.guided.values()} == ({guided} if guided else set())
    assert [" ".join(each.freedoms) for each in joint.guided.values() or [joint.alone]] == freedoms


PAIRS = ["revolute", "prismatic", "screw", "cylindrical", "spherical", "planar", "ball-in-tube"]


@pytest.mark.parametrize("kind", PAIRS)
def test_a_pair_leaves_by_its_contacts_what_it_leaves_in_a_scheme(kind: str) -> None:
    joint = analyse_joint(load_touching(kind))
    axis = (1.0, 0.0, 0.0) if kind in ("prismatic", "ball-in-tube") else (0.0, 0.0, 1.0)
    chain = chain_of(SchemeJoint("A", kind, ("ground", "link"), axes=(axis,), lead=0.006))
    assert joint.alone.constraints == 6 - len(chain)
    assert joint.touching.is_lower_pair == (kind != "ball-in-tube")
    assert len(joint.alone.freedoms) == screws.rank(np.array([each.twist for each in chain]))


@pytest.mark.parametrize("name", shipped_contacts())
def test_the_class_is_the_same_in_every_frame(name: str) -> None:
    touching = load_touching(name)
    turn = Rotation.random(rng=np.random.default_rng(4)).as_matrix()

    def moved(vector: Place, by: float = 0.0) -> Place:
        return tuple((turn @ vector + by).tolist())

    def carried_along(one: Contact) -> Contact:
        ways = {way: moved(getattr(one, way)) for way in ("normal", "along", "axis")}
        return replace(one, at=moved(one.at, 0.7), **ways)

    contacts, at = tuple(map(carried_along, touching.contacts)), moved(touching.at, 0.7)
    there = analyse_joint(replace(touching, at=at, contacts=contacts, guides={}))
    here = analyse_joint(touching)
    assert there.alone.constraints == here.alone.constraints
    assert len(there.alone.freedoms) == 6 - there.alone.constraints
    assert there.kept == here.kept


LEGS = tuple(contact("point", (x, y, 0.0)) for x, y in ((1, 0), (0, 1), (-1, -1)))


def test_form_keeps_what_no_motion_opens_and_a_force_the_rest() -> None:
    down = contact("plane", (0.0, 0.0, 0.01))
    up = contact("plane", (0.0, 0.0, -0.01), normal=(0.0, 0.0, -1.0))
    either = {
        "lies on a plane": (down,),
        "between two planes": (down, up),
        "kept both ways": (replace(down, both_ways=True),),
        "in a round tube, on its end": (contact("circle", both_ways=True), down),
        "on three points": LEGS,
    }
    joints = [Touching(name, "", (0.0, 0.0, 0.0), held) for name, held in either.items()]
    kept = [joint.name for joint in joints if analyse_joint(joint).kept]
    assert kept == ["between two planes", "kept both ways"]
