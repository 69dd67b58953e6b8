"""Where letters and names stand in a drawing: beside what they name, and clear of the rest."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
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
        rings = list(_rings(label))
        costs = [_costs(label, ring, heavy, light, boxes, frame) for ring in rings]
        x, y = np.concatenate(rings)[int(np.argmin(np.concatenate(costs)))]
        centres.append((float(x), float(y)))
        boxes.append((float(x), float(y), *label.size))
    return centres


def _rings(label: Label) -> Iterator[Array]:
    """Centres around each anchor, shape (k, 2), so that the edge is some way off it."""
    angle = np.linspace(0.0, math.tau, AROUND, endpoint=False) + math.pi / 4
    direction = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    half = np.array(label.size) / 2
    # from the centre of a box to its edge along a direction
    with np.errstate(divide="ignore"):
        edge = np.min(half / np.abs(direction), axis=1)
    for away in AWAY:
        ring = direction * (label.radius + away + edge)[:, None]
        yield (label.anchors[:, None, :] + ring).reshape(-1, 2)


def _costs(
    label: Label,
    centres: Array,
    heavy: Array,
    light: Array,
    boxes: Sequence[tuple[float, float, float, float]],
    frame: tuple[float, float],
) -> Array:
    """What speaks against each place (k, 2), shape (k,)."""
    half = np.array(label.size) / 2
    room = np.min(_distance(heavy[:, :2], centres, half) - heavy[:, 2], axis=1, initial=CLEAR)
    for x, y, width, height in boxes:
        gap = np.abs(centres - (x, y)) - half - np.array([width, height]) / 2
        most = gap.max(axis=1)
        room = np.minimum(room, np.where(most < 0, most, np.hypot(*gap.clip(0.0).T)))
    crossed = np.min(_distance(light, centres, half), axis=1, initial=1.0) < 0.01
    middle = np.array(frame) / 2
    out = np.maximum(np.abs(centres - middle) + half - middle, 0.0).sum(axis=1)
    off = np.linalg.norm(label.anchors[:, None] - centres, axis=2).min(axis=0)
    hidden = 4.0 * np.maximum(-room, 0.0)
    costs = CLEAR - room + hidden + NEAR_COST * off + LIGHT_COST * crossed + OUT_COST * out
    return np.asarray(costs)


def _distance(points: Array, centres: Array, half: Array) -> Array:
    """From points (n, 2) to boxes around centres (k, 2), shape (k, n); below 0 inside of one."""
    away = np.abs(points - centres[:, None]) - half
    across, along = away[..., 0], away[..., 1]
    outside = np.hypot(np.maximum(across, 0.0), np.maximum(along, 0.0))
    return np.asarray(outside + np.minimum(np.maximum(across, along), 0.0))
