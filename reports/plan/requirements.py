"""Checks before anything runs: given names, and requirements of free motion and elastic links."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from analytic.cams.outline import outlined
from analytic.free.free_motion import loosened
from analytic.kinematics import solve
from models.errors import CrankcheckError, EngineError, nearest, shown
from models.files import reading
from models.files.inputs import names_in
from models.files.pair_tables import LEAST_FACETS, MOST_FACETS
from models.files.reading import kinds, shipped
from models.scene import Scene
from models.scene.cut_links import with_rigid_links
from models.scene.driver import Controlled
from reports.judge.tolerance import check_names
from reports.output.console import tell
from reports.output.numbers import listed
from reports.plan.steps import FREE_STEP_S, STEPS_PER_TURN, counted_free, positive
from reports.protocol.length import LEAST_STEPS, SEGMENTS, GivenAs, Length, Springs
from reports.protocol.way import StudyLinks, way_of
from sim.registry import available, declaration, engine, other_version, usual

if TYPE_CHECKING:
    from reports.compare.elastic_truth import ElasticTruth


MOST_LETTERS = 40
"""Most letters of the name of a scene (`models.files.schema.NAME`)."""
LOOKS = 721
"""Positions of the first check of a period; the run itself checks every sample."""
PROFILES = ("tuned", "as-shipped")
EVERY_ENGINE = "all"


def chosen_scenes(
    names: str | Sequence[str], check: Callable[[Scene], None] | None = None
) -> list[Scene]:
    """Return the named scenes and kinds, each scene once; all of kinematics where none is named.

    ``check`` raises for a scene that can not be run, by default `refuse_unfollowed`.

    Raises CrankcheckError for an unknown name, a faulty file, two different scenes of one name; a
    StructureError or ReachError of the reference names group or range.
    """
    scenes: dict[str, Scene] = {}
    for name in reading.names_of_scenes(names) or reading.shipped():
        scene = outlined(reading.load_scene(name))
        (check or refuse_unfollowed)(scene)
        if scenes.setdefault(scene.name, scene) != scene:
            raise CrankcheckError(
                f"scene {name!r}: two different scenes have the name {scene.name}; rename one"
            )
    return list(scenes.values())


def left_out_note(names: str | Sequence[str]) -> str:
    """Return the note on scenes of named kinds that are left out; "" where there are none."""
    asked = names_in(names, "scenes")
    named = [name for name in asked if name in reading.kinds()]
    alone = _left_out(named, asked, reading.reference_alone)
    loose = [one for one in _left_out(named, asked, reading.run_where_named) if one not in alone]
    notes = []
    if alone:
        notes.append(
            f"{' and '.join(alone)}: left out, as no engine here has friction that grows with the "
            "reaction of a joint; `crankcheck solve` shows it"
        )
    if loose:
        notes.append(
            f"{' and '.join(loose)}: left out, as the reference of elastic links in free motion, "
            "or with a controller, takes longer than all others; name them to run them"
        )
    return "\n".join(notes)


def _left_out(
    named: Sequence[str], asked: Sequence[str], of: Callable[[str], list[str]]
) -> list[str]:
    """Return the scenes that named kinds leave out, and that are not named themselves."""
    return [one for one in dict.fromkeys(x for name in named for x in of(name)) if one not in asked]


def refuse_unfollowed(scene: Scene) -> None:
    """Refuse a scene without a closed form, or that can not follow its driver through a period.
    Raises CrankcheckError, also for a tolerance of an unknown quantity; a StructureError or
    ReachError of the reference names group or range."""
    check_names(scene)
    if scene.is_free:
        raise CrankcheckError(
            f"{scene.name}: a scene of free motion, whose driver follows no law; `crankcheck "
            "verify` runs it, and `crankcheck sweep --free`"
        )
    turn = np.linspace(0.0, scene.driver.law.period_s, LOOKS)
    solve(scene, turn, points=(), sliders=(), bound=False)


def chosen_engines(names: str | Sequence[str], *, notes: bool = True) -> list[str]:
    """Return the names of the engines, each once, all installed; the usual ones where none is
    named, for `all` every installed one; with ``notes`` on those that are not, and on versions that
    were never tried. An engine given as module and attribute is known by its own name from here
    on."""
    asked = list(names_in(names, "engines")) or usual()
    if EVERY_ENGINE in asked:
        here = available()
        lacking = [f"engine {each.name}: {each.absence}" for each in here if not each.version]
        tell(lacking * notes)
        there = [each.name for each in here if each.version]
        asked = [one for name in asked for one in (there if name == EVERY_ENGINE else [name])]
    engines = {each.name: each for each in map(engine, asked)}
    for each in engines.values():
        each.version()
    tell([note for name in engines if notes and (note := other_version(name))])
    return list(engines)


def chosen_profiles(names: str | Sequence[str], engines: Iterable[str]) -> list[tuple[str, bool]]:
    """Return profiles with whether they are gated: named ones are; by default `tuned` alone is, of
    all that the engines have. Raises CrankcheckError for a profile that one of the engines lacks;
    the message names near ones."""
    names = names_in(names, "profiles")
    for name in names:
        for each in engines:
            profiles = list(engine(each).profiles)
            if name not in profiles:
                near = nearest(name, profiles, 2) or profiles
                raise CrankcheckError(
                    f"profile {name!r}: {each} has none of that name; "
                    f"did you mean {' or '.join(near)}?"
                )
    if names:
        return [(name, True) for name in dict.fromkeys(names)]
    every = dict.fromkeys(
        [*PROFILES, *(name for each in engines for name in engine(each).profiles)]
    )
    return [(name, name == PROFILES[0]) for name in every]


def usual_length(name: str, scene: Scene, asked: Length, *, named: bool) -> Length | None:
    """Return the length of a run in an engine, that of slow engines where none is ``asked``; None
    for a scene that a slow engine leaves out where no scene is ``named``."""
    fewer = declaration(name).fewer
    if fewer is None or (named and (scene.is_free or asked != Length())):
        return asked
    if not named and scene.name not in fewer.scenes:
        return None
    return asked if asked != Length() else Length(None, fewer.steps_per_turn, fewer.turns)


FREE = "free"
"""Kind of the shipped scenes of free motion."""
LOOK = 1e-3
"""Part of a run that is integrated as a test."""


def free_names(names: Sequence[str]) -> list[str]:
    """Return the names of the scenes for free motion; all shipped ones of that kind for none.
    Raises CrankcheckError where there are none of these."""
    every = list(names) or list(shipped(FREE))
    if not every:
        raise CrankcheckError(f"--free: no scene of kind free; there is {', '.join(kinds())}")
    return every


def scenes_of(names: Sequence[str], *, free: bool) -> list[Scene]:
    """Return the scenes of a study, all driven or all released, with the torque of the controller
    where the driver gives way to elastic links. Raises CrankcheckError."""
    if not free:
        scenes = chosen_scenes(names)
        for scene in scenes:
            refuse_giving_way(scene, "`crankcheck sweep --free` runs it so, as `verify` does")
        return scenes
    scenes = chosen_scenes(free_names(names), check_names)
    return [loosened(under_control(scene)) for scene in scenes]


def gives_way(scene: Scene) -> bool:
    """True if its driver is controlled and its links bend, so that it follows its law nearly."""
    return bool(scene.elastic) and isinstance(scene.driver.law, Controlled)


def under_control(scene: Scene) -> Scene:
    """Return the scene that engines are given of a controlled driver with elastic links: released,
    with the torque of the controller as loads; others as they are. Raises CrankcheckError as
    `analytic.elastic.control.released_under_control`."""
    if not gives_way(scene):
        return scene
    from analytic.elastic.control import released_under_control  # for elastic links alone

    return released_under_control(scene)


def refuse_giving_way(scene: Scene, instead: str) -> None:
    """Refuse a scene whose controlled driver gives way, where turns are requested; ``instead``
    names an alternative. Raises CrankcheckError."""
    if gives_way(scene):
        raise CrankcheckError(
            f"{scene.name}: {', '.join(scene.elastic)} is elastic, and engines run it in free "
            f"motion, with the torque of its controller: it has no turns; {instead}"
        )


def refuse_unreleased(scene: Scene, duration_s: float) -> None:
    """Refuse a scene that can not move freely, or not for so long. Raises CrankcheckError for
    friction that grows with the reaction of a joint, a load over time whose table ends before, no
    mass that moves, a start that can not be assembled or contradicts itself."""
    from analytic.free.release import release  # slow to import, for free motion alone

    check_names(scene)
    if scene.coulomb_joints:
        raise CrankcheckError(
            f"{scene.name}: friction that grows with the reaction of a joint "
            f"({', '.join(scene.coulomb_joints)}) is not part of free motion; remove it"
        )
    for load in scene.loads.values():
        if load.over == "time":
            load.magnitude(np.array([0.0, duration_s]))
    release(with_rigid_links(scene), LOOK * duration_s)


def refuse_other_options(scenes: Iterable[Scene], options: Mapping[str, object]) -> None:
    """Refuse a requested length, by option, that applies to no scene: steps in a turn of a free
    motion, a duration of a driven one. Raises CrankcheckError."""
    ways = [way_of(scene) for scene in scenes]
    for option, value in options.items():
        if value is not None and not any(option in each.lengths_by for each in ways):
            ways[0].refuse_length(option)


SPRINGS: tuple[Springs, ...] = ("plain", "corrected", "beam")
MOST_SEGMENTS = 64
"""Most segments: their exact chain takes minutes, and a turn 100 000 steps."""
SWINGS = 5
"""Swings of the slowest elastic link of a free motion, in a run without a requested duration."""
MOST_LOGGED = 720
"""Most logged samples of a turn of elastic links, whose springs need far more steps than anybody
looks at; or of a whole free motion of less than a second."""
PART = 360
"""Divisor of the steps of a turn, or of a whole free run."""


def chosen_springs(text: str) -> Springs:
    """Return the springs of that name. Raises CrankcheckError for any other."""
    if text not in SPRINGS:
        raise CrankcheckError(f"--springs {shown(text)}: unknown; use {listed(SPRINGS, 'or')}")
    return text


def chosen_segments(count: int | None, option: str = "--segments") -> int:
    """Return the number of segments, the usual for None. Raises CrankcheckError if out of range."""
    if count is None:
        return SEGMENTS
    if isinstance(count, bool) or not isinstance(count, int) or not 2 <= count <= MOST_SEGMENTS:
        raise CrankcheckError(
            f"{option}: found {shown(count)}; an elastic link has 2 to {MOST_SEGMENTS} segments"
        )
    return count


def given_as(study: StudyLinks) -> list[GivenAs]:
    """Return all forms in which a study gives elastic links to engines. Raises CrankcheckError for
    a number of segments out of range."""
    counts = [chosen_segments(count, "segments") for count in study.segments or [SEGMENTS]]
    return [
        GivenAs(count, springs, _words(count, springs))
        for springs in dict.fromkeys(study.springs or SPRINGS[:1])
        for count in dict.fromkeys(counts)
    ]


def _words(count: int, springs: Springs) -> str:
    if springs == "beam":
        return f", beam of {count} elements"
    return f", {count} segments" + f", {springs} springs" * (springs != "plain")


def given_of(scenes: Iterable[Scene], segments: int | None, springs: str | None) -> GivenAs:
    """Return the form in which engines get the elastic links of scenes. Raises CrankcheckError as
    `refuse_rigid`, `chosen_segments` and `chosen_springs`."""
    refuse_rigid(scenes, segments, springs)
    return GivenAs(chosen_segments(segments), chosen_springs(springs or "plain"))


def by_contact(scenes: Iterable[Scene], counts: Sequence[int]) -> list[Scene]:
    """Return the scenes with their cams by contact, under a name of its own for each number of
    facets; as they are for none. Raises CrankcheckError where no scene has a cam, for a number out
    of range, and as `outlined`."""
    every = list(scenes)
    if wrong := [count for count in counts if not LEAST_FACETS <= count <= MOST_FACETS]:
        some = f"{LEAST_FACETS} to {MOST_FACETS}"
        raise CrankcheckError(f"--facets: found {wrong[0]}; a cam by contact has {some}")
    if counts and not any(scene.cams for scene in every):
        raise CrankcheckError("--facets: no scene has a cam; leave --facets out")
    made = []
    for scene in every:
        for count in dict.fromkeys(counts if scene.cams else ()):
            end = f"-{count}-facets"
            name = scene.name[: MOST_LETTERS - len(end)] + end
            made.append(replace(outlined(scene, count), name=name))
        made += [] if counts and scene.cams else [scene]
    return made


def rigid_alone(what: str) -> Callable[[Scene], None]:
    """Return a check of scenes for a command without elastic links; it raises CrankcheckError."""

    def check(scene: Scene) -> None:
        if scene.elastic:
            free = "--free " * (scene.is_free or gives_way(scene))
            raise CrankcheckError(
                f"{scene.name}: {', '.join(scene.elastic)} is elastic, and `crankcheck {what}` "
                f"takes rigid links; `crankcheck sweep {scene.name} {free}--segments 4,8,16 -o "
                "DIR` finds the cheapest settings of elastic ones, and `verify` judges them"
            )
        refuse_unfollowed(scene)

    return check


def cut_scene(scene: Scene, given: GivenAs) -> Scene:
    """Return the scene that an engine gets for one with elastic links. Raises CrankcheckError."""
    from reports.compare.elastic_truth import cut  # where links bend alone

    return cut(scene, given.segments, given.springs).given


def logged_every(steps: float) -> int:
    """Return the stride of logging for so many steps."""
    return max(1, math.ceil(steps / MOST_LOGGED - 1e-9))


def refuse_rigid(scenes: Iterable[Scene], count: object, springs: object) -> None:
    """Refuse options of segments, where no scene has any. Raises CrankcheckError."""
    if any(scene.elastic for scene in scenes):
        return
    for option, given in (("--segments", count), ("--springs", springs)):
        if given is not None:
            raise CrankcheckError(f"{option}: no scene has elastic links; leave {option} out")


def refuse_unelastic(
    truth_of: Callable[[Scene, GivenAs], ElasticTruth], scene: Scene, given: GivenAs
) -> None:
    """Refuse elastic links whose motion is not known, by their start. Raises CrankcheckError for a
    link that stretches, which segments do not; a resonance, next to which no periodic motion is
    found."""
    try:
        truth = truth_of(scene, given)
    except EngineError:
        return  # a row with its reason
    truth.look()


def held_steps(scene: Scene, segments: int, springs: Springs) -> float:
    """Return the steps in a turn with which explicit methods hold so many segments, at least the
    usual number, which also goes to the implicit methods of engines with beams."""
    if springs == "beam":
        return float(STEPS_PER_TURN)
    needed = scene.driver.law.period_s * _held_steps_s(scene, segments, springs)
    return max(STEPS_PER_TURN, float(PART * math.ceil(needed / PART)))


def _held_steps_s(scene: Scene, segments: int, springs: Springs) -> float:
    """Return the steps in a second with which explicit methods hold so many segments; 0 where a
    link only stretches, and is no chain of them."""
    from analytic.elastic.discretisation import Segments
    from analytic.elastic.elastic_motion import fastest_rad_s
    from reports.compare.elastic_truth import STEADY

    links = scene.elastic.values()
    if not all(link.bends for link in links):
        return 0.0
    return fastest_rad_s(scene, Segments(segments, springs == "corrected")) / STEADY


def counted_released(
    scene: Scene,
    dt_s: float | None,
    duration_s: float | None,
    segments: int,
    springs: Springs,
    *,
    every: int = 1,
    least: int = LEAST_STEPS,
) -> tuple[float, int]:
    """Return step [s] and number of steps for elastic links in free motion, as `counted_free`; by
    default for a few swings of the slowest link, and with steps that hold the segments. Raises
    CrankcheckError as that."""
    if duration_s is not None:
        lasts_s = positive("--duration", duration_s, "seconds, such as 1")
    else:
        lasts_s = few_swings_s(scene)
    if dt_s is None:
        needed = lasts_s * max(_held_steps_s(scene, segments, springs), 1.0 / FREE_STEP_S)
        dt_s = lasts_s / (PART * math.ceil(needed / PART))
    return counted_free(scene, dt_s, lasts_s, every=every, least=least)


def few_swings_s(scene: Scene) -> float:
    """Return the default duration of elastic links in free motion [s]: vibrations are followed
    through all swings, so that the reference of a longer time takes as much longer."""
    from analytic.elastic.natural import lowest_rad_s

    swings_s = SWINGS * math.tau / lowest_rad_s(scene)
    return min(scene.driver.law.period_s, float(f"{swings_s:.2g}"))


def shortened_note(scene: Scene, lasts_s: float) -> str:
    """Return the note on a run of elastic links that ends before its scene by default; or ""."""
    whole_s = scene.driver.law.period_s
    if few_swings_s(scene) >= whole_s or not math.isclose(lasts_s, few_swings_s(scene)):
        return ""
    return (
        f"{scene.name}: free motion for {lasts_s:.3g} s of its {whole_s:.4g} s, {SWINGS} swings "
        "of its slowest elastic link; --duration gives more, and takes longer by the same "
        "factor"
    )
