"""Redundant links: found in the structure, moved by their pins, refused where they do not fit."""

from dataclasses import replace

import numpy as np
import pytest

from analytic.kinematics import reach, solve, solve_driven
from analytic.structure.mobility import analyse
from models.array import Array
from models.errors import StructureError
from models.files.reading import load_scene, parse_scene
from models.motion import LinkMotion
from models.scene import Driver, Link, Point, Scene
from models.scene.laws import Oscillating

HIGH = np.radians(np.linspace(15.0, 165.0, 40))
"""Driver angles that keep away from the flat positions."""


def parallelogram(rockers: int, *, lever_m: float = 0.1, shift: Point = (0.0, 0.0)) -> Scene:
    """Rods of 0.1 m on the ground 0.3 m apart under one coupler; the last one is the lever."""
    lengths = {f"rocker{i}": 0.1 for i in range(1, rockers)} | {"lever": lever_m}
    feet = {f"A{i}": [0.3 * i, 0.0] for i in range(rockers)}
    feet[f"A{rockers}"] = [0.3 * rockers + shift[0], shift[1]]
    tops = {f"B{i}": [0.3 * i, 0.0] for i in range(rockers + 1)}
    rods = [
        f'links.{name} = {{ bar = ["A{i}", "B{i}"], length_m = {length!r} }}'
        for i, (name, length) in enumerate(lengths.items(), 1)
    ]
    text = f"""
name = "parallelogram"
source = "test"
ground.points = {{ {", ".join(f"{n} = {at!r}" for n, at in feet.items())} }}
links.crank = {{ bar = ["A0", "B0"], length_m = 0.1 }}
links.coupler.points = {{ {", ".join(f"{n} = {at!r}" for n, at in tops.items())} }}
{chr(10).join(rods)}
driver = {{ link = "crank", speed_rad_s = 2.0, start_deg = 15.0 }}
branch.B1 = 1
"""
    return parse_scene(text, "test")


def with_strut(scene: Scene, *points: str, body: str = "coupler", **moved: Point) -> Scene:
    """The scene with a link over points of a body, or places beside them."""
    places = {p: moved.get(p, scene.links[body].points[p]) for p in points}
    x, y = next(iter(places.values()))
    own = {p: (q[1] - y + 0.2, x - q[0]) for p, q in places.items()}  # a frame of its own, turned
    strut = Link("strut", own, 1.0, (0.0, 0.0), 1.0)
    return replace(scene, links={**scene.links, "strut": strut})


@pytest.mark.parametrize("rockers", [2, 3])
def test_rockers_beyond_the_second_are_redundant(rockers: int) -> None:
    """The double parallelogram: mobility by count 0, with another rocker -1, really 1."""
    found = analyse(parallelogram(rockers))
    assert (found.count, found.mobility) == (2 - rockers, 1)
    assert found.count == 3 * len(found.bodies) - 2 * found.pairs
    assert [(g.kind, g.branch_key) for g in found.groups] == [("RRR", "B1")]
    spare = [f"rocker{i}" for i in range(2, rockers)] + ["lever"]
    assert [bridge.link for bridge in found.redundant] == spare
    assert found.redundant[-1].pins == (f"A{rockers}", f"B{rockers}")
    assert found.words == f"mobility 1 ({2 - rockers} by count; redundant: {', '.join(spare)})"


def assert_within(found: LinkMotion, bound: LinkMotion, *exact: Array | float) -> None:
    for got, wanted, most in zip(vars(found).values(), exact, vars(bound).values(), strict=True):
        assert (np.abs(got - wanted) <= most).all()


def test_a_strut_on_the_coupler_turns_as_the_coupler_does_within_the_bounds_of_both() -> None:
    scene = load_scene("sixbar-watt")
    body = next(n for n, link in scene.links.items() if len(link.points) == 3)
    points = tuple(scene.links[body].points)
    law = Oscillating(scene.driver.law.offset_rad, 1.0, 5.0)
    swinging = replace(scene, driver=Driver(scene.driver.link, law))
    time_s = np.linspace(0.0, 2.0, 101)
    for pins in (points, points[1:]):
        motion = solve(with_strut(swinging, *pins, body=body), time_s)
        strut, bound = motion.links["strut"], motion.bound.links["strut"]
        host, limit = motion.links[body], motion.bound.links[body]
        both = type(bound)(*map(np.add, vars(bound).values(), vars(limit).values()))
        lead = np.pi / 2.0 * np.round((strut.theta - host.theta)[0] / (np.pi / 2.0))
        assert_within(strut, both, host.theta + lead, host.omega, host.alpha)
        assert np.abs(strut.alpha).max() > 1.0
        assert bound.alpha.max() < 1e-8


def test_a_dyad_may_hang_on_a_redundant_link() -> None:
    """Rod and arm on a point of the lever, beside its two pins."""
    scene = parallelogram(2)
    lever = replace(scene.links["lever"], points={**scene.links["lever"].points, "E": (0.1, 0.05)})
    rod = Link("rod", {"E": (0.0, 0.0), "F": (0.3, 0.0)}, 1.0, (0.0, 0.0), 1.0)
    arm = Link("arm", {"H": (0.0, 0.0), "F": (0.25, 0.0)}, 1.0, (0.0, 0.0), 1.0)
    more = {"lever": lever, "rod": rod, "arm": arm}
    hung = replace(scene, ground={**scene.ground, "H": (1.0, 0.0)}, links={**scene.links, **more})
    assert [type(part).__name__ for part in analyse(hung).order] == ["Group", "Bridge", "Group"]
    time_s = np.linspace(0.0, 1.2, 25)
    motion = solve(hung, time_s)
    slim = replace(hung, links={n: k for n, k in hung.links.items() if n != "rocker1"})
    slim = replace(slim, branch={"B2": 1})  # without the first rocker the lever is the dyad's own
    other = solve(slim, time_s)
    for name in more:
        for one, twin in zip(*(vars(m.links[name]).values() for m in (motion, other)), strict=True):
            assert np.allclose(one, twin, rtol=0, atol=1e-10)


def rigid_at(degrees: float) -> Scene:
    """The parallelogram with a lever that fits at one angle: its foot is moved about its top."""
    lean, top = np.exp(1j * np.radians(25.0)), np.exp(1j * np.radians(degrees))
    aside = 0.1 * top * (1.0 - lean)
    return parallelogram(2, shift=(float(aside.real), float(aside.imag)))


def strutted_at(degrees: float) -> Scene:
    """With a strut that goes with the coupler, its third pin on the middle of the turning lever."""
    scene, at = parallelogram(2), np.radians(degrees)
    middle = 0.05 * float(np.cos(at)), 0.05 * float(np.sin(at))
    lever = replace(scene.links["lever"], points={**scene.links["lever"].points, "E": (0.05, 0.0)})
    own: dict[str, Point] = {"B0": (0.0, 0.0), "B2": (0.6, 0.0), "E": (0.6 - middle[0], -middle[1])}
    strut = Link("strut", own, 1.0, (0.0, 0.0), 1.0)
    return replace(scene, links={**scene.links, "lever": lever, "strut": strut})


ASIDE = with_strut(parallelogram(2), "B0", "B1", "B2", B1=(0.3, 0.001))
ONLY = "lever fits in place only: A2 and B2 part at"


@pytest.mark.parametrize("bound", [True, False])
@pytest.mark.parametrize(
    ("scene", "degrees", "omega", "said"),
    [
        (parallelogram(2, lever_m=0.101), [15.0, 40.0], 2.0,
         r"parallelogram: redundant link lever is 0\.101 m long from A2 to B2, which stand 0\.1 m "
         r"apart, 0\.001 m off, with crank at [-\d.]+ deg; .* correct its length .*, or remove it"),
        (rigid_at(90.0), [80.0, 90.0, 130.0, 95.0], 2.0,
         "redundant link lever .*crank at 130 deg"),
        (rigid_at(31.0), [31.0], 2.0, rf"{ONLY} [\d.]+ m/s with crank at 31 deg"),
        (rigid_at(31.0), [31.0], 0.0, rf"{ONLY} [\d.]+ m/s\^2 with crank at 31 deg"),
        (ASIDE, [15.0, 40.0], 2.0, r"strut has B1 0\.001 m away from where coupler has"),
        (strutted_at(31.0), [31.0], 2.0,
         r"strut fits in place only: E parts from it at 0\.1 m/s with crank at 31 deg"),
    ],
)  # fmt: skip
def test_a_link_that_does_not_fit_is_refused_with_the_numbers(
    scene: Scene, degrees: list[float], omega: float, said: str, bound: bool
) -> None:
    theta = np.radians(degrees)
    with pytest.raises(StructureError, match=said):
        solve_driven(scene, theta, np.full(1, omega), np.full(1, 3.0), bound=bound)


@pytest.mark.parametrize("bound", [True, False])
@pytest.mark.parametrize("sign", [1, -1])
def test_a_misfit_of_a_billionth_is_let_pass_and_bounded(bound: bool, sign: int) -> None:
    off = parallelogram(2, lever_m=0.1 * (1.0 + 1.2e-9 * sign))
    with pytest.raises(StructureError, match=r"lever .*to within 1e-09 of it: ten digits"):
        solve_driven(off, HIGH, HIGH, HIGH, bound=bound)
    scene = parallelogram(2, lever_m=0.1 * (1.0 + 9e-10 * sign))
    rate, push = np.full_like(HIGH, 2.0), np.linspace(-5.0, 5.0, HIGH.size)
    motion = solve_driven(scene, HIGH, rate, push, bound=bound)
    if bound:
        most = motion.bound.links["lever"]
        assert_within(motion.links["lever"], most, HIGH, rate, push)
        assert most.theta.min() > 9e-10


def test_rods_turn_with_the_crank_through_the_flat_positions_too() -> None:
    """Two turns, with samples in and beside both change points; with a lever that does not fit
    there is no range."""
    assert [len(reach(parallelogram(2, lever_m=length))) for length in (0.1, 0.101)] == [1, 0]
    scene, flat = parallelogram(3), (np.pi - np.radians(15.0)) / 2.0
    beside = flat + np.array([0.0, 1e-9, 1e-6, np.pi / 2.0, np.pi])
    time_s = np.sort(np.concatenate([np.linspace(0.0, 2.0 * np.pi, 721), beside]))
    motion = solve(scene, time_s)
    for name in (n for n in scene.links if n.startswith(("rocker", "lever"))):
        bound = motion.bound.links[name]
        assert_within(motion.links[name], bound, motion.links["crank"].theta, 2.0, 0.0)
        assert bound.theta.max() < 1e-10
