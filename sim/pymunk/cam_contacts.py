"""Cams of a space by contact: segments on the cam, a circle or a polygon on the follower."""

from itertools import pairwise

import pymunk

from models.scene import Point
from models.scene.cam_contacts import FollowerShape, follower_shape
from models.scene.pairs import CamPair
from sim.pymunk.native import SpaceBodies

CELL, CELLS = 0.1, 20_000
"""Size of the cells of the space for shapes, over the base radius, and their number."""


def add_contact(placed: SpaceBodies, pair: CamPair, number: int) -> None:
    """Add the shapes of cam and follower, which touch each other alone: ``number`` is that of the
    pair among the cams of the scene. Raises EngineError as `follower_shape`."""
    shape = follower_shape(placed.scene, pair)
    cam, follower = placed.body(pair.cam), placed.body(pair.follower)
    corners = [placed.from_centre(pair.cam, point) for point in pair.outline]
    ring = [corners[-1], *corners, *corners[:2]]
    if not placed.space.shapes:
        # A tree of so many boxes is made again at each step, as the cam turns.
        placed.space.use_spatial_hash(CELL * pair.profile.base_m, CELLS)
    shapes: list[pymunk.Shape] = []
    for k, (here, there) in enumerate(pairwise(ring[1:-1])):
        facet = pymunk.Segment(cam, here, there, shape.skin_m)
        facet.set_neighbors(ring[k], ring[k + 3])
        shapes.append(facet)
    if pair.profile.follower.is_flat:
        face = [placed.from_centre(pair.follower, corner) for corner in _face(shape)]
        shapes.append(pymunk.Poly(follower, face))
    else:
        place = placed.from_centre(pair.follower, shape.place)
        shapes.append(pymunk.Circle(follower, shape.roller_m - shape.skin_m, place))
    for each in shapes:
        each.filter = pymunk.ShapeFilter(categories=1 << number, mask=1 << number)
        each.friction = each.elasticity = 0.0
        placed.space.add(each)


def _face(shape: FollowerShape) -> list[Point]:
    """Return the corners of a flat follower."""
    (x, y), (ux, uy), reach = shape.place, shape.away, shape.reach_m
    low, high = shape.skin_m, shape.skin_m + reach
    corners = (low, reach), (low, -reach), (high, -reach), (high, reach)
    return [(x + off * ux - side * uy, y + off * uy + side * ux) for off, side in corners]
