"""Classes of joints from contacts: the problem book's examples, the lower pairs, any frame."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from analytic.structure.joint_chains import chain_of
from analytic.structure.joint_class import analyse_joint
from analytic.structure.screws import rank
from models.scheme import SchemeJoint
from models.touching import Contact, Touching, load_touching, shipped_contacts


def contact(
    kind: str, at: tuple[float, float, float] = (0.0, 0.0, 0.0), **given: object
) -> Contact:
    """A contact of a kind, with its directions along the frame's where none are given."""
    named = {"normal": (0.0, 0.0, 1.0), "along": (1.0, 0.0, 0.0), "axis": (0.0, 0.0, 1.0)}
    return Contact(kind, at, **{**named, "lead": 0.0, "both_ways": False, **given})  # type: ignore[arg-type]


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


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        ("revolute", "revolute"),
        ("prismatic", "prismatic"),
        ("screw", "screw"),
        ("cylindrical", "cylindrical"),
        ("spherical", "spherical"),
        ("planar", "planar"),
        ("ball-in-tube", "ball-in-tube"),
    ],
)
def test_a_pair_leaves_by_its_contacts_what_it_leaves_in_a_scheme(name: str, kind: str) -> None:
    joint = analyse_joint(load_touching(name))
    axis = {"prismatic": (1.0, 0.0, 0.0), "ball-in-tube": (1.0, 0.0, 0.0)}.get(
        kind, (0.0, 0.0, 1.0)
    )
    chain = chain_of(SchemeJoint("A", kind, ("ground", "link"), axes=(axis,), lead=0.006))
    assert joint.alone.constraints == 6 - len(chain)
    assert joint.touching.is_lower_pair == (kind != "ball-in-tube")
    assert len(joint.alone.freedoms) == rank(np.array([each.twist for each in chain]))


@pytest.mark.parametrize("name", shipped_contacts())
def test_the_class_is_the_same_in_every_frame(name: str) -> None:
    touching = load_touching(name)
    turn = Rotation.random(rng=np.random.default_rng(4)).as_matrix()

    def moved(vector: tuple[float, float, float], by: float = 0.0) -> tuple[float, float, float]:
        x, y, z = turn @ vector + by
        return (float(x), float(y), float(z))

    contacts = tuple(
        replace(
            each,
            at=moved(each.at, 0.7),
            normal=moved(each.normal),
            along=moved(each.along),
            axis=moved(each.axis),
        )
        for each in touching.contacts
    )
    there = analyse_joint(
        replace(touching, at=moved(touching.at, 0.7), contacts=contacts, guides={})
    )
    here = analyse_joint(touching)
    assert there.alone.constraints == here.alone.constraints
    assert len(there.alone.freedoms) == 6 - there.alone.constraints
    assert there.kept == here.kept


def test_form_keeps_what_no_motion_opens_and_a_force_the_rest() -> None:
    down = contact("plane", (0.0, 0.0, 0.01))
    up = contact("plane", (0.0, 0.0, -0.01), normal=(0.0, 0.0, -1.0))
    either = {
        "lies on a plane": (down,),
        "between two planes": (down, up),
        "kept both ways": (replace(down, both_ways=True),),
        "in a round tube, on its end": (contact("circle", both_ways=True), down),
        "on three points": tuple(
            contact("point", (x, y, 0.0)) for x, y in ((1, 0), (0, 1), (-1, -1))
        ),
    }
    kept = {
        name: analyse_joint(Touching(name, "", (0.0, 0.0, 0.0), contacts)).kept
        for name, contacts in either.items()
    }
    assert [name for name, held in kept.items() if held] == ["between two planes", "kept both ways"]


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

    legs = [contact("point", (x, y, 0.0)) for x, y in ((1.0, 0.0), (0.0, 1.0), (-1.0, -1.0))]
    assert [by(*legs[:1]), by(*legs[:2]), by(*legs), by(contact("plane"))] == [1, 2, 3, 3]
    in_line = [contact("point", (x, 0.0, 0.0)) for x in (1e-3, 2e-3, 3e-3)]
    assert by(*in_line) == by(contact("line")) == 2
