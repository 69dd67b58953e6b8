"""Where letters and names stand in a drawing: beside what they name, and clear of the rest."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from models.array import Array

CLEAR = 0.05
"""More room than this to the nearest obstacle is no better [inch]."""
AWAY = (0.04, 0.08, 0.14, 0.22)
"""How far the edge of a label may be from what it names [inch]."""
AROUND = 24
NEAR_COST, LIGHT_COST, OUT_COST = 0.12, 0.1, 10.0
"""Costs of an inch away from what is named, of standing on a light line, of leaving the frame."""


@dataclass(frozen=True)
class Label:
    """A text of a size (width, height) [inch], to stand beside one of ``anchors`` (n, 2) [inch];
    ``radius`` is half the thickness of what it names."""

    text: str
    size: tuple[float, float]
    anchors: Array
    radius: float


def place(
    labels: Sequence[Label], heavy: Array, light: Array, frame: tuple[float, float]
) -> list[tuple[float, float]]:
    """The centre of each label [inch], in the order given; those first have the first choice.

    Parameters
    ----------
    heavy, light : Array
        Points that no label may cover, and those that it should not, shape (n, 3) and (m, 2); the
        third number is a radius [inch].
    frame : tuple
        Width and height of the drawing [inch]; all is measured from its lower left corner.
    """
    centres: list[tuple[float, float]] = []
    boxes: list[tuple[float, float, float, float]] = []
    for label in labels:
        tried = _candidates(label)
        costs = [_cost(label, centre, heavy, light, boxes, frame) for centre in tried]
        x, y = tried[int(np.argmin(costs))]
        centres.append((float(x), float(y)))
        boxes.append((float(x), float(y), *label.size))
    return centres


def _candidates(label: Label) -> Array:
    """Centres around each anchor, shape (k, 2), so that the edge is some way off it."""
    angle = np.linspace(0.0, math.tau, AROUND, endpoint=False) + math.pi / 4
    direction = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    half = np.array(label.size) / 2
    # from the centre of a box to its edge along a direction
    with np.errstate(divide="ignore"):
        edge = np.min(half / np.abs(direction), axis=1)
    rings = [direction * (label.radius + away + edge)[:, None] for away in AWAY]
    return np.concatenate([anchor + ring for ring in rings for anchor in label.anchors])


def _cost(
    label: Label,
    centre: Array,
    heavy: Array,
    light: Array,
    boxes: Sequence[tuple[float, float, float, float]],
    frame: tuple[float, float],
) -> float:
    """What speaks against a place."""
    half = np.array(label.size) / 2
    room = float(np.min(_distance(heavy[:, :2], centre, half) - heavy[:, 2], initial=CLEAR))
    for x, y, width, height in boxes:
        gap = np.abs(centre - (x, y)) - half - np.array([width, height]) / 2
        room = min(room, float(gap.max()) if gap.max() < 0 else float(np.hypot(*gap.clip(0.0))))
    crossed = float(np.min(_distance(light, centre, half), initial=1.0)) < 0.01
    middle = np.array(frame) / 2
    out = float(np.maximum(np.abs(centre - middle) + half - middle, 0.0).sum())
    off = float(np.linalg.norm(label.anchors - centre, axis=1).min())
    hidden = 4.0 * max(-room, 0.0)
    return CLEAR - room + hidden + NEAR_COST * off + LIGHT_COST * crossed + OUT_COST * out


def _distance(points: Array, centre: Array, half: Array) -> Array:
    """From points to a box, shape (n,); below 0 inside of it."""
    away = np.abs(points - centre) - half
    return np.asarray(np.hypot(*away.clip(0.0).T) + np.minimum(away.max(axis=1), 0.0))
