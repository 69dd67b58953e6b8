"""What the theory of machines says of a mechanism as a whole, in lines to be read."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Iterator

from analytic.kinematics import reach
from analytic.mechanism.fourbar import FourBar
from analytic.mechanism.travel import Travel, travels
from analytic.structure.mobility import Structure
from models.errors import CrankcheckError, StructureError
from models.scene import Scene

FULL_TURN = math.tau - 1e-9


def facts(scene: Scene, structure: Structure) -> list[str]:
    """Grashof class and transmission angles of a four-bar; the driver's range where it cannot turn
    fully; swing or stroke and time ratio of every output between two limit positions."""
    lines = []
    if [group.kind for group in structure.groups] == ["RRR"]:
        with contextlib.suppress(StructureError):  # two links that stand still, or turn as one
            lines.append(_grashof(FourBar.of(scene)))
    spans = reach(scene)
    if sum(end - start for start, end in spans) < FULL_TURN:
        words = " and ".join(f"{_deg(a)} to {_deg(b)} deg" for a, b in spans)
        return [*lines, f"{scene.driver.link} can stand at {words}"]
    return lines + list(_travels(scene))


def _grashof(bar: FourBar) -> str:
    low, high = bar.transmission_rad
    rocks = bar.grashof_class == "crank-rocker" and bar.driver > bar.rocker
    driven = " driven at its rocker" if rocks else ""
    return (
        f"{bar.grashof_class}{driven} (s + l - p - q = {bar.excess_m:.6g} m), "
        f"transmission angle {_deg(low)} to {_deg(high)} deg"
    )


def _travels(scene: Scene) -> Iterator[str]:
    """One line per output that goes back and forth once in a turn of the driver."""
    try:
        every = travels(scene, (*scene.links, *scene.sliders))
    except CrankcheckError:
        return  # the mechanism passes a singular position
    for output, travel in every.items():
        if not isinstance(travel, Travel):
            continue  # it turns fully, stands still, or turns back more than twice
        size = f"{travel.stroke:.6g} m" if output in scene.sliders else f"{_deg(travel.stroke)} deg"
        word = "stroke" if output in scene.sliders else "swing"
        yield f"{output}: {word} {size}, time ratio {travel.time_ratio:.6g}"


def _deg(angle_rad: float) -> str:
    return f"{math.degrees(angle_rad):.6g}"
