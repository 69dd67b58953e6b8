"""What is asked of scenes that are let go."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from models.errors import CrankcheckError
from models.files import kinds, shipped
from models.released import let_go
from models.rigid import with_rigid_links
from models.scene import Scene
from reports.judge.tolerance import check_names
from reports.plan.chosen import chosen_scenes

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
    """The scenes of a study, which are all driven, or all let go. Raises CrankcheckError."""
    if not free:
        return chosen_scenes(names)
    return [let_go(scene) for scene in chosen_scenes(free_names(names), check_names)]


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


def refuse_other_options(
    scenes: Iterable[Scene], of_free: Mapping[str, object], of_driven: Mapping[str, object]
) -> None:
    """Refuse what was asked for, by option, where no scene has any use for it: steps in a turn of
    what is let go, a duration of what is driven. Raises CrankcheckError."""
    free = {scene.is_free for scene in scenes}
    if True not in free:
        for option in (name for name, value in of_free.items() if value is not None):
            raise CrankcheckError(
                f"{option}: it is of scenes that are let go; add --free, or leave {option} out"
            )
    if False not in free:
        for option in (name for name, value in of_driven.items() if value is not None):
            raise CrankcheckError(
                f"{option}: what is let go has no turns; give --dt and --duration, in seconds"
            )
