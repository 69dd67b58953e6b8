"""Check the names that a user gives, before anything runs."""

from collections.abc import Callable, Iterable, Sequence

import numpy as np

from analytic.kinematics import solve
from models.errors import CrankcheckError, nearest
from models.files import reading
from models.files.inputs import names_in
from models.scene import Scene
from reports.judge.tolerance import check_names
from sim.registry import engine, usual

LOOKS = 721
"""Positions of the first look at a period; the run itself looks at every sample."""
PROFILES = ("tuned", "as-shipped")


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
        scene = reading.load_scene(name)
        (check or refuse_unfollowed)(scene)
        if scenes.setdefault(scene.name, scene) != scene:
            raise CrankcheckError(
                f"scene {name!r}: a second scene called {scene.name}, not the same; rename one"
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
            f"{' and '.join(alone)}: left out, as engines are given no friction that grows with "
            "what a joint bears; `crankcheck solve` shows it"
        )
    if loose:
        notes.append(
            f"{' and '.join(loose)}: left out, as the truth of elastic links that are let go, or "
            "driven by a controller, takes longer than all others; they are run where they are "
            "named"
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
            f"{scene.name}: its driver is let go, and follows no law; `crankcheck verify` runs it, "
            "and `crankcheck sweep --free`"
        )
    turn = np.linspace(0.0, scene.driver.law.period_s, LOOKS)
    solve(scene, turn, points=(), sliders=(), bound=False)


def chosen_engines(names: str | Sequence[str]) -> list[str]:
    """Return the names of the engines, each once, all installed; the usual ones where none is
    named. An engine given as module and attribute is known by its own name from here on."""
    engines = [engine(name) for name in names_in(names, "engines") or usual()]
    for each in engines:
        each.version()
    return list(dict.fromkeys(each.name for each in engines))


def chosen_profiles(names: str | Sequence[str], engines: Iterable[str]) -> list[tuple[str, bool]]:
    """Return profiles with whether they are gated: named ones are; by default `tuned` alone is.
    Raises CrankcheckError for a profile that one of the engines lacks; the message suggests the
    near ones."""
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
    return [(PROFILES[0], True), (PROFILES[1], False)]
