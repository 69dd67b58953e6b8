"""Check the names that a user gives, before anything runs."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Sequence

from models.errors import CrankcheckError
from models.files import load_scene, shipped
from models.scene import Scene
from reports.tolerance import check_names
from sim.registry import ENGINES, engine

PROFILES = ("tuned", "as-shipped")


def chosen_scenes(names: Sequence[str]) -> list[Scene]:
    """The named scenes, each once; all shipped ones where none is named.

    Raises
    ------
    CrankcheckError
        An unknown name, a faulty file, two different scenes of one name.
    """
    scenes: dict[str, Scene] = {}
    for name in names or shipped():
        scene = load_scene(name)
        check_names(scene)
        if scenes.setdefault(scene.name, scene) != scene:
            raise CrankcheckError(
                f"scene {name!r}: a second scene called {scene.name}, not the same; rename one"
            )
    return list(scenes.values())


def chosen_engines(names: Sequence[str]) -> list[str]:
    """The named engines, installed all of them; all there are where none is named."""
    found = list(dict.fromkeys(names or ENGINES))
    for name in found:
        engine(name).version()
    return found


def chosen_profiles(names: Sequence[str], engines: Iterable[str]) -> list[tuple[str, bool]]:
    """Profiles with whether they are gated: those named are; by default `tuned` alone is.

    Raises
    ------
    CrankcheckError
        A profile that one of the engines lacks; the message suggests the near ones.
    """
    for name in names:
        for each in engines:
            known = list(engine(each).profiles)
            if name not in known:
                near = difflib.get_close_matches(name, known, n=2, cutoff=0.4) or known
                raise CrankcheckError(
                    f"profile {name!r}: {each} has none of that name; "
                    f"did you mean {' or '.join(near)}?"
                )
    if names:
        return [(name, True) for name in dict.fromkeys(names)]
    return [(PROFILES[0], True), (PROFILES[1], False)]
