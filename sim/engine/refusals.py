"""Refusals of scenes that more than one engine cannot hold."""

from models.errors import EngineError
from models.scene import Scene


def refuse_driver_angle(scene: Scene, engine: str) -> None:
    """Refuse loads over the angle of a driver that is no crank. Raises EngineError."""
    driver = scene.driver
    if not driver.is_crank and any(load.over == "angle" for load in scene.loads.values()):
        raise EngineError(
            f"{scene.name}: a load goes with the driver's angle, and {engine} is given that of a "
            f"crank alone; this driver is {driver.joint}"
        )


def refuse_massless(
    engine: str, name: str, mass_kg: float, inertia_kg_m2: float, *, turns: bool
) -> None:
    """Refuse a body that a force would move at no cost. Raises EngineError."""
    if mass_kg <= 0.0 or (inertia_kg_m2 <= 0.0 and turns):
        raise EngineError(
            f"{name}: mass_kg {mass_kg:g}, inertia_kg_m2 {inertia_kg_m2:g}; {engine} moves no body "
            "without both, give them"
        )
