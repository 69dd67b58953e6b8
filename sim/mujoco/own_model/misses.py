"""Pins that miss by a little what they may have been meant for: a site, or the end of a geom."""

from __future__ import annotations

from collections.abc import Iterator

import mujoco  # type: ignore[import-untyped]  # ships no stubs
import numpy as np

from sim.mujoco.own_model.closures import body_name, name_of
from sim.mujoco.own_model.component import WORLD, Component, rigid
from sim.mujoco.own_model.linkage import Linkage
from sim.mujoco.own_model.points import NEAR, size

ROUNDED = 1e-5
"""A distance below this, over the size of the linkage, is rounding of what a file says."""
BARS = (mujoco.mjtGeom.mjGEOM_CAPSULE.value, mujoco.mjtGeom.mjGEOM_CYLINDER.value)
BALL = mujoco.mjtGeom.mjGEOM_SPHERE.value


def misses(linkage: Linkage) -> Iterator[str]:
    """The pins that are near to a mark of their body, and in none."""
    extent = size(linkage)
    for name, body, place in _pins(linkage.component):
        near = [(abs(mark - place), what) for what, mark in _marks(linkage.component, body)]
        distance, what = min(near, default=(0.0, ""))
        if ROUNDED * extent < distance < NEAR * extent:
            of = body_name(linkage.component.model, body)
            yield f"{name}: its pin is {distance:.3g} m off {what} on body {of}"


def _pins(component: Component) -> Iterator[tuple[str, int, complex]]:
    """Name, rigid body and place of each copy of a pin, as the model is drawn."""
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
    """The sites, the ends of bars and the centres of balls on a rigid body that moves."""
    model, data, plane = component.model, component.data, component.plane
    if body == WORLD:
        return
    for site in range(model.nsite):
        if rigid(model, int(model.site_bodyid[site])) == body:
            name = name_of(model, mujoco.mjtObj.mjOBJ_SITE, site) or "without a name"
            yield f"site {name}", plane.flat(data.site_xpos[site])
    for geom in range(model.ngeom):
        if rigid(model, int(model.geom_bodyid[geom])) != body:
            continue
        name = name_of(model, mujoco.mjtObj.mjOBJ_GEOM, geom)
        of = f"geom {name}" if name else "a geom"
        kind, middle = int(model.geom_type[geom]), plane.flat(data.geom_xpos[geom])
        if kind == BALL:
            yield f"the centre of {of}", middle
        elif kind in BARS:
            axis = np.array(data.geom_xmat[geom]).reshape(3, 3)[:, 2]
            half = plane.flat(axis) * float(model.geom_size[geom, 1])
            yield f"an end of {of}", middle + half
            yield f"an end of {of}", middle - half
