"""What is said of polygons, on a sheet and on the terminal: images of links, doubts, rest."""

from __future__ import annotations

import math

from analytic.lectures.drawings.drawn_polygons import DrawnPolygons
from analytic.lectures.drawings.polygon import Quantity
from analytic.lectures.drawings.similarity import similarity
from models.scene import GROUND
from reports.output.numbers import readable

RATES = {"velocity": "1/s", "acceleration": "1/s^2"}
REASONS = {"velocity": "as omega is 0", "acceleration": "as omega and alpha are 0"}


def image_words(drawn: DrawnPolygons, link: str, quantity: Quantity) -> str:
    """Whether the image of a link is similar to it, how large and how turned; or one point."""
    image = similarity(drawn, link, quantity)
    if image.is_point:
        return f"one point, {REASONS[quantity]}"
    turned = f"turned by {math.degrees(image.turn_rad):.4g} deg"
    return f"similar, {readable(image.scale)} {RATES[quantity]}, {turned}"


def at_rest(quantity: Quantity) -> str:
    """What is said of a polygon that is one point."""
    return f"at rest: every {quantity} is 0"


def doubts(drawn: DrawnPolygons) -> list[str]:
    """What could not be drawn, and what can hardly be drawn by hand."""
    lost = [f"not drawn: {told}" for told in drawn.undetermined]
    return lost + [f"flat: {told}" for told in drawn.flat]


def drawn_links(drawn: DrawnPolygons) -> list[str]:
    """The moving links that could be drawn."""
    return [name for name in drawn.rates if name != GROUND and name in drawn.placement.scene.links]
