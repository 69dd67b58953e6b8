"""What names of columns say of forces: of which pin, slider or driver they are, in which unit.

``C_rod_fx_n`` is the force of pin C on the rod, along x of the ground; ``C_fx_n`` will do where two
bodies meet, and is that on the second of them. ``C_slider_normal_n`` and ``C_slider_moment_n_m``
are what the guide exerts, ``torque_n_m`` is the drive's on the driver. Dots and spaces stand for
underscores, and the unit may be in brackets. ``force_time_s`` are the instants that forces act at,
where they are others than those of the rows.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Literal

from models.joints import joined_at
from models.scene import Scene

POUND, INCH = 4.4482216152605, 0.0254
UNITS: Mapping[str, Mapping[str, float]] = {
    "force": {"n": 1.0, "kn": 1e3, "mn": 1e-3, "lbf": POUND},
    "moment": {
        "n_m": 1.0,
        "nm": 1.0,
        "n_mm": 1e-3,
        "nmm": 1e-3,
        "kn_m": 1e3,
        "knm": 1e3,
        "lbf_in": POUND * INCH,
        "lbf_ft": POUND * 12 * INCH,
    },
}
"""What one is in SI, by how it is spelled in small letters; mN is a millinewton."""
TIMES = "force_time_s"
Place = tuple[Literal["torque", "pin", "normal", "moment"], str, str, int]
"""What a column is of: kind, point or slider, body, and axis."""


def names_force(column: str, scene: Scene) -> bool:
    """Whether a column is one of forces."""
    return column == TIMES or force_meaning(column, force_places(scene)) is not None


def shown_names(scene: Scene) -> list[str]:
    """What columns of forces are best called, one name for each: of two bodies at a pin the
    second's."""
    names: dict[Place, str] = {}
    for name, place in force_places(scene).items():
        kind, of, body, _ = place
        if kind == "pin" and len(bodies := joined_at(scene)[of]) == 2 and body != bodies[1]:
            continue
        names.setdefault(place, f"{name}_{'n' if kind in ('pin', 'normal') else 'n_m'}")
    return list(names.values())


def force_places(scene: Scene) -> dict[str, Place]:
    """What columns may be called, without their units."""
    driver = scene.driver.link
    torque: Place = ("torque", driver, "", 0)
    found = dict.fromkeys(("torque", f"{driver}_torque", "drive_torque"), torque)
    for point, bodies in joined_at(scene).items():
        for axis, letter in enumerate("xy"):
            for body in bodies:
                place: Place = ("pin", point, body, axis)
                name = body.replace(" ", "_")
                found[f"{point}_{name}_f{letter}"] = place
                found[f"{point}_on_{name}_f{letter}"] = place
            if len(bodies) == 2:
                found[f"{point}_f{letter}"] = ("pin", point, bodies[1], axis)
    for name in scene.sliders:
        for kind in ("normal", "moment"):
            of: Place = ("normal" if kind == "normal" else "moment", name, "", 0)
            found[f"{name}_slider_{kind}"] = of
            found[f"{name}_{kind}"] = of
    return found


def force_meaning(column: str, places: Mapping[str, Place]) -> tuple[Place, float] | None:
    """What a column is of, and what one of its numbers is in SI; None for none."""
    bare = re.sub(r"\s*[\[(]([^\[\]()]*)[\])]\s*$", r"_\1", column)
    words = re.sub(r"[\s._·*]+", "_", bare.strip()).strip("_")
    for kind, units in UNITS.items():
        for unit, factor in (*units.items(), ("", 1.0)):
            end = f"_{unit}" if unit else ""
            if not words.lower().endswith(end):
                continue
            place = places.get(words[: len(words) - len(end)])
            if place and (place[0] in ("torque", "moment")) == (kind == "moment"):
                return place, factor
    return None
