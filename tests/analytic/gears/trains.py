"""Twenty trains with their published ratios."""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from models.scene.pairs import Gear


@dataclass(frozen=True)
class Known:
    """A train, the speed of ``body`` over that of ``source`` with ``held`` at rest, and its
    source. ``coupled`` trains have no elementary train with two known speeds to start from."""

    gears: tuple[Gear, ...]
    body: str
    source: str
    ratio: Fraction
    held: tuple[str, ...] = ()
    coupled: bool = False


def mesh(one: str, other: str, z: int, y: int, carrier: str = "ground") -> Gear:
    """An external pair."""
    return Gear(f"{one}-{other}", (one, other), (z, y), carrier)


def ring(planet: str, outer: str, z: int, y: int, carrier: str = "ground") -> Gear:
    """A pinion in a ring."""
    return Gear(f"{planet}-{outer}", (planet, outer), (z, y), carrier, internal=True)


def chain(*teeth: tuple[str, str, int, int]) -> tuple[Gear, ...]:
    """Pairs on the ground."""
    return tuple(mesh(*each) for each in teeth)


def planetary(
    sun: str, outer: str, s: int, r: int, arm: str = "arm", n: str = ""
) -> Sequence[Gear]:
    """A sun, a planet that fits, and a ring."""
    p = (r - s) // 2
    return mesh(sun, f"planet{n}", s, p, arm), ring(f"planet{n}", outer, p, r, arm)


RAVIGNEAUX = (
    mesh("small", "short", 30, 18, "arm"), mesh("short", "long", 18, 18, "arm"),
    mesh("large", "long", 36, 18, "arm"), ring("long", "ring", 18, 72, "arm"),
)  # fmt: skip
SIMPSON = (
    *planetary("sun", "front", 30, 66, "out", "1"), *planetary("sun", "out", 30, 66, "rear", "2"),
)  # fmt: skip
FORD_T = (
    mesh("driven", "triple", 27, 27, "arm"), mesh("slow", "triple", 21, 33, "arm"),
    mesh("back", "triple", 30, 24, "arm"),
)  # fmt: skip
PARADOX = tuple(mesh(name, "planet", z, 20, "arm") for name, z in
                (("ground", 100), ("more", 101), ("less", 99)))  # fmt: skip
WOLFROM = (
    mesh("sun", "planet", 12, 36, "arm"), ring("planet", "ground", 36, 84, "arm"),
    ring("planet", "out", 33, 81, "arm"),
)  # fmt: skip
BOOK = planetary("sun", "ring", 40, 80)
KNOWN = {
    "pair": Known(chain(("a", "b", 16, 40)), "b", "a", Fraction(-2, 5)),
    "ring": Known((ring("a", "b", 20, 80),), "b", "a", Fraction(1, 4)),
    "idler": Known(chain(("a", "i", 20, 35), ("i", "b", 35, 60)), "b", "a", Fraction(1, 3)),
    # Shigley, Mechanical Engineering Design, examples 13-4 (compound) and 13-5 (reverted): 30 : 1.
    "compound": Known(chain(("a", "b", 96, 16), ("b", "c", 80, 16)), "c", "a", Fraction(30)),
    "reverted": Known(chain(("a", "b", 108, 18), ("b", "c", 105, 21)), "c", "a", Fraction(30)),
    "clock": Known(chain(("minute", "wheel", 12, 36), ("wheel", "hour", 10, 40)),
                   "hour", "minute", Fraction(1, 12)),
    # Shigley, example 13-6: sun 20 at -100 rev/min, ring 80 held: arm -20, planet 33 1/3.
    "shigley arm": Known(tuple(planetary("sun", "ground", 20, 80)), "arm", "sun", Fraction(1, 5)),
    "shigley planet": Known(tuple(planetary("sun", "ground", 20, 80)), "planet", "sun",
                            Fraction(-1, 3)),
    # Norton, Design of Machinery, example 9-5: sun 40 at -100, arm at -200, ring 80: -250 rpm.
    "norton by sun": Known(tuple(BOOK), "ring", "sun", Fraction(-1, 2), ("arm",)),
    "norton by arm": Known(tuple(BOOK), "ring", "arm", Fraction(3, 2), ("sun",)),
    # Ferguson's paradox (Norton, ch. 9): 99 and 101 beside 100 teeth.
    "paradox 101": Known(PARADOX, "more", "arm", Fraction(1, 101)),
    "paradox 99": Known(PARADOX, "less", "arm", Fraction(-1, 99)),
    # Ford's Model T: 2.75 : 1 and 4 : 1 in reverse.
    "model t low": Known(FORD_T, "driven", "arm", Fraction(4, 11), ("slow",)),
    "model t back": Known(FORD_T, "driven", "arm", Fraction(-1, 4), ("back",)),
    # Ford's AOD, a Ravigneaux set of 30, 36 and 72 teeth: 2.40, 1.467, 0.667, reverse 2.00.
    "aod 1": Known(RAVIGNEAUX, "small", "ring", Fraction(12, 5), ("arm",)),
    "aod 2": Known(RAVIGNEAUX, "small", "ring", Fraction(22, 15), ("large",)),
    "aod over": Known(RAVIGNEAUX, "arm", "ring", Fraction(2, 3), ("large",)),
    "aod reverse": Known(RAVIGNEAUX, "large", "ring", Fraction(-2), ("arm",)),
    # Chrysler's TorqueFlite, a Simpson set: 2.45, 1.45, reverse 2.20.
    "simpson 1": Known(SIMPSON, "front", "out", Fraction(27, 11), ("rear",)),
    "simpson 2": Known(SIMPSON, "front", "out", Fraction(16, 11), ("sun",)),
    "simpson reverse": Known(SIMPSON, "sun", "out", Fraction(-11, 5), ("rear",)),
    # Wolfrom's train: (1 + z3/z1)/(1 - z3 z4/(z2 z5)), z1 = 12, 36/33 planets, 84 and 81 rings.
    "wolfrom": Known(WOLFROM, "sun", "out", Fraction(8) / (1 - Fraction(84 * 33, 36 * 81))),
    # Toyota's power split, 30 and 78 teeth: 108 arm = 30 sun + 78 ring.
    "power split": Known(tuple(planetary("sun", "ring", 30, 78)), "arm", "ring", Fraction(78, 108),
                         ("sun",)),
    # A spur differential of equal gears: half the sum of both sides.
    "differential": Known((mesh("left", "p", 30, 20, "case"), mesh("p", "q", 20, 20, "case"),
                           mesh("q", "right", 20, 30, "case")),
                          "case", "left", Fraction(1, 2), ("right",)),
    # Simpson's first gear driven from the ring, without a speed that starts an elementary train.
    "simpson coupled": Known(SIMPSON, "out", "front", Fraction(11, 27), ("rear",), coupled=True),
}  # fmt: skip
