"""Screws; classes of joints from contacts: the problem book's examples, lower pairs, any frame."""

from dataclasses import replace

import mpmath
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from analytic.lectures.schemes import screws
from analytic.lectures.schemes.joint_chains import analyse_joint, chain_of
from analytic.lectures.schemes.screws import (
    axis_in_words,
    carried,
    displaced,
    gap,
    names_of_freedoms,
    reciprocal,
    rotation,
    translation,
)
from models.lectures.scheme import Place, SchemeJoint
from models.lectures.touching import Contact, Touching, load_touching, shipped_contacts


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
        assert np.allclose(displaced(twist, size), np.array(exact, float), atol=4e-15, rtol=0)


def test_a_carried_axis_turns_as_its_body_and_the_gap_of_a_small_motion_is_its_twist() -> None:
    for twist, way in np.random.default_rng(2).standard_normal((5, 2, 6)):
        move = displaced(way, 1.0)
        there = move @ matrix(twist) @ np.linalg.inv(move)
        assert np.allclose(matrix(carried(move, twist)), there, atol=1e-13)
        assert np.allclose(gap(displaced(twist, 1e-7)) / 1e-7, twist, atol=1e-6)


def test_a_force_through_an_axis_does_no_work_on_a_turn_about_it() -> None:
    turn = rotation((0.1, 0.2, 0.3), (0.0, 0.6, 0.8))
    assert screws.force((0.1, 0.2 + 0.6, 0.3 + 0.8), (1.0, 2.0, 3.0)) @ turn == pytest.approx(0.0)
    assert np.allclose(reciprocal(turn[:, None]) @ turn, 0.0)
    assert reciprocal(turn[:, None]).shape == (5, 6)


def test_freedoms_have_names_where_axes_of_the_frame_do_and_places_else() -> None:
    at = (0.1, 0.0, 0.0)
    pair = np.array([rotation(at, (0, 0, 1)) + translation((1, 0, 0)), translation((1, 0, 0))]).T
    assert names_of_freedoms(pair, at) == ["Qz", "Tx"]
    skew = rotation((0.5, 0.0, 0.0), (0.0, 0.0, 1.0))[:, None]
    assert names_of_freedoms(skew, at) == ["turn about (0, 0, 1) through (0.5, 0, 0) m"]
    assert axis_in_words(translation((0.0, 3.0, 4.0))) == "slide along (0, 0.6, 0.8)"
    thread = rotation((0.0, 0.2, 0.0), (1.0, 0.0, 0.0), 0.006 / (2 * np.pi))
    words = "screw about (1, 0, 0) through (0, 0.2, 0) m, 0.006 m in a turn"
    assert axis_in_words(thread) == words


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


def test_freedoms_have_their_place_where_they_are_not_about_the_joints_point() -> None:
    thread = contact("thread", (0.5, 0.2, 0.0), lead=0.01)
    joint = analyse_joint(Touching("", "", (0.0, 0.1, 0.0), (thread,)))
    (screw,) = joint.alone.freedoms
    assert screw == "screw about (0, 0, 1) through (0.5, 0.2, 0) m, 0.01 m in a turn"
    tube = contact("cylinder", (0.5, 0.2, 0.3), axis=(0.6, 0.8, 0.0))
    joint = analyse_joint(Touching("", "", tube.at, (tube,)))
    turn = "turn about (0.6, 0.8, 0) through (0.224, -0.168, 0.3) m"
    assert joint.alone.freedoms == (turn, "slide along (0.6, 0.8, 0)")


def test_points_make_the_class_of_the_surface_that_they_stand_for() -> None:
    def by(*contacts: Contact) -> int:
        joint = Touching("points", "", (0.0, 0.0, 0.0), contacts)
        return analyse_joint(joint).alone.constraints

    assert [by(*LEGS[:1]), by(*LEGS[:2]), by(*LEGS), by(contact("plane"))] == [1, 2, 3, 3]
    in_line = [contact("point", (x, 0.0, 0.0)) for x in (1e-3, 2e-3, 3e-3)]
    assert by(*in_line) == by(contact("line")) == 2
