"""The text of a scene's file, of a scene that has none."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from numbers import Integral

from models.driver_of_table import driver_table
from models.elastic import ElasticLink
from models.friction import ConstantFriction, Friction
from models.load_text import in_degrees, load_table
from models.scene import Scene, Slider
from models.springs import LineSpring, PinSpring, Spring
from models.start import Start

Table = Mapping[str, object]


def scene_text(scene: Scene, flywheels: Mapping[str, float] | None = None) -> str:
    """TOML that reads as the scene (`models.files.parse_scene`), but for the last digit of angles,
    which are in degrees there. ``flywheels`` [kg m^2] are put on links beside their own inertia.
    Raises CrankcheckError for a law of another kind."""
    lines = [
        f"{name} = {toml_value(value)}"
        for name, value in (
            ("name", scene.name),
            ("source", scene.source),
            ("note", scene.note),
            ("gravity_m_s2", scene.gravity_m_s2),
        )
    ]
    for head, table in _tables(scene, flywheels or {}):
        lines += [
            "",
            f"[{head}]",
            *(f"{key} = {toml_value(value)}" for key, value in table.items()),
        ]
    return "\n".join(lines) + "\n"


def _tables(scene: Scene, flywheels: Mapping[str, float]) -> Iterator[tuple[str, Table]]:
    """The tables of the file, in its order."""
    yield "ground", {"points": scene.ground}
    for name, link in scene.links.items():
        yield (
            f"links.{name}",
            {
                "points": link.points,
                "mass_kg": link.mass_kg,
                "centre_m": link.centre_m,
                "inertia_kg_m2": link.inertia_kg_m2,
                **({"flywheel_kg_m2": flywheels[name]} if name in flywheels else {}),
            },
        )
    for name, slider in scene.sliders.items():
        yield f"sliders.{name}", _slider(slider)
    yield "driver", driver_table(scene.driver)
    yield "branch", scene.branch
    yield "tolerance", scene.tolerance
    for name, load in scene.loads.items():
        yield f"loads.{name}", load_table(load)
    for name, spring in scene.springs.items():
        yield f"springs.{name}", _spring(spring)
    if scene.start:
        yield "start", _start(scene.start)
    for name, own in scene.elastic.items():
        yield f"elastic.{name}", _elastic(own)
    for joint, friction in scene.friction.items():
        yield f"friction.{joint}", _friction(friction, slides=joint in scene.sliders)


def _friction(friction: Friction, *, slides: bool) -> Table:
    if isinstance(friction, ConstantFriction):
        return {"force_n" if slides else "torque_n_m": friction.size}
    table = {"mu": friction.mu}
    return table if slides else {**table, "radius_m": friction.radius_m}


def _spring(spring: Spring) -> Table:
    if isinstance(spring, PinSpring):
        return {
            "pin": spring.point,
            "bodies": spring.bodies,
            "rate_n_m_rad": spring.rate,
            "damping_n_m_s": spring.damping,
            "free_deg": in_degrees(spring.free),
        }
    own = {"rate_n_m": spring.rate, "damping_n_s_m": spring.damping, "free_m": spring.free}
    if isinstance(spring, LineSpring):
        return {"points": spring.points, **own}
    return {"slider": spring.slider, **own}


def _start(start: Start) -> Table:
    angles = {link: in_degrees(angle) for link, angle in start.angles_rad.items()}
    return {
        "angles_deg": angles,
        "rates_rad_s": start.rates_rad_s,
        "displacements_m": start.displacements_m,
        "speeds_m_s": start.speeds_m_s,
        **({"shape": start.shape} if start.shape else {}),
    }


def _elastic(own: ElasticLink) -> Table:
    return {
        "bends": own.bends,
        "stretches": own.stretches,
        **({"flexural_n_m2": own.flexural_n_m2} if own.bends else {}),
        **({"axial_n": own.axial_n} if own.stretches else {}),
        "damping_s": own.damping_s,
        **({"height_m": own.height_m} if own.height_m is not None else {}),
    }


def _slider(slider: Slider) -> Table:
    table: dict[str, object] = {
        "point": slider.point,
        "on": slider.on,
        "through_m": slider.through_m,
        "direction_deg": in_degrees(slider.direction_rad),
    }
    if slider.link is not None:
        return {**table, "link": slider.link, "angle_deg": in_degrees(slider.angle_rad)}
    return {**table, "mass_kg": slider.mass_kg, "inertia_kg_m2": slider.inertia_kg_m2}


def toml_value(value: object) -> str:
    """A value in TOML."""
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, Mapping):
        return f"{{ {', '.join(f'{key} = {toml_value(each)}' for key, each in value.items())} }}"
    if isinstance(value, Sequence):
        return f"[{', '.join(map(toml_value, value))}]"
    return repr(int(value) if isinstance(value, Integral) else float(value))  # type: ignore[arg-type]
