"""Scenes that run into trouble as one of their numbers does: the shapes behind the hard cases.

All links are slender rods of 1 kg/m, all drivers turn at 10 rad/s unless said otherwise, or swing
at that circular frequency. Crank angles start off round numbers, so that no sample of a usual step
falls on a singular position.
"""

from __future__ import annotations

from models.files import parse_scene
from models.scene import Scene

START_DEG = 31.37
SPEED_RAD_S = 10.0
PLATFORM_GROUND = "A = [0.0, 0.0], D = [0.6, -0.05], G = [0.45, 0.6]"


def fourbar(
    name: str,
    crank_m: float,
    coupler_m: float,
    rocker_m: float,
    ground_m: float,
    *,
    source: str,
    start_deg: float = START_DEG,
    speed_rad_s: float = SPEED_RAD_S,
) -> Scene:
    """A four-bar A B C D with A at the origin and D on the x-axis, all lengths in m.

    C lies to the left of the line from B to D.
    """
    return _scene(
        name,
        source,
        f"A = [0.0, 0.0], D = [{ground_m!r}, 0.0]",
        _fourbar_links(crank_m, coupler_m, rocker_m),
        _turning(start_deg, speed_rad_s),
    )


def fourbar_by_coupler(
    name: str,
    crank_m: float,
    coupler_m: float,
    rocker_m: float,
    ground_m: float,
    *,
    source: str,
    centre_deg: float,
    amplitude_deg: float,
) -> Scene:
    """The four-bar of `fourbar`, driven at B: the angle from the crank to the coupler swings."""
    return _scene(
        name,
        source,
        f"A = [0.0, 0.0], D = [{ground_m!r}, 0.0]",
        _fourbar_links(crank_m, coupler_m, rocker_m),
        _swinging('pin = "B"\nlinks = ["crank", "coupler"]', "deg", centre_deg, amplitude_deg),
    )


def slider_crank(name: str, crank_m: float, rod_m: float, *, source: str) -> Scene:
    """A central slider-crank A B C along the x-axis, with a block of half a kilogram per metre of
    the crank."""
    return _scene(
        name,
        source,
        "A = [0.0, 0.0]",
        _slider_crank_bodies(crank_m, rod_m),
    )


def slider_crank_by_piston(
    name: str, crank_m: float, rod_m: float, *, source: str, amplitude_m: float
) -> Scene:
    """The slider-crank of `slider_crank`, whose block is driven to and fro about mid-stroke.

    B lies to the left of the line from A to C.
    """
    return _scene(
        name,
        source,
        "A = [0.0, 0.0]",
        _slider_crank_bodies(crank_m, rod_m),
        _swinging('slider = "C"', "m", rod_m, amplitude_m),
    )


def triad_platform(name: str, crank_m: float, *, source: str) -> Scene:
    """The plate C E F of the scene triad-platform on three legs, one of them on the crank A B."""
    return _scene(name, source, PLATFORM_GROUND, _platform_bodies(crank_m))


def swinging_triad_platform(
    name: str, crank_m: float, *, source: str, centre_deg: float, amplitude_deg: float
) -> Scene:
    """The plate of `triad_platform`, with a crank that swings."""
    driver = _swinging('link = "crank"', "deg", centre_deg, amplitude_deg)
    return _scene(name, source, PLATFORM_GROUND, _platform_bodies(crank_m), driver)


def slotted_lever(name: str, crank_m: float, pivots_m: float, *, source: str) -> Scene:
    """A crank A B whose block slides in a lever about C, below A by ``pivots_m``.

    The lever swings where the crank is shorter than the distance of the pivots, and turns fully
    (Whitworth) where it is longer.
    """
    return _scene(
        name,
        source,
        f"A = [0.0, {pivots_m!r}], C = [0.0, 0.0]",
        f"""
[links]
crank = {{ bar = ["A", "B"], length_m = {crank_m!r} }}
lever = {{ bar = ["C", "E"], length_m = {1.5 * (crank_m + pivots_m)!r} }}
[sliders.B]
on = "lever"
""",
    )


def double_parallelogram(name: str, *, source: str) -> Scene:
    """A parallelogram with a third rocker: by count it cannot move, and it does."""
    return _scene(
        name,
        source,
        "A = [0.0, 0.0], D = [0.3, 0.0], G = [0.6, 0.0]",
        """
[links]
crank = { bar = ["A", "B"], length_m = 0.1 }
coupler = { points = { B = [0.0, 0.0], C = [0.3, 0.0], F = [0.6, 0.0] }, mass_kg = 0.6 }
rocker = { bar = ["D", "C"], length_m = 0.1 }
third = { bar = ["G", "F"], length_m = 0.1 }
""",
    )


def _fourbar_links(crank_m: float, coupler_m: float, rocker_m: float) -> str:
    return f"""
[links]
crank = {{ bar = ["A", "B"], length_m = {crank_m!r} }}
coupler = {{ bar = ["B", "C"], length_m = {coupler_m!r} }}
rocker = {{ bar = ["D", "C"], length_m = {rocker_m!r} }}
"""


def _slider_crank_bodies(crank_m: float, rod_m: float) -> str:
    return f"""
[links]
crank = {{ bar = ["A", "B"], length_m = {crank_m!r} }}
rod = {{ bar = ["B", "C"], length_m = {rod_m!r} }}
[sliders.C]
on = "ground"
mass_kg = {0.5 * crank_m!r}
"""


def _platform_bodies(crank_m: float) -> str:
    return f"""
[links]
crank = {{ bar = ["A", "B"], length_m = {crank_m!r} }}
leg1 = {{ bar = ["B", "C"], length_m = 0.3 }}
leg2 = {{ bar = ["D", "E"], length_m = 0.3 }}
leg3 = {{ bar = ["G", "F"], length_m = 0.3 }}
plate = {{ points = {{ C = [0.0, 0.0], E = [0.25, -0.05], F = [0.12, 0.18] }} }}
"""


def _turning(start_deg: float = START_DEG, speed_rad_s: float = SPEED_RAD_S) -> str:
    """A crank that turns, in the words of a scene file."""
    return f"""
link = "crank"
speed_rad_s = {speed_rad_s!r}
start_deg = {start_deg!r}
"""


def _swinging(joint: str, unit: str, centre: float, amplitude: float) -> str:
    """A joint whose coordinate, an angle or a displacement, goes to and fro, from its centre on."""
    return f"""
{joint}
law = "oscillating"
centre_{unit} = {centre!r}
amplitude_{unit} = {amplitude!r}
frequency_rad_s = {SPEED_RAD_S!r}
"""


def _scene(name: str, source: str, ground: str, bodies: str, driver: str = _turning()) -> Scene:
    """The scene of a driver and of bodies in the words of a scene file."""
    return parse_scene(
        f"""
name = "{name}"
source = "{source}"
ground = {{ points = {{ {ground} }} }}
{bodies}
[driver]{driver}
""",
        name,
    )
