"""Scenes that become singular as one of their numbers changes: the shapes behind the hard cases.

All links are slender rods of 1 kg/m, all drivers turn at 10 rad/s unless said otherwise, or swing
at that circular frequency. Crank angles do not start at round numbers, so that no sample of a usual
step falls on a singular position.
"""

import math
from dataclasses import dataclass

from models.errors import CrankcheckError
from models.files.reading import parse_scene
from models.scene import Driver, Link, Point, Scene
from models.scene.laws import ConstantSpeed

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
    """A four-bar A B C D with A at the origin and D on the x-axis, all lengths in m. C lies to the
    left of the line from B to D."""
    lengths_m = (crank_m, coupler_m, rocker_m, ground_m)
    return _fourbar(name, source, lengths_m, _turning(start_deg, speed_rad_s))


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
    lengths_m = (crank_m, coupler_m, rocker_m, ground_m)
    joint = 'pin = "B"\nlinks = ["crank", "coupler"]'
    driver = _swinging(joint, "deg", centre_deg, amplitude_deg)
    return _fourbar(name, source, lengths_m, driver)


def slider_crank(name: str, crank_m: float, rod_m: float, *, source: str) -> Scene:
    """A central slider-crank A B C along the x-axis, with a block of 0.5 kg per metre of the
    crank."""
    return _scene(name, source, "A = [0.0, 0.0]", _slider_crank_bodies(crank_m, rod_m))


def slider_crank_by_piston(
    name: str, crank_m: float, rod_m: float, *, source: str, amplitude_m: float
) -> Scene:
    """The slider-crank of `slider_crank`, whose block is driven to and fro about mid-stroke. B lies
    to the left of the line from A to C."""
    driver = _swinging('slider = "C"', "m", rod_m, amplitude_m)
    return _scene(name, source, "A = [0.0, 0.0]", _slider_crank_bodies(crank_m, rod_m), driver)


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
    rods = _rods(crank=("AB", crank_m), lever=("CE", 1.5 * (crank_m + pivots_m)))
    ground = f"A = [0.0, {pivots_m!r}], C = [0.0, 0.0]"
    return _scene(name, source, ground, f'{rods}[sliders.B]\non = "lever"\n')


def double_parallelogram(name: str, *, source: str) -> Scene:
    """A parallelogram with a third rocker: it moves, although its mobility by count is 0."""
    coupler = "points = { B = [0.0, 0.0], C = [0.3, 0.0], F = [0.6, 0.0] }, mass_kg = 0.6"
    rods = _rods(crank=("AB", 0.1), coupler=coupler, rocker=("DC", 0.1), third=("GF", 0.1))
    return _scene(name, source, "A = [0.0, 0.0], D = [0.3, 0.0], G = [0.6, 0.0]", rods)


def sprung_cam(name: str, *, source: str, facets: int) -> Scene:
    """An eccentric circle that lifts a flat face of half a kilogram by 20 mm, along y, against a
    spring of 400 N/m that presses with 36 N at lift 0; held by contact."""
    half = "motion = 'harmonic', span_deg = 180.0, lift_m"
    lifter = "points = { C = [0.0, 0.0], D = [0.0, 0.1] }, mass_kg = 0.5"
    bodies = _rods(crank=("AB", 0.05), lifter=lifter)
    bodies += f"""
[sliders]
C = {{ link = "lifter", on = "ground", direction_deg = 90.0 }}
[springs]
C = {{ slider = "C", rate_n_m = 400.0, free_m = -0.05 }}
[cams.C]
cam = "crank"
slider = "C"
contact = "flat"
base_radius_m = 0.04
facets = {facets}
segments = [{{ {half} = 0.02 }}, {{ {half} = -0.02 }}]
"""
    return _scene(name, source, "A = [0.0, 0.0]", bodies, _turning(0.0))


def _fourbar(
    name: str, source: str, lengths_m: tuple[float, float, float, float], driver: str
) -> Scene:
    crank_m, coupler_m, rocker_m, ground_m = lengths_m
    rods = _rods(crank=("AB", crank_m), coupler=("BC", coupler_m), rocker=("DC", rocker_m))
    return _scene(name, source, f"A = [0.0, 0.0], D = [{ground_m!r}, 0.0]", rods, driver)


def _slider_crank_bodies(crank_m: float, rod_m: float) -> str:
    rods = _rods(crank=("AB", crank_m), rod=("BC", rod_m))
    return f'{rods}[sliders.C]\non = "ground"\nmass_kg = {0.5 * crank_m!r}\n'


def _platform_bodies(crank_m: float) -> str:
    legs = {"leg1": ("BC", 0.3), "leg2": ("DE", 0.3), "leg3": ("GF", 0.3)}
    plate = "points = { C = [0.0, 0.0], E = [0.25, -0.05], F = [0.12, 0.18] }"
    return _rods(crank=("AB", crank_m), **legs, plate=plate)


def _rods(**links: tuple[str, float] | str) -> str:
    """Text of links, each a rod between two points with its length [m], or a table of its own."""
    lines = ["[links]"]
    for name, table in links.items():
        text = table
        if not isinstance(table, str):
            ends, length_m = table
            text = f'bar = ["{ends[0]}", "{ends[1]}"], length_m = {length_m!r}'
        lines.append(f"{name} = {{ {text} }}")
    return "\n".join(lines) + "\n"


def _turning(start_deg: float = START_DEG, speed_rad_s: float = SPEED_RAD_S) -> str:
    return f"""
link = "crank"
speed_rad_s = {speed_rad_s!r}
start_deg = {start_deg!r}
"""


def _swinging(joint: str, unit: str, centre: float, amplitude: float) -> str:
    """Text of a joint whose coordinate, angle or displacement, oscillates from its centre on."""
    return f"""
{joint}
law = "oscillating"
centre_{unit} = {centre!r}
amplitude_{unit} = {amplitude!r}
frequency_rad_s = {SPEED_RAD_S!r}
"""


def _scene(name: str, source: str, ground: str, bodies: str, driver: str = _turning()) -> Scene:
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


UPRIGHT = math.pi / 2
SOURCE = "IFToMM Library of Computational Benchmark Problems, A02: N-four-bar mechanism"


@dataclass(frozen=True)
class WindowChain:
    """A chain of ``count`` windows, N; 0 is the first rocker alone, a pendulum.

    ``length_m`` and ``mass_kg`` belong to each rod; gravity [m/s^2] acts downwards; at time 0 the
    rockers stand upright and B0 moves along x with ``speed_m_s``. Raises CrankcheckError for
    numbers that make no chain.

    ::

            B0 ---- B1 ---- B2 -- ... -- BN        N couplers
            |       |       |            |         N + 1 rockers
            A0      A1      A2           AN        on the ground, one length apart

    All 2 N + 1 rods are alike. Every window of the flat chain is at a change point, and the
    mobility rises from 1 to N + 1 for that instant. Source: problem A02, "N-four-bar mechanism", of
    the Library of Computational Benchmark Problems of the IFToMM Technical Committee for Multibody
    Dynamics, which has N = 40, 20 s, 9.81 m/s^2 downwards, and a start upright with 1 m/s of B0
    along x.
    """

    count: int
    length_m: float = 1.0
    mass_kg: float = 1.0
    gravity_m_s2: float = 9.81
    speed_m_s: float = 1.0

    def __post_init__(self) -> None:
        positive = {"length_m": self.length_m, "mass_kg": self.mass_kg}
        faults = [
            f"{name} {number:g}, where a number above 0 is needed"
            for name, number in positive.items()
            if not 0.0 < number < math.inf
        ]
        if self.count < 0:
            faults.append(f"{self.count} windows, where 0 is the least")
        if not 0.0 <= self.gravity_m_s2 < math.inf:
            faults.append(f"gravity_m_s2 {self.gravity_m_s2:g}, where 0 is the least")
        if self.speed_m_s == 0.0 or not math.isfinite(self.speed_m_s):
            faults.append(f"speed_m_s {self.speed_m_s:g}, where another number than 0 is needed")
        if faults:
            raise CrankcheckError(f"chain of windows: found {'; '.join(faults)}")

    @property
    def start_rad_s(self) -> float:
        """Angular velocity of the rockers at time 0; falling along x they turn clockwise."""
        return -self.speed_m_s / self.length_m

    def rockers(self) -> tuple[str, ...]:
        """The names of the rods on the ground."""
        return tuple(f"rocker{i}" for i in range(self.count + 1))

    def couplers(self) -> tuple[str, ...]:
        """The names of the rods on top."""
        return tuple(f"coupler{i}" for i in range(self.count))

    def scene(self) -> Scene:
        """Return the chain for free motion; its driver has the position and speed of the start.

        Driven at rocker0 by `analytic.kinematics.solve` it goes through the flat position up to N =
        6, N = 7 is refused there, and longer chains at any angle: each dyad is in a change point
        with all before it, and rounding hides that from the eighth on.
        """
        links = [self._rod("rocker0", "A0", "B0")]
        for i, coupler in enumerate(self.couplers()):
            links.append(self._rod(coupler, f"B{i}", f"B{i + 1}"))
            links.append(self._rod(f"rocker{i + 1}", f"A{i + 1}", f"B{i + 1}"))
        return Scene(
            name=f"windows-{self.count}",
            source=SOURCE,
            ground={f"A{i}": (i * self.length_m, 0.0) for i in range(self.count + 1)},
            links={link.name: link for link in links},
            sliders={},
            driver=Driver("rocker0", ConstantSpeed(UPRIGHT, self.start_rad_s)),
            gravity_m_s2=(0.0, -self.gravity_m_s2),
        )

    def _rod(self, name: str, start: str, end: str) -> Link:
        length, mass = self.length_m, self.mass_kg
        ends: dict[str, Point] = {start: (0.0, 0.0), end: (length, 0.0)}
        return Link(name, ends, mass, (0.5 * length, 0.0), mass * length**2 / 12)
