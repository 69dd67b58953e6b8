"""Scenes with more in them, opened and run in an engine from their own start."""

from dataclasses import replace
from typing import Any

import numpy as np

from analytic.kinematics import solve
from models.files.reading import load_scene
from models.motion import State
from models.scene import Scene
from models.scene.laws import Law
from models.scene.loads import ConstantFriction, Friction, Load, Spring
from sim.engine import Engine, Run, Settings
from sim.engine.settings import resolved
from sim.registry import engine
from sim.run import run


def start_of(scene: Scene, time_s: float = 0.0) -> State:
    return solve(scene, np.array([time_s])).state(0)


def acted_on(scene: Scene, *acting: Load | Spring | Friction) -> Scene:
    """The scene with these loads, springs and friction in place of its own."""
    loads = {one.name: one for one in acting if isinstance(one, Load)}
    friction = {one.joint: one for one in acting if isinstance(one, Friction)}
    springs = {one.name: one for one in acting if isinstance(one, Spring)}
    return replace(scene, loads=loads, friction=friction, springs=springs)


def rubbing(scene: Scene, **sizes: float) -> Scene:
    """The scene with constant friction in these joints alone."""
    return acted_on(scene, *(ConstantFriction(*each) for each in sizes.items()))


def massless(scene: Scene) -> Scene:
    """The scene with blocks without mass."""
    blocks = {n: replace(s, mass_kg=0.0, inertia_kg_m2=0.0) for n, s in scene.sliders.items()}
    return replace(scene, sliders=blocks)


def driven_by(law: Law, scene: str = "fourbar-lecture-1") -> Scene:
    own = load_scene(scene)
    return replace(own, driver=replace(own.driver, law=law))


def tuned(name: str, settings: Settings | None = None) -> Settings:
    return resolved(engine(name).profiles["tuned"], settings)


def opened(
    scene: Scene,
    own: str | Engine,
    settings: Settings | None = None,
    *,
    profile: str = "tuned",
    drive: str = "prescribed",
    steps: int = 720,
    dt_s: float | None = None,
    start: State | None = None,
) -> Any:
    """A session of an engine, by its steps in a period or its step."""
    adapter = engine(own) if isinstance(own, str) else own
    held = resolved(adapter.profiles[profile], settings)
    dt_s = scene.driver.law.period_s / steps if dt_s is None else dt_s
    return adapter.open(scene, start or start_of(scene), held, dt_s, drive)


def ran(
    scene: Scene,
    own: str | Engine,
    profile: str = "tuned",
    *,
    per_turn: float = 720,
    turns: float = 1.0,
    start: State | None = None,
    well: bool = True,
    **given: Any,
) -> Run:
    """A run of a turn in 720 steps, unless told otherwise; it has to end ``well``."""
    given = {"dt_s": scene.driver.law.period_s / per_turn, "steps": round(turns * per_turn)} | given
    done = run(scene, start or start_of(scene), own, profile, **given)
    assert done.status == "ok" or not well, done.reason
    return done
