"""Pins of a model beside what their bodies have: near misses, and pins that are far off."""

from collections.abc import Iterator, Mapping

import mujoco  # type: ignore[import-untyped]  # ships no stubs
import numpy as np

from models.array import Array
from sim.mujoco.own_model.component import Component
from sim.mujoco.own_model.driven_loop import WORLD, rigid
from sim.mujoco.own_model.file import SITE, body_name, name_of
from sim.mujoco.own_model.linkage import NEAR, Linkage, size

ROUNDED = 1e-5
"""Distance, over the size of the linkage, below which a difference is rounding of the file."""
BARS = (mujoco.mjtGeom.mjGEOM_CAPSULE.value, mujoco.mjtGeom.mjGEOM_CYLINDER.value)
BALL = mujoco.mjtGeom.mjGEOM_SPHERE.value


def misses(linkage: Linkage) -> Iterator[str]:
    """Yield the pins that are near to a mark of their body, and in none."""
    extent = size(linkage)
    for name, body, place, *_ in _pins(linkage.component):
        near = [(abs(mark - place), what) for what, mark in _marks(linkage.component, body)]
        distance, what = min(near, default=(0.0, ""))
        if ROUNDED * extent < distance < NEAR * extent:
            of = body_name(linkage.component.model, body)
            yield f"{name}: its pin is {distance:.3g} m off {what} on body {of}"


POS = "its pos counts in the frame of that body; give it there"
ANCHOR = (
    "the anchor counts in the frame of one body, and MuJoCo puts it on the other where that one "
    "has it in the pose as drawn; connect two sites, one on each body, or draw the loop shut"
)
Given = tuple[Array, int, int]
"""A pin in space (3,) [m], the body in whose frame the file gives it, and the other body."""


def _pins(component: Component) -> Iterator[tuple[str, int, complex, str, Given]]:
    """Yield name, rigid body and place of each copy of a pin, in the model as drawn, the cure for a
    wrong place, "" where it is that of the body or of a site, and how the file gives it."""
    model, plane = component.model, component.plane
    for body in component.bodies:
        for joint in body.joints:
            if joint.kind == "hinge":
                cure = POS if np.any(model.jnt_pos[joint.index]) else ""
                owner = int(model.jnt_bodyid[joint.index])
                given = component.data.xanchor[joint.index], owner, int(model.body_parentid[owner])
                yield f"joint {joint.name}", body.parent, joint.anchor, "", given
                yield f"joint {joint.name}", body.id, joint.anchor, cure, given
    for each in component.closures:
        cure = ANCHOR if int(model.eq_objtype[each.index]) != SITE else ""
        for end, anchor in zip(each.bodies, each.anchors, strict=True):
            if each.kind == "connect":
                given = each.anchors[0], *each.bodies
                yield f"loop {each.name}", component.rigid(end), plane.flat(anchor), cure, given


def _marks(component: Component, body: int) -> Iterator[tuple[str, complex]]:
    """Yield the sites, the ends of bars and the centres of balls on a moving rigid body."""
    model, data, plane = component.model, component.data, component.plane
    if body == WORLD:
        return
    for site in range(model.nsite):
        if rigid(model, int(model.site_bodyid[site])) == body:
            name = name_of(model, "site", site) or "without a name"
            yield f"site {name}", plane.flat(data.site_xpos[site])
    for geom in range(model.ngeom):
        if rigid(model, int(model.geom_bodyid[geom])) != body:
            continue
        name = name_of(model, "geom", geom)
        of = f"geom {name}" if name else "a geom"
        kind, middle = int(model.geom_type[geom]), plane.flat(data.geom_xpos[geom])
        if kind == BALL:
            yield f"the centre of {of}", middle
        elif kind in BARS:
            axis = np.array(data.geom_xmat[geom]).reshape(3, 3)[:, 2]
            half = plane.flat(axis) * float(model.geom_size[geom, 1])
            yield f"an end of {of}", middle + half
            yield f"an end of {of}", middle - half


FAR, BEYOND = 2.0, 0.3
"""Distance of a pin from all that is on its body, over the radius of the largest body, from which
on it can hardly be meant: of a body with nothing but balls or no geom, and of another. Public
models that are meant have up to 1.5 and 0.11."""
CORNERS = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1])).reshape(3, 8).T
SIDES = np.exp(1j * np.linspace(-np.pi, np.pi, 361))
"""Directions in which the reach of a body is taken."""
Places = dict[str, list[complex]]
"""Places on a body by the name of the element there."""


def far_pins(linkage: Linkage) -> Iterator[str]:
    """Yield the pins outside the geoms, sites and other joints of their body, with the cure."""
    component = linkage.component
    model = component.model
    on = {body.id: _places(component, body.id) for body in component.bodies}
    for name, body, place, cure, given in _pins(component):
        if body == WORLD or not cure:
            continue
        largest = max(_radius(each, name) for each in on.values())
        geoms = [rigid(model, int(owner)) == body for owner in model.geom_bodyid]
        # Balls mark places, and do not say how long a body is: other bodies do.
        balls = np.all(model.geom_type[geoms] == BALL)
        away = _away(on[body], name, place)
        if away > (FAR if balls else BEYOND) * largest > 0.0:
            yield (
                f"{name}: its pin is {away:.3g} m away from all else on body "
                f"{body_name(model, body)}, whose geoms and other joints reach "
                f"{_radius(on[body], name):.3g} m; {_mistaken(component, on, name, given)}{cure}"
            )


def _mistaken(component: Component, on: Mapping[int, Places], name: str, given: Given) -> str:
    """Return the frame in which the numbers of the file put a pin on both bodies; "" if none."""
    data, (pin, own, other) = component.data, given
    turns = data.xmat.reshape(-1, 3, 3)
    ends = [on[end] for end in {component.rigid(own), component.rigid(other)} & set(on)]
    for frame in (WORLD, other):
        there = data.xpos[frame] + turns[frame] @ turns[own].T @ (pin - data.xpos[own])
        place = component.plane.flat(there)
        if all(_away(end, name, place) <= ROUNDED * _radius(end, name) for end in ends):
            numbers = np.round(turns[own].T @ (there - data.xpos[own]), 9) + 0.0
            of = body_name(component.model, other) if frame else "the world"
            return (
                f"in the frame of {of} the same numbers lie on both bodies, and the file may give "
                f"it in that: it is {' '.join(f'{each:.5g}' for each in numbers)} in the frame of "
                f"{body_name(component.model, own)}; "
            )
    return ""


def _others(places: Places, without: str) -> Array:
    """Return the places of all other names (n,), as complex numbers."""
    return np.array([p for name, each in places.items() if name != without for p in each])


def _away(places: Places, without: str, place: complex) -> float:
    """Return the distance of a place from the hull of those of all other names, below 0 within."""
    along = (np.conj(SIDES)[:, None] * (place - _others(places, without))).real
    return float(along.min(axis=1).max())


def _radius(places: Places, without: str) -> float:
    """Return the largest distance of the places of all other names from their middle."""
    those = _others(places, without)
    x, y = those.real, those.imag
    return float(np.max(np.abs(those - complex(x.min() + x.max(), y.min() + y.max()) / 2)))


def _places(component: Component, body: int) -> Places:
    """Return the corners of the geoms of a rigid body, its marks and origins, its hinges, and the
    anchors that the file gives in its frame."""
    model, data, plane = component.model, component.data, component.plane
    found: Places = {"marks": [place for _, place in _marks(component, body)]}
    for part in range(1, model.nbody):
        if rigid(model, part) == body:
            found["marks"].append(plane.flat(data.xpos[part]))
    for geom in range(model.ngeom):
        if rigid(model, int(model.geom_bodyid[geom])) == body:
            corners = model.geom_aabb[geom, :3] + CORNERS * model.geom_aabb[geom, 3:]
            turned = corners @ data.geom_xmat[geom].reshape(3, 3).T
            found["marks"] += [plane.flat(data.geom_xpos[geom] + corner) for corner in turned]
    for other in component.bodies:
        for joint in other.joints:
            if joint.kind == "hinge" and body in (other.id, other.parent):
                found[f"joint {joint.name}"] = [joint.anchor]
    for each in component.closures:
        if each.kind == "connect" and component.rigid(each.bodies[0]) == body:
            found[f"loop {each.name}"] = [plane.flat(each.anchors[0])]
    return found
