"""The forces that an engine of a user's own gives: are they all there, and of the right kind?"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from models.errors import few, shown
from models.joints import joined_at
from models.motion import Forces, SliderForces
from models.scene import Scene


def wrong_forces(scene: Scene, forces: object, size: int) -> str:
    """What is wrong with forces of so many samples; nothing of whether they are true."""
    if not isinstance(forces, Forces):
        return f"gave {shown(forces)} for forces, and has to give Forces"
    pins = joined_at(scene)
    for what, given, wanted in (
        ("pins", forces.pins, pins),
        ("sliders", forces.sliders, scene.sliders),
    ):
        if not isinstance(given, Mapping) or list(given) != list(wanted):
            named = few(list(wanted), 12) or "none"
            return f"gave {shown(list(given))} for {what}, and the scene has {named}, in this order"
    for point, by_body in forces.pins.items():
        if not isinstance(by_body, Mapping) or tuple(by_body) != pins[point]:
            names = ", ".join(pins[point])
            return (
                f"gave for pin {point} {shown(by_body)}, and its bodies are {names}, in this order"
            )
    return next(_wrong_arrays(forces, size), "")


def _wrong_arrays(forces: Forces, size: int) -> Iterator[str]:
    """Series that are no float64 of their shape."""
    for point, by_body in forces.pins.items():
        for body, force in by_body.items():
            yield from _wrong(f"the force of pin {point} on {body}", force, (size, 2))
    for name, slider in forces.sliders.items():
        if not isinstance(slider, SliderForces):
            yield f"gave for slider {name} {shown(slider)}, and has to give SliderForces"
            return
        yield from _wrong(f"the normal force of slider {name}", slider.normal, (size,))
        yield from _wrong(f"the moment of slider {name}", slider.moment, (size,))
    yield from _wrong("torque", forces.torque, (size,))
    yield from _wrong("the time_s of forces", forces.time_s, (size,))


def _wrong(what: str, values: object, shape: tuple[int, ...]) -> Iterator[str]:
    """What of an array is not as it has to be."""
    found = shown(values)
    if isinstance(values, np.ndarray):
        if values.shape == shape and values.dtype == np.float64:
            return
        found = f"{values.dtype} of shape {values.shape}"
    yield f"gave {what} as {found}, and has to give float64 of shape {shape}"
