"""Pins of a model beside what their bodies have: near misses, and pins that are far off."""

from collections.abc import Iterator

import mujoco  # type: ignore[import-untyped]  # ships no stubs
import numpy as np

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
    for name, body, place, _ in _pins(linkage.component):
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


def _pins(component: Component) -> Iterator[tuple[str, int, complex, str]]:
    """Yield name, rigid body and place of each copy of a pin, in the model as drawn, and the cure
    for a wrong place, "" where it is that of the body or of a site."""
    model, plane = component.model, component.plane
    for body in component.bodies:
        for joint in body.joints:
            if joint.kind == "hinge":
                cure = POS if np.any(model.jnt_pos[joint.index]) else ""
                yield f"joint {joint.name}", body.parent, joint.anchor, ""
                yield f"joint {joint.name}", body.id, joint.anchor, cure
    for each in component.closures:
        cure = ANCHOR if int(model.eq_objtype[each.index]) != SITE else ""
        for end, anchor in zip(each.bodies, each.anchors, strict=True):
            if each.kind == "connect":
                yield f"loop {each.name}", component.rigid(end), plane.flat(anchor), cure


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


FAR = 3.0
"""Distance of a pin from the middle of its body, over the radius of all that is on the body, from
which on it can hardly be meant."""
CORNERS = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1])).reshape(3, 8).T
Places = dict[str, list[complex]]
"""Places on a body by the name of what stands there."""


def far_pins(linkage: Linkage) -> Iterator[str]:
    """Yield the pins far outside the geoms, sites and other joints of their body, with the cure."""
    component = linkage.component
    model = component.model
    on = {body.id: _places(component, body.id) for body in component.bodies}
    for name, body, place, cure in _pins(component):
        if body == WORLD or not cure:
            continue
        middle, reach = _circle(on[body], name)
        geoms = [rigid(model, int(owner)) == body for owner in model.geom_bodyid]
        if np.all(model.geom_type[geoms] == BALL):
            # Balls mark places, and do not say how long a body is: other bodies do.
            reach = max([reach, *(_circle(on[other], name)[1] for other in on if other != body)])
        if abs(place - middle) > FAR * reach > 0.0:
            yield (
                f"{name}: its pin is {abs(place - middle):.3g} m off the middle of body "
                f"{body_name(model, body)}, whose geoms and other joints reach {reach:.3g} m; "
                f"{cure}"
            )


def _circle(places: Places, without: str) -> tuple[complex, float]:
    """Return the middle of the places of all other names, and their largest distance from it."""
    those = [place for name, each in places.items() if name != without for place in each]
    x, y = [place.real for place in those], [place.imag for place in those]
    middle = complex(min(x) + max(x), min(y) + max(y)) / 2
    return middle, max(abs(place - middle) for place in those)


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
