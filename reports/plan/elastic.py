"""What is asked of scenes whose links bend: segments, springs, and steps that these hold."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from models.errors import CrankcheckError, EngineError, shown
from models.motion import State
from models.scene import Scene
from reports.judge.cell import SEGMENTS, Springs
from reports.plan.chosen import refuse_unfollowed
from reports.plan.steps import STEPS_PER_TURN

if TYPE_CHECKING:
    from reports.plan.study import Study

SPRINGS: tuple[Springs, ...] = ("plain", "corrected", "beam")
MOST_SEGMENTS = 64
"""Their exact chain takes minutes, and a turn 100 000 steps."""
STEADY = 1.5
"""The step times the fastest frequency of the segments, in the steps that are taken if none are
asked for: explicit methods come apart from 2 on, or from 2.8."""
PART = 360
"""Of which the steps of a turn are a multiple."""


def chosen_springs(text: str, option: str = "--springs") -> Springs:
    """The springs of that name. Raises CrankcheckError for any other."""
    if text not in SPRINGS:
        *most, last = SPRINGS
        words = f"{', '.join(most)} or {last}"
        raise CrankcheckError(f"{option} {shown(text)}: unknown; use {words}")
    return text


def chosen_segments(count: int | None, option: str = "--segments") -> int:
    """The number of segments, the usual for None. Raises CrankcheckError for one out of range."""
    if count is None:
        return SEGMENTS
    if isinstance(count, bool) or not isinstance(count, int) or not 2 <= count <= MOST_SEGMENTS:
        raise CrankcheckError(
            f"{option}: found {shown(count)}; a link bends with 2 segments or more, and up to "
            f"{MOST_SEGMENTS} are run"
        )
    return count


@dataclass(frozen=True)
class GivenAs:
    """What the elastic links of a scene are given to engines as; ``words`` tell the lines of a
    sweep apart, and are empty of a rigid scene."""

    segments: int = SEGMENTS
    springs: Springs = "plain"
    words: str = ""


def given_as(scene: Scene, study: Study) -> list[GivenAs]:
    """All that a study gives a scene's elastic links as; one of a rigid scene. Raises
    CrankcheckError for a number of segments out of range."""
    if not scene.elastic:
        return [GivenAs()]
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


def given_of(scene: Scene, segments: int | None, springs: str | None) -> GivenAs:
    """What the elastic links of one scene are given as. Raises CrankcheckError as `refuse_rigid`,
    `chosen_segments` and `chosen_springs`."""
    refuse_rigid([scene], segments, springs)
    return GivenAs(chosen_segments(segments), chosen_springs(springs or "plain"))


def refuse_free_elastic(scene: Scene) -> None:
    """Refuse elastic links of what is let go. Raises CrankcheckError."""
    if scene.elastic and scene.is_free:
        raise CrankcheckError(
            f"{scene.name}: it is let go and has elastic links, which engines are not held to yet; "
            "give the driver a law, or leave [elastic] out"
        )


def is_unheld(scene: Scene) -> bool:
    """Whether no engine is held to a scene with elastic links."""
    from reports.compare.elastic.elastic_truth import unheld  # for elastic links alone

    return bool(unheld(scene))


def rigid_alone(what: str) -> Callable[[Scene], None]:
    """A check of scenes for a command that has no elastic links; it raises CrankcheckError."""

    def check(scene: Scene) -> None:
        if scene.elastic:
            raise CrankcheckError(
                f"{scene.name}: {', '.join(scene.elastic)} bends, and `crankcheck {what}` takes "
                f"rigid links; `crankcheck sweep {scene.name} --segments 4,8,16 -o DIR` finds the "
                "cheapest settings of elastic ones, and `verify` judges them"
            )
        refuse_unfollowed(scene)

    return check


def segmented(scene: Scene) -> tuple[Scene, State]:
    """What an engine is given of a scene with elastic links, and the state that it starts from.
    Raises CrankcheckError as `elastic_truth`."""
    from reports.compare.elastic.elastic_truth import elastic_truth  # for elastic links alone

    truth = elastic_truth(scene, SEGMENTS, SPRINGS[0], scene.driver.law.period_s)
    return truth.given, truth.start


def refuse_rigid(scenes: Iterable[Scene], count: object, springs: object) -> None:
    """Refuse what is asked of segments, where no scene has any. Raises CrankcheckError."""
    if any(scene.elastic for scene in scenes):
        return
    for option, given in (("--segments", count), ("--springs", springs)):
        if given is not None:
            raise CrankcheckError(
                f"{option}: it is of elastic links, and no scene has one; leave {option} out"
            )


def refuse_unelastic(scene: Scene, segments: int, springs: Springs) -> None:
    """Refuse elastic links whose motion is not known.

    Raises
    ------
    CrankcheckError
        A link that stretches, which segments do not; a resonance, next to which no periodic motion
        is found.
    """
    from reports.compare.elastic.elastic_truth import elastic_truth  # for elastic links alone

    if not scene.elastic:
        return
    try:
        truth = elastic_truth(scene, segments, springs, scene.driver.law.period_s)
    except EngineError:
        return  # a row with its reason
    truth.look()


def held_steps(scene: Scene, segments: int, springs: Springs) -> float:
    """Steps in a turn that explicit methods hold so many segments with, at least the usual, which
    is what the implicit ones of engines that have beams are given."""
    from analytic.elastic.discretisation import Segments
    from analytic.elastic.stiffness import fastest_rad_s

    if springs == "beam":
        return float(STEPS_PER_TURN)
    fastest = fastest_rad_s(scene, Segments(segments, springs == "corrected"))
    needed = scene.driver.law.period_s * fastest / STEADY
    return max(STEPS_PER_TURN, float(PART * math.ceil(needed / PART)))
