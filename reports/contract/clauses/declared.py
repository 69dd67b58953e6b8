"""Declarations of an engine: profiles, version, and accepted settings."""

import math
import re
from collections.abc import Iterator
from itertools import combinations

import numpy as np

from models.array import Array
from models.errors import EngineError, few, shown
from reports.contract.subject import STEPS, Subject, clause, numbers
from sim.engine import EPSILON, SettingValue
from sim.engine.settings import SettingError, profile_of, resolved
from sim.run.check import SAME, rounding_of

PROFILES = ("as-shipped", "tuned")
NAME = re.compile(r"[A-Za-z_]\w{0,59}")
NONSENSE = "no-such-choice"
UNLIKELY = (0, -1, 0.5)
"""Whole numbers and a broken one, of which every setting refuses at least one."""
FINE, ROUGH_SAMPLES = 8000, 400
"""Steps in a turn in which a motion is smooth to 1e-13 rad, and the samples of it."""
SMOOTH = 1e-3
"""Least rounding of an angle in single precision, over the distance of two numbers at 1 rad."""


@clause(
    "EC11",
    "profiles as-shipped and tuned are complete, and say why",
    "A result with an unknown setting can be neither repeated nor compared.",
    "Give every profile all settings that influence accuracy, each as Setting(value, reason) "
    "with an int, a float or a str.",
    of_scenes=False,
)
def _profiles(subject: Subject) -> Iterator[str]:
    profiles = subject.engine.profiles
    for name in PROFILES:
        if name not in profiles:
            yield f"there is no profile {name}; there are {', '.join(profiles)}"
    complete = {frozenset(profile.settings) for profile in profiles.values()}
    if len(complete) > 1:
        odd = frozenset.union(*complete) - frozenset.intersection(*complete)
        yield f"not every profile has {', '.join(sorted(map(str, odd)))}"
    for name, profile in profiles.items():
        if profile.name != name or profile.engine != subject.engine.name:
            yield f"profile {name} names itself {profile.name} of {profile.engine}"
        if not profile.summary:
            yield f"profile {name} has no summary"
        for setting, value in profile.settings.items():
            if not isinstance(setting, str) or not NAME.fullmatch(setting):
                yield (
                    f"profile {name}: setting {shown(setting)} is not a word of letters, digits, _"
                )
            if not value.reason:
                yield f"profile {name}: {setting} has no reason"
            if type(value.value) not in (int, float, str):
                yield f"profile {name}: {setting} is {shown(value.value)}, not an int, float or str"


@clause(
    "EC12",
    "the version is a text, and the facts state the same",
    "It separates the results of two versions.",
    "Return the version of the library that steps, and pass the same to Facts.",
    of_scenes=False,
)
def _version(subject: Subject) -> Iterator[str]:
    version = subject.engine.version()
    if not isinstance(version, str) or not version.strip() or len(version) > 60:
        yield f"version() gives {shown(version)}"
    elif (held := subject.opened().facts().version) != version:
        yield f"version() gives {shown(version)}, and the facts of a session {shown(held)}"


@clause(
    "EC13",
    "a wrong setting is refused with SettingError",
    "A value that the engine ignores looks like one that it uses.",
    "In check, call check_ranges for the numbers and check_choices for the words.",
    of_scenes=False,
)
def _settings(subject: Subject) -> Iterator[str]:
    for name, profile in subject.engine.profiles.items():
        if text := _refusal(subject, resolved(profile, None)):
            yield f"check refuses profile {name} itself: {text}"
    settings = subject.settings()
    for name, value in settings.items():
        for wrong in _wrong(value):
            if _taken(subject, {**settings, name: wrong}):
                yield f"{name} = {shown(wrong)} is accepted"
        if type(value) is int and all(_taken(subject, {**settings, name: n}) for n in UNLIKELY):
            yield f"{name} accepts each of {', '.join(map(shown, UNLIKELY))}"


def _wrong(value: SettingValue) -> list[SettingValue]:
    """Return values that no setting of that kind can have."""
    if isinstance(value, float):
        return [math.nan, math.inf, -math.inf, NONSENSE]
    return [NONSENSE]


def _taken(subject: Subject, settings: dict[str, SettingValue]) -> bool:
    """True if settings are refused neither at once nor with the scene."""
    return not _refusal(subject, settings) and not _refused_at_open(subject, settings)


def _refusal(subject: Subject, settings: dict[str, SettingValue]) -> str:
    """Return the engine's refusal of settings by SettingError; any other error is raised."""
    try:
        subject.engine.check(settings)
    except SettingError as error:
        return str(error)
    return ""


def _refused_at_open(subject: Subject, settings: dict[str, SettingValue]) -> bool:
    """True if settings are refused with the scene, as `check` cannot see them without it."""
    scene, start, dt_s = subject.scene, subject.start, subject.dt_s()
    try:
        subject.engine.open(scene, start, settings, dt_s, "prescribed")
    except SettingError:
        return True
    except EngineError:
        return False
    return False


@clause(
    "EC14",
    "the reported settings are the requested ones, and profiles that differ run differently",
    "A lost setting gives one result two names, or two results one name.",
    "Read Facts.settings from the engine itself, and check that open passes on each of them; if "
    "it holds another value than requested, state it in Engine.holds.",
)
def _told_back(subject: Subject) -> Iterator[str]:
    for name in subject.engine.profiles:
        asked = resolved(profile_of(subject.engine, name), None)
        given = dict(asked)
        facts = subject.opened(name).facts()
        for setting, value in subject.engine.holds(given, subject.dt_s(), "prescribed").items():
            held = facts.settings.get(setting)
            if not _same(held, value, max(SAME, rounding_of(subject.engine.precision))):
                yield (
                    f"profile {name}: {setting} is requested as {shown(value)}, found {shown(held)}"
                )
    for one, other in combinations(subject.engine.profiles, 2):
        yield from _felt(subject, one, other)


def _felt(subject: Subject, one: str, other: str) -> Iterator[str]:
    """Yield a fault where two profiles hold different settings and run the same."""
    asked, others = subject.settings(one), subject.settings(other)
    kept = [subject.engine.holds(s, subject.dt_s(), "prescribed") for s in (asked, others)]
    if kept[0] == kept[1]:
        return
    first, second = (numbers(subject.opened(name).record(STEPS, 1).poses) for name in (one, other))
    if np.array_equal(first, second, equal_nan=True):
        names = [name for name in asked if asked[name] != others[name]]
        yield (
            f"profiles {one} and {other} differ in {few(names, 4)}, and {STEPS} steps are equal "
            "to the last bit"
        )


def _same(held: object, asked: SettingValue, rounding: float) -> bool:
    """True if a setting is the requested one, up to the loss of a number on its way."""
    if isinstance(asked, float) and isinstance(held, float):
        return math.isclose(held, asked, rel_tol=rounding)
    return held == asked


@clause(
    "EC15",
    "numbers have the digits that `precision` states",
    "Limits for fewer digits hide faults; limits for more find a fault in every number.",
    "Set Engine.precision: single where the engine's own numbers have 24 bits, else double.",
    of_scenes=False,
)
def _digits(subject: Subject) -> Iterator[str]:
    poses = subject.opened(steps=FINE).record(ROUGH_SAMPLES, 1).poses
    bodies = [poses.bodies[name] for name in subject.scene.links]
    if subject.engine.precision == "single":
        rough = max(roughness(body.theta) for body in bodies)
        if rough < SMOOTH * EPSILON["single"]:
            yield (
                f"precision is single, but angles are rounded to {rough:.1g} rad: numbers of 24 "
                f"bits are to {EPSILON['single']:.1g}"
            )
        return
    turning = [body.omega for body in bodies if np.ptp(body.omega) > 0.0]
    if turning and all(np.array_equal(omega, np.float32(omega)) for omega in turning):
        yield "precision is double, but all angular velocities are numbers of 24 bits"


def roughness(series: Array) -> float:
    """Return the rounding of even samples, from most of their fourth differences: of a smooth
    course these fall as the fourth power of the step."""
    return float(np.median(np.abs(np.diff(series, 4)))) / math.sqrt(70.0)  # 1 + 16 + 36 + 16 + 1
