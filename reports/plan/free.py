"""What is asked of scenes that are let go."""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from analytic.free.free_motion import loosened
from models.errors import CrankcheckError
from models.files.reading import kinds, shipped
from models.scene import Scene
from models.scene.cut_links import with_rigid_links
from models.scene.driver import Controlled
from reports.judge.tolerance import check_names
from reports.plan.chosen import chosen_scenes
from reports.way.way import way_of

FREE = "free"
"""The kind of shipped scenes that are let go."""
LOOK = 1e-3
"""The part of a run that is integrated to see whether it can be."""


def free_names(names: Sequence[str]) -> list[str]:
    """The names of the scenes that are to be let go; all shipped ones of free motion for none.
    Raises CrankcheckError where there are none of these."""
    every = list(names) or list(shipped(FREE))
    if not every:
        raise CrankcheckError(f"--free: no scene of kind free; there is {', '.join(kinds())}")
    return every


def scenes_of(names: Sequence[str], *, free: bool) -> list[Scene]:
    """The scenes of a study, which are all driven, or all let go, with the torque of its controller
    where that gives way to elastic links. Raises CrankcheckError."""
    if not free:
        scenes = chosen_scenes(names)
        for scene in scenes:
            refuse_giving_way(scene, "`crankcheck sweep --free` lets it go so, as `verify` does")
        return scenes
    scenes = chosen_scenes(free_names(names), check_names)
    return [loosened(under_control(scene)) for scene in scenes]


def gives_way(scene: Scene) -> bool:
    """Whether its driver is controlled and its links bend, so that it follows its law nearly."""
    return bool(scene.elastic) and isinstance(scene.driver.law, Controlled)


def under_control(scene: Scene) -> Scene:
    """A scene whose links bend and whose driver is controlled as what engines are given of it: let
    go, with the torque of the controller as loads; others as they are. Raises CrankcheckError as
    `analytic.elastic.control.released_under_control`."""
    if not gives_way(scene):
        return scene
    from analytic.elastic.control import released_under_control  # for elastic links alone

    return released_under_control(scene)


def refuse_giving_way(scene: Scene, instead: str) -> None:
    """Refuse a scene whose controlled driver gives way, where turns are asked for; ``instead`` says
    what takes it. Raises CrankcheckError."""
    if gives_way(scene):
        raise CrankcheckError(
            f"{scene.name}: {', '.join(scene.elastic)} bends, and engines are given it let go, "
            f"with the torque of its controller: it has no turns; {instead}"
        )


def refuse_unreleased(scene: Scene, duration_s: float) -> None:
    """Refuse a scene that can not be let go, or not for so long.

    Raises
    ------
    CrankcheckError
        Friction that grows with what a joint bears, a load over time whose table ends before, no
        mass that moves, a start that can not be assembled or contradicts itself.
    """
    from analytic.free.release import release  # slow to import, for free motion alone

    check_names(scene)
    if scene.coulomb_joints:
        raise CrankcheckError(
            f"{scene.name}: friction that grows with what a joint bears "
            f"({', '.join(scene.coulomb_joints)}) is not taken into free motion; take it out"
        )
    for load in scene.loads.values():
        if load.over == "time":
            load.magnitude(np.array([0.0, duration_s]))
    release(with_rigid_links(scene), LOOK * duration_s)


def refuse_other_options(scenes: Iterable[Scene], options: Mapping[str, object]) -> None:
    """Refuse a length that was asked for, by option, where it says nothing of any scene: steps in a
    turn of what is let go, a duration of what is driven. Raises CrankcheckError."""
    ways = [way_of(scene) for scene in scenes]
    for option, value in options.items():
        if value is not None and not any(option in each.lengths_by for each in ways):
            ways[0].refuse_length(option)
