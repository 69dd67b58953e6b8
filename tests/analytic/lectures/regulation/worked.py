"""Machines whose cycles are worked out by hand."""

from collections.abc import Mapping
from dataclasses import replace

from models.files.reading import load_scene, parse_scene
from models.scene import Driver, Scene
from models.scene.characteristics import Characteristic, Constant
from models.scene.driver import Released
from models.scene.laws import ConstantSpeed
from models.scene.loads import Load, Over

SHAFT = """
name = "shaft"
source = "a test: a shaft with a crank of no mass behind it"
ground = { points = { A = [0.0, 0.0] } }
sliders = { C = { on = "ground", mass_kg = 0.0 } }
driver = { link = "crank", speed_rad_s = 10.0 }
[links]
rod = { bar = ["B", "C"], length_m = 0.3, mass_kg = 0.0 }
[links.crank]
points = { A = [0.0, 0.0], B = [0.1, 0.0] }
mass_kg = 1.0
centre_m = [0.0, 0.0]
inertia_kg_m2 = 2.0
"""


def shaft(
    loads: Mapping[str, tuple[Characteristic, Over]],
    *,
    speed: float = 10.0,
    free: bool = False,
    inertia: float = 2.0,
) -> Scene:
    """A shaft of a constant moment of inertia under torques on it."""
    scene = parse_scene(SHAFT, "shaft")
    links = {**scene.links, "crank": replace(scene.links["crank"], inertia_kg_m2=inertia)}
    driver = Driver("crank", Released(0.0, speed, 1.0) if free else ConstantSpeed(0.0, speed))
    torques = {n: Load(n, "crank", None, own, over) for n, (own, over) in loads.items()}
    return replace(scene, links=links, driver=driver, loads=torques)


def yoke(force_n: float = 0.0, *, mass_kg: float = 3.0, radius_m: float = 0.2) -> Scene:
    """A Scotch yoke of a mass on a crank of 0.5 kg m^2, at 8 rad/s: J = 0.5 + m (r sin u)^2; a
    constant force along its way does no work in a cycle: W = F r (cos u - 1)."""
    scene = load_scene("scotch-yoke")
    crank = replace(
        scene.links["crank"], points={"A": (0.0, 0.0), "B": (radius_m, 0.0)},
        mass_kg=1.0, centre_m=(0.0, 0.0), inertia_kg_m2=0.5,
    )  # fmt: skip
    own = replace(scene.links["yoke"], mass_kg=mass_kg, inertia_kg_m2=1.0)
    sliders = {n: replace(s, mass_kg=0.0, inertia_kg_m2=0.0) for n, s in scene.sliders.items()}
    loads = {}
    if force_n:
        loads["push"] = Load("push", "yoke", next(iter(own.points)), Constant(force_n))
    return replace(
        scene, links={"crank": crank, "yoke": own}, sliders=sliders, loads=loads,
        driver=Driver("crank", ConstantSpeed(0.0, 8.0)), gravity_m_s2=(0.0, 0.0),
    )  # fmt: skip
