"""Forces of pins of which a log has one component alone."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from models.motion import Forces
from reports.compare.beside import Truth


def whole_pins(logged: Forces, truth: Truth) -> Forces:
    """Forces with pins of which the log has one component: of these the other is right.
    Raises CrankcheckError where the scene has no reference."""
    lacks = {
        (point, body): np.all(np.isnan(force), axis=0)
        for point, bodies in logged.pins.items()
        for body, force in bodies.items()
    }
    halves = {key for key, lacking in lacks.items() if np.sum(lacking) == 1}
    right = truth.with_forces_at(logged.time_s).forces if halves else None
    if right is None or not right.pins:
        return logged
    pins = {
        point: {
            body: np.where(lacks[point, body], right.pins[point][body], force)
            if (point, body) in halves
            else force
            for body, force in bodies.items()
        }
        for point, bodies in logged.pins.items()
    }
    return replace(logged, pins=pins)
