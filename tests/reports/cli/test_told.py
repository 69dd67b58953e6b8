"""What commands tell on the terminal, where words and numbers are all that there is to see; and
that it fits: less of it where the terminal is narrow, nothing clipped."""

import io

import pytest
from rich.console import Console

from reports.judge.cell import Checked, check
from reports.output.palette import engine_styles
from reports.verify.table import show
from tests.worlds.command_line import flat, told
from tests.worlds.tiers import few
from tests.worlds.turns import of_turns

PISTON = "slider-crank-by-piston"
ONCE = "verify fourbar-lecture-1 --steps-per-turn 360 --turns 1 --no-convergence --engine mujoco"
TOLD = {
    # Numbers of the lecture's first example; a 0 is printed as one where it is within its bound.
    "solve fourbar-lecture-1 --at-deg 90": "coupler 20.781952 0.36271348 -1.3257269 20.297811"
    " | rocker 109.34941 1.9085072 4.6761490 19.396967 | -0.30986795 0.93522980"
    " | -5.4116042 5.8459573 Certain | B 0.0000000 0.10000000",
    "solve fourbar-lecture-1": "crank-rocker (s + l | transmission angle | rocker: swing",
    "solve slotted-lever --along E:0": "lever: swing 38.9424 deg, time ratio 1.55215"
    " | E along 0 deg: stroke 0.333333 m, time ratio 1.55215"
    " | lever 2.5 rad/s at 90 deg, -5 rad/s at 270 deg"
    " | E along 0 deg -1.25 m/s at 90 deg, 2.5 m/s at 270 deg",
    "solve whitworth --along A:30": "A along 30 deg: does not move extreme speeds"
    " | B -1 m/s at 210 deg, 1 m/s at 330 deg crank",
    # Extreme speeds are of the way the driver turns; one that swings does both.
    "solve whitworth --at-deg 90 --clockwise": "extreme speeds, driver at -10 rad/s"
    " | lever -6.66667 rad/s at 90 deg, -20 rad/s at 270 deg"
    " | lever 90.000000 1.5707963 -6.6666667",
    "solve tangent --at-deg 20 --clockwise": "P 1.0472 m/s at 0 deg, -1.0472 m/s at 0 deg"
    " | lever 20.000000 0.34906585 -6.0459979 -34.906585",
    # Coriolis of the block on the lever: 2 times 1.92 rad/s times 0.72 m/s.
    "solve shaper --at-deg 30": "Coriolis slider m m/s m/s^2 m/s^2 B 0.36055513 0.72057669"
    " -5.6003385 2.7714488 F 0.39410348 -1.1227675 -7.9996641 0.0000000",
    # Drivers that slide, or turn a link against another, in their own words and units.
    f"solve {PISTON} --at-m 0.35 --forces": "force power drive on N W"
    " slider C -3.7271082 -2.7891124 | C 0.35000000 0.74833148",
    f"solve {PISTON} --forces": "driving force 15.4 | slider C at",
    f"graph {PISTON} --of rod": "no. C m phi rad | 12 0.30000",
    f"rotatability {PISTON}": f"{PISTON}: only its own branch | slider C ends at 0.2 m: "
    "crank and rod in line",
    # Forces: m a of the block along its line is the rod's, and the guide takes the rest; locked
    # instants are told, and have no mean.
    "solve slider-crank-offset --at-deg 90 --forces": "C block C rod 2.1821789 -0.64285714"
    " 2.2749000 343.58533 | C block ground 0.64285714 | crank -0.28368326 -2.8368326",
    "solve slider-crank-central --at-deg 0 --forces": "crank 0.0000000 0.0000000 from",
    "solve slider-crank-self-locking --at-deg 60 --forces": "piston block ground -1465.3247"
    " | power of W W crank 1549.6487 -722.08830 0.53403097"
    " | piston block ground - 439.59742 -722.08830"
    " | from 80.5961 to 99.4039 deg and from 260.596 to 279.404 deg: there no finite",
    "solve slider-crank-self-locking --forces": "Locked, crank at 81 deg, 81.5 deg, 82 deg"
    " | driving torque 23280.4 N m 279.5 deg - A on crank",
    "solve shaper --forces": "driving torque -17.0189 N m 293 deg 0 A on crank 215.699 N 299.5 deg"
    " 81.2348 | F on block F 65.9946 N 303 deg | slider F, normal -3.29376 N 285.5 deg"
    " | slider B, moment -0.00639277 N m 234 deg 0",
    # What is let go, or bends.
    "solve fourbar-swing --duration 0.5 --steps 4": "driver crank, released at rest at 0 deg, for "
    "10 s; groups | 0.5 -194.2583 10.52205 170.5064 0.1350355 0.295723 0 | uncertainty of the "
    "angle of crank at most | at 0.5 s. Sensitivity 2.61: growth of a small change of the start",
    "solve fourbar-elastic --steps-per-turn 4": "EI = 4.725 N m^2, from 77.3704 rad/s on (10.5"
    " times the speed | by 8 polynomials across each, with the shortening of bent links"
    " | 0.2131743 180 0.0005291017 | deflection of its middle 0.00105172 m 125 deg | Starts on the"
    " periodic motion, with the period of the driver | finer description: deflections",
    "solve fourbar-double-rocker-swing --duration 0.5 --steps 2": "Limits in which driver turns"
    " back: -92.866 deg at 0.415855 s (C).",
    "solve fourbar-elastic-controlled --turns 0.004 --modes 1 --steps-per-turn 500":
    "crank, elastic less rigid | driving torque, elastic",
    "run shaper --steps-per-turn 90 --turns 1 --profile as-shipped": "shaper: mujoco"
    " | 13 of 91 logged samples | ended ok at t = 0.628319 s",
    # Polygons, drawn as far as they are determined.
    "polygon fourbar-lecture-1 --at-deg 90": "velocity polygon, 0.01 m/s to the mm"
    " | v_BA 1 100.00 180.000 known v_CB 0.3314317 33.14 -69.218 by crossing, perpendicular to BC"
    " v_CD"
    " | a^n_BA 10 50.00 -90.000 known a^n_CB 0.439388 2.20 -159.218 known"
    " a^t_CB 5.074453 25.37 110.782 by crossing, perpendicular to BC"
    " a^n_CD 4.373274 21.87 -70.651 known a^t_CD",
    "polygon fourbar-swing --at-s 0": "t = 0 s, 0 rad/s, -77.2067 rad/s^2"
    " | at rest: every velocity is 0 | one point, as omega is 0",
    "polygon fourbar-chain --omega 1 --at-deg 0": "v_B0A0"
    " | not drawn: RRR (coupler0, rocker1): both directions"
    " | not drawn: RRR (coupler1, rocker2): depends on coupler0",
    "graph fourbar-lecture-1 --of rocker --divisions 8": "no. crank deg phi rad omega rad/s exact"
    " epsilon rad/s² exact | 0.5 112.50 4.9897"
    " | in 8 parts; omega off by up to 5.4 %, epsilon off by up to 11 %",
    # Structure.
    "structure sixbar-stephenson": "the mechanism is of class II | * pin A of ground and crank II"
    " | pin G of ground and lever III | 4 assemblies with crank at 90 deg",
    "structure fourbar-double-rocker --at-deg 170": "no assemblies with driver at 170 deg",
    "chains --links 8": "16 chains of 8 links with mobility 1 | 4 binary, 4 ternary 9"
    " 5 binary, 2 ternary, 1 quaternary 5 6 binary, 2 quaternary 2",
    "rotatability fourbar-lecture-1": "Grashof crank-rocker, margin 0.05 m | 60.0323",
    "rotatability fourbar-lecture-1 --position 30 --position 90": "led through",
    "rotatability fourbar-double-rocker-swing": "free: rotations are over its whole circuit, 1"
    " | rocker ground swings 0 -307.169 -52.8311 254.338"
    " | rocker -20.7419 driver and coupler in line",
    "rotatability slider-crank-spring": "other circuits | 2 rod ground swings 0 -195.466 -156.422",
    "equilibria fourbar-swing": "1 yes stable crank -111.653, coupler 49.557, rocker 0.0552469"
    " 2.18636 150.883 1 yes unstable",
    "sensitivity fourbar-lecture-1": "the angle of rocker over a turn | coupler 250 mm 0.1 mm"
    " -0.0367 crank at 0 deg 0.032 0.917 | All but the driver at once: 0.119 deg at worst, 0.0607",
    "sensitivity cam-flat": "disc.base 40 mm | No effect: ground, cam, follower, guide.offset",
    "joint crossed-cylinders": "touches point: a higher pair"
    " | alone class 1, leaves Qx, Qy, Qz, Ty, Tz; a force must keep the two together"
    " | guided class 4, leaves Qz, Tz, where its neighbours leave Qz, Tz",
    "mobility parallelogram-third-crank": "count W = 3 n - 2 p5 - p4 = 3*4 - 2*6 - 1*0 = 0, with"
    " n = 4 moving links | rank 11 of 12 constraints are independent"
    " | mobility W = 1 passive 1 constraint: link crank-3 may be left out",
    "mobility rssr": "mobility W = 2, 1 without idle ones | idle 1 freedom: coupler: turns about "
    "the line through B and C",
    "mobility stretched-bars": "of first order alone: the scheme shakes",
    # Verdicts: as shipped is shown and does not count, but for where it is named.
    ONCE: "profile tuned (gated) | profile as-shipped (shown, not gated) | OUT fourbar-lecture-1"
    " | WITHIN TOLERANCE: 1 cell (1 scene x 1 engine) | , mujoco 4.",
}  # fmt: skip
OUT = {
    f"{ONCE} --profile as-shipped": "profile as-shipped (gated)",
    "rotatability fourbar-lecture-1 --position 30:+ --position 90:-": "a circuit defect",
}
"""What ends with exit code 1."""
DEAR = {
    "solve fourbar-double-rocker-swing --duration 0.5 --steps 2",
    "solve fourbar-elastic-controlled --turns 0.004 --modes 1 --steps-per-turn 500",
    "solve slider-crank-self-locking --forces", "solve shaper --at-deg 30",
    f"graph {PISTON} --of rod", "rotatability slider-crank-spring", "mobility stretched-bars",
    f"solve {PISTON} --at-m 0.35 --forces", "solve whitworth --along A:30",
    "solve slider-crank-central --at-deg 0 --forces",
}  # fmt: skip
UNSAID = {
    "solve slider-crank-central --at-deg 0 --forces": ("dead point",),
    "solve fourbar-elastic --steps-per-turn 4": ("near resonance",),
    "solve slider-crank-self-locking --forces": ("dead point",),
    "solve shaper --forces": ("friction", "efficiency"),
}


@pytest.mark.parametrize(
    "line", few([*TOLD, *OUT], {*TOLD, *OUT} - DEAR, "half a second, beside another of its kind")
)
def test_it_is_told_and_fits(line: str) -> None:
    output = told(line, code=int(line in OUT))
    if line.startswith(("solve", "verify", "run")):
        assert max(len(each.rstrip()) for each in output.splitlines()) <= 100
    said = flat(output)
    assert [words for words in {**TOLD, **OUT}[line].split(" | ") if words not in said] == []
    assert [words for words in UNSAID.get(line, ()) if words in said.lower()] == []


CLIPPED = "\u2026"
NAMES = ("fourbar-lecture-1", "slider-crank-excel-350")


@pytest.fixture(scope="module")
def checked() -> list[Checked]:
    """Short and long names, large shares of a limit, and a floor."""
    limit = {"angle": 1e-7}
    return [
        check(of_turns(name, engine, profile=profile, gated=gated, tolerance=limit, converge=True))
        for name in NAMES
        for profile, gated in (("tuned", True), ("as-shipped", False))
        for engine in ("mujoco", "pymunk")
    ]


@pytest.mark.parametrize("width", [60, 72, 80, 99, 100])
def test_a_verdict_is_whole_at_every_width(checked: list[Checked], width: int) -> None:
    """Scene, engine, worst and trend are there; what there is no room for is left out whole."""
    stream = io.StringIO()
    show(Console(file=stream, width=width), checked, {"crankcheck": "1"})
    text = stream.getvalue()
    lines = text.splitlines()
    table = text[text.index("profile tuned") : text.index("CC110")]
    assert max(len(line.rstrip()) for line in lines) <= width
    assert CLIPPED not in text
    for part in (*NAMES, "mujoco", "pymunk", "error /", "when dt", "shrink", "floor"):
        assert part in table
    for one in checked:
        assert f" {one.errors.worst('angle').pure:.1e} " in table
        if one.convergence and one.convergence.trend == "shrinks":
            assert one.convergence.words in table
    assert ("   gap " in text) is (width >= 80)
    assert ("accel." in text) is (width >= 100)


def test_a_colour_terminal_shows_engines_in_the_colours_of_pages(checked: list[Checked]) -> None:
    stream = io.StringIO()
    show(Console(file=stream, force_terminal=True, color_system="truecolor"), checked, {})
    for engine, colour in engine_styles(["mujoco", "pymunk"]).items():
        rgb = ";".join(str(int(colour[at : at + 2], 16)) for at in (1, 3, 5))
        assert stream.getvalue().count(f"\x1b[38;2;{rgb}m{engine}\x1b[0m") == 2 * len(NAMES)
