"""Faults of gears and cams: another pair or its spring in the engine; contact lost in the log."""

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

from analytic.cams.outline import outlined
from models.scene import Scene
from models.scene.cam_laws import CamLaw
from models.scene.pairs import CamPair, Gear
from reports.selftest import fault
from reports.selftest.log_faults import WHEN, moved
from sim.engine import Run
from sim.registry import engine

TRAIN, CAM, FACE = "planetary", "cam-roller", "cam-flat"
FACETS, FINER = 360, 4
"""Facets of a cam by contact, and steps over those of other runs: these show few facets."""
LOST = slice(WHEN, WHEN + 3)
"""Samples at which contact is lost."""


def _first(table: str, change: Callable[[Any, float], Any]) -> fault.Plant:
    """Give the engine another first entry of a table, or the same for a size of 0."""

    def another(scene: Scene, size: float) -> Scene:
        pairs = getattr(scene, table)
        name, pair = next(iter(pairs.items()))
        changed: dict[str, Any] = {table: {**pairs, name: change(pair, size) if size else pair}}
        return replace(scene, **changed)

    return fault.in_scene(another)


_gear, _cam = partial(_first, "gears"), partial(_first, "cams")


def _profile(pair: CamPair, **changes: Any) -> CamPair:
    return replace(pair, profile=replace(pair.profile, **changes))


def _more_teeth(gear: Gear, count: float) -> Gear:
    return replace(gear, teeth=(gear.teeth[0], gear.teeth[1] + round(count)))


def _other_law(pair: CamPair, _: float) -> CamPair:
    """Cycloidal in place of 3-4-5: the same stroke, and nearly the same course."""
    parts = [replace(one, kind="cycloidal") if one.lift else one
             for one in pair.profile.law.segments]  # fmt: skip
    return _profile(pair, law=CamLaw(tuple(parts)))


def _softer(scene: Scene, share: float) -> Scene:
    springs = {name: replace(own, rate=own.rate * (1.0 - share))
               for name, own in scene.springs.items()}  # fmt: skip
    return replace(scene, springs=springs)


def _lifted(scene: Scene, done: Run, share: float) -> Run:
    """Lift the follower off the cam for three samples."""
    motion, ((_, pair),) = moved(done), scene.cams.items()
    own = motion.sliders[pair.slider]
    away = own.displacement.copy()
    away[LOST] += share * pair.profile.law.stroke
    sliders = {**motion.sliders, pair.slider: replace(own, displacement=away)}
    return replace(done, motion=replace(motion, sliders=sliders))


_train = partial(fault.Fault, "pair", rule="CC103", scenes=(TRAIN,))
_disc = partial(fault.Fault, "pair", rule="CC104", scenes=(CAM,))
PAIRS = (
    _train("gear-tooth", "a gear has more teeth", plant=_gear(_more_teeth), size=1.0,
           unit="teeth", whole=True),
    _train("gear-inside", "a gear is taken for a ring",
           plant=_gear(lambda gear, _: replace(gear, internal=True))),
    _train("gear-swapped", "two gears have each other's teeth",
           plant=_gear(lambda gear, _: replace(gear, teeth=gear.teeth[::-1]))),
    _train("gear-turned", "a gear meshes ahead of where it does",
           plant=_gear(lambda gear, by: replace(gear, phase_rad=gear.phase_rad + by)),
           size=2e-2, unit="rad"),
    _disc("cam-turned", "the profile is turned on its shaft",
          plant=_cam(lambda pair, by: replace(pair, start_rad=pair.start_rad + by)),
          size=math.radians(1.0), unit="rad"),
    _disc("cam-backwards", "the profile runs the other way round",
          plant=_cam(lambda pair, _: _profile(pair, sense=-pair.profile.sense))),
    _disc("cam-law", "another law of the same stroke", plant=_cam(_other_law)),
    _disc("cam-stroke", "a larger stroke",
          plant=_cam(lambda pair, by: _profile(pair, law=pair.profile.law.scaled(1.0 + by))),
          size=1e-2, unit="of it"),
    _disc("cam-base", "a larger base circle",
          plant=_cam(lambda pair, by: _profile(pair, base_m=pair.profile.base_m * (1.0 + by))),
          size=1e-3, unit="of it"),
    _disc("contact-lost", "contact is lost for three samples",
          plant=fault.in_log(_lifted), size=1e-2, unit="of it"),
    fault.Fault("contact", "facets-few", "fewer facets than requested", "CC104",
                fault.in_scene(lambda scene, share: outlined(scene, round(FACETS * (1.0 - share)))),
                0.9, "of them", scenes=(FACE,),
                needs=lambda name: engine(name).applies_cams_by_contact),
    fault.Fault("force", "spring-soft", "the spring of a follower is too soft", "CC123",
                fault.in_scene(_softer), 2e-2, "of it", scenes=(FACE,),
                needs=lambda name: engine(name).applies_cams
                and engine(name).forces_of != "nothing"),
)  # fmt: skip
