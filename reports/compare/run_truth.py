"""Which truth a run has: by whether it was driven or let go, and whether its links bend."""

from __future__ import annotations

from collections.abc import Mapping

from models.scene import Same, Scene
from reports.compare.beside import Truth, truth_of


def run_truth(
    scene: Scene,
    steps: int,
    dt_s: float,
    *,
    free: bool,
    given: tuple[int, str],
    tolerance: Mapping[str, float] | None = None,
) -> Truth:
    """The truth of a run of so many steps of ``dt_s`` [s], that is let go where it is ``free``, its
    elastic links ``given`` in so many segments, with springs of a kind. Raises CrankcheckError for
    a scene that has none."""
    if scene.elastic and free:
        from reports.compare.elastic.released_truth import released_elastic_truth  # where they bend

        return released_elastic_truth(scene, *given, steps, dt_s, tolerance)
    if scene.elastic:
        from reports.compare.elastic.elastic_truth import elastic_truth  # where links bend alone

        return elastic_truth(scene, *given, dt_s * (steps + 1))
    if free:
        from reports.compare.free.free_truth import free_truth  # for what is let go alone

        return free_truth(scene, steps, dt_s, tolerance)
    return truth_of(Same(scene))
