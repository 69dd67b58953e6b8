"""The motion of a scene with elastic links, whatever its driver does: follow a law, give way to a
controller, or be let go."""

from __future__ import annotations

from dataclasses import replace

from analytic.elastic.control import control_elastic
from analytic.elastic.discretisation import Discretisation
from analytic.elastic.elastic_motion import DrivenElasticMotion
from analytic.elastic.released import release_elastic
from analytic.elastic.sampled import ElasticHistory
from models.controlled import Controlled
from models.elastic import Shape
from models.scene import Scene


def elastic_history(
    scene: Scene,
    until_s: float,
    by: Discretisation,
    start: Shape,
    *,
    stiffened: bool = True,
    tolerance: float | None = None,
) -> ElasticHistory:
    """The motion from time 0 to ``until_s`` [s], which starts with a shape.

    ``tolerance`` is that of `release_elastic`, for what gives way. Raises CrankcheckError as that,
    and as `DrivenElasticMotion` where it is asked for anything.
    """
    controlled = isinstance(scene.driver.law, Controlled)
    if not (scene.is_free or controlled):
        return DrivenElasticMotion(scene, until_s, by, start, stiffened)
    begun = replace(scene, start=replace(scene.start, shape=start))
    follow = control_elastic if controlled else release_elastic
    return follow(begun, until_s, by, stiffened=stiffened, tolerance=tolerance)
