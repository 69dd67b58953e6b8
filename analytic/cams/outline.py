"""Outlines of the cams of a scene: points of their profiles, for engines that hold them by contact.

The points are those that the follower touches at equal steps of the cam's angle, so that facets
between them cut off a sagitta: over a radius r of the profile, (2 pi / N)^2 / 8 of it.
"""

from dataclasses import replace

import numpy as np

from analytic.cams.cam_design import refuse_undercut
from analytic.cams.profile import CamContact, Plane, touch
from models.errors import CrankcheckError
from models.scene import Scene
from models.scene.pairs import CamPair


def outlined(scene: Scene, facets: int | None = None) -> Scene:
    """Return the scene with the outlines of its cams by contact, of so many ``facets``: None leaves
    each its own number. Raises CrankcheckError for a profile that undercuts."""
    cams = {name: _outlined(scene, pair, facets) for name, pair in scene.cams.items()}
    return scene if cams == scene.cams else replace(scene, cams=cams)


def _outlined(scene: Scene, pair: CamPair, facets: int | None) -> CamPair:
    count = pair.facets if facets is None else facets
    if not count or pair.profile.follower.contact == "knife":
        return replace(pair, facets=count)  # a knife edge has none: its engines say so
    try:
        refuse_undercut(pair.profile)
    except CrankcheckError as error:
        raise CrankcheckError(f"{scene.name}: cams.{pair.name} by contact: {error}") from None
    _, points = touched(scene, pair, count)
    corners = tuple((float(point.real), float(point.imag)) for point in points)
    return replace(pair, facets=count, outline=corners)


def touched(scene: Scene, pair: CamPair, count: int) -> tuple[CamContact, Plane]:
    """Return the contact at ``count`` equal steps of a turn, and its points in the frame of the
    cam's link, complex (count,) [m]. Raises CrankcheckError as `touch`."""
    contact = touch(pair.profile, np.linspace(0.0, 2.0 * np.pi, count, endpoint=False))
    points = contact.on_cam(contact.contact)
    own = scene.points_of
    centre, pivot = pair.pivots(own)
    if pair.slider:
        angle = scene.sliders[pair.slider].direction_rad - 0.5 * np.pi
    else:
        (ox, oy), (px, py) = own[pair.carrier][centre], own[pair.carrier][pivot]
        angle = np.arctan2(py - oy, px - ox)
        points = points if pair.side > 0 else points.conj()
    x, y = own[pair.cam][centre]
    return contact, complex(x, y) + points * np.exp(1j * (angle - pair.start_rad))
