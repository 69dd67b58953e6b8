"""What an engine can not do it says, in its own words and before the first step."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import get_args

from models.errors import EngineError
from models.files.reading import load_scene, shipped
from models.scene import Scene
from reports.contract.clause import Clause
from reports.contract.clauses.start import is_other
from reports.contract.subject import NotTriedError, Subject
from sim.check import refuse_other_model
from sim.engine import Drive
from sim.own_engine.spelling import failure


def _every_scene(subject: Subject) -> Iterator[str]:
    scenes, other = [load_scene(name) for name in shipped()], is_other(subject)
    for scene in [*scenes, _massless(load_scene("fourbar-lecture-1"))]:
        for drive in get_args(Drive):
            at = f"{scene.name}, {drive}" + (" (a link without mass)" * (scene not in scenes))
            try:
                session = subject.in_scene(scene).opened(drive=drive)
            except NotTriedError as refused:
                if not str(refused).strip():
                    yield f"{at}: refused without a word"
                continue
            except Exception as error:  # whatever an engine raises is what is looked for
                yield f"{at}: open raised {failure(error)}, in place of EngineError"
                continue
            try:
                facts, _ = session.facts(), session.record(20, 1)
                start, dt_s = subject.in_scene(scene).start, subject.in_scene(scene).dt_s()
                if not other:
                    refuse_other_model(scene, start, facts, dt_s, drive)
            except EngineError as error:
                yield f"{at}: not refused, and {error}"
            except Exception as error:  # as above
                yield f"{at}: not refused, and then raised {failure(error)}"


def _massless(scene: Scene) -> Scene:
    """The scene with a link that nothing but its joints could move."""
    link = next(name for name in reversed(list(scene.links)) if name != scene.driver.link)
    bare = replace(scene.links[link], mass_kg=0.0, inertia_kg_m2=0.0)
    return replace(scene, links={**scene.links, link: bare})


CLAUSES = (
    Clause(
        "EC71",
        "a scene or a drive that it can not have is refused with EngineError, before the first "
        "step",
        "A refusal is a row with a reason; anything else looks like a fault of the scene.",
        "Raise EngineError in open, with the words that say what is lacking.",
        _every_scene,
        of_scenes=False,
    ),
)
