"""Pins of a model beside what their bodies have: near misses, and pins that are far off."""

import math
from collections.abc import Iterator

import mujoco  # type: ignore[import-untyped]  # ships no stubs
import numpy as np

from sim.mujoco.own_model.component import Component, RigidBody
from sim.mujoco.own_model.driven_loop import WORLD, rigid
from sim.mujoco.own_model.file import KINDS, SITE, body_name, name_of
from sim.mujoco.own_model.linkage import NEAR, Linkage, size

ROUNDED = 1e-5
"""Distance, over the size of the linkage, below which a difference is rounding of the file."""
BARS = (mujoco.mjtGeom.mjGEOM_CAPSULE.value, mujoco.mjtGeom.mjGEOM_CYLINDER.value)
BALL = mujoco.mjtGeom.mjGEOM_SPHERE.value


def misses(linkage: Linkage) -> Iterator[str]:
    """Yield the pins that are near to a mark of their body, and in none."""
    extent = size(linkage)
    for name, body, place in _pins(linkage.component):
        near = [(abs(mark - place), what) for what, mark in _marks(linkage.component, body)]
        distance, what = min(near, default=(0.0, ""))
        if ROUNDED * extent < distance < NEAR * extent:
            of = body_name(linkage.component.model, body)
            yield f"{name}: its pin is {distance:.3g} m off {what} on body {of}"


def _pins(component: Component) -> Iterator[tuple[str, int, complex]]:
    """Yield name, rigid body and place of each copy of a pin, in the model as drawn."""
    for body in component.bodies:
        for joint in body.joints:
            if joint.kind == "hinge":
                yield from (
                    (f"joint {joint.name}", b, joint.anchor) for b in (body.parent, body.id)
                )
    for each in component.closures:
        for end, anchor in zip(each.bodies, each.anchors, strict=True):
            if each.kind == "connect":
                yield f"loop {each.name}", component.rigid(end), component.plane.flat(anchor)


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
ANCHOR = "its anchor counts in the frame of that body; give it there, or connect two sites"
DRAWN = (
    "MuJoCo puts it where the other body has it in the pose as drawn; connect two sites, one on "
    "each body, or draw the loop shut"
)
POS = "its pos counts in the frame of that body; give it there"
Places = dict[str, list[complex]]
"""Places on a body by the thing that they belong to."""


def far_pins(linkage: Linkage) -> Iterator[str]:
    """Yield the pins far outside the geoms, sites and other joints of their body, with the cure."""
    component = linkage.component
    model, plane = component.model, component.plane
    on = {body.id: _places(component, body) for body in component.bodies}
    for body in component.bodies:
        for joint in body.joints:
            # The place of a hinge without a pos is the origin of its body.
            if joint.kind == "hinge" and np.any(model.jnt_pos[joint.index]):
                origin = [plane.flat(component.data.xpos[body.id])]
                own = on | {body.id: on[body.id] | {"origin": origin}}
                name = f"joint {joint.name}"
                yield from _far(component, own, name, body.id, joint.anchor, POS)
    for each in component.closures:
        if each.kind == "weld" or int(model.eq_objtype[each.index]) == SITE:
            continue
        typed = 0 if KINDS[int(model.eq_type[each.index])] == "connect" else 1
        for at, (end, anchor) in enumerate(zip(each.bodies, each.anchors, strict=True)):
            cure, name = ANCHOR if at == typed else DRAWN, f"loop {each.name}"
            yield from _far(component, on, name, component.rigid(end), plane.flat(anchor), cure)


def _far(
    component: Component, on: dict[int, Places], name: str, body: int, place: complex, cure: str
) -> Iterator[str]:
    """Yield the pin of that name on a rigid body, if it is far off."""
    others = [p for what, places in on.get(body, {}).items() if what != name for p in places]
    if not others:
        return
    middle, reach = _circle(others)
    model = component.model
    kinds = {
        int(kind)
        for kind, owner in zip(model.geom_type, model.geom_bodyid, strict=True)
        if rigid(model, int(owner)) == body
    }
    if kinds <= {BALL}:
        # Balls mark places, and do not say how long a body is: other bodies do.
        beside = ([p for places in on[b].values() for p in places] for b in on if b != body)
        reach = max([reach, *(_circle(places)[1] for places in beside if places)])
    if abs(place - middle) > FAR * reach > 0.0:
        yield (
            f"{name}: its pin is {abs(place - middle):.3g} m off the middle of body "
            f"{body_name(model, body)}, whose geoms and other joints reach {reach:.3g} m; "
            f"{cure}"
        )


def _circle(places: list[complex]) -> tuple[complex, float]:
    """Return the middle of places, and their largest distance from it."""
    x, y = [p.real for p in places], [p.imag for p in places]
    middle = complex(min(x) + max(x), min(y) + max(y)) / 2
    return middle, max(abs(p - middle) for p in places)


def _places(component: Component, body: RigidBody) -> Places:
    """Return the places on a rigid body: corners of its geoms, marks, hinges, anchors that the file
    gives, and ends of a bar of its inertia."""
    model, data, plane = component.model, component.data, component.plane
    found: Places = {what: [] for what in ("geoms", "marks", "inertia")}
    for geom in range(model.ngeom):
        if rigid(model, int(model.geom_bodyid[geom])) == body.id:
            box = model.geom_aabb[geom]
            corners = box[:3] + CORNERS * box[3:]
            turned = data.geom_xpos[geom] + corners @ data.geom_xmat[geom].reshape(3, 3).T
            found["geoms"] += [plane.flat(corner) for corner in turned]
    found["marks"] += [place for _, place in _marks(component, body.id)]
    for part in range(1, model.nbody):
        if rigid(model, part) != body.id:
            continue
        if part != body.id:
            found["marks"].append(plane.flat(data.xpos[part]))
        if (mass := float(model.body_mass[part])) > 0.0:
            axes = data.ximat[part].reshape(3, 3).T @ plane.normal
            half = math.sqrt(3.0 * float(axes @ (model.body_inertia[part] * axes)) / mass)
            centre = plane.flat(data.xipos[part])
            found["inertia"] += [centre + half * way for way in (1, -1, 1j, -1j)]
    for other in component.bodies:
        for joint in other.joints:
            if joint.kind == "hinge" and body.id in (other.id, other.parent):
                found[f"joint {joint.name}"] = [joint.anchor]
    for each in component.closures:
        typed = 0 if KINDS[int(model.eq_type[each.index])] == "connect" else 1
        if each.kind == "connect" and component.rigid(each.bodies[typed]) == body.id:
            found[f"loop {each.name}"] = [plane.flat(each.anchors[typed])]
    return found
