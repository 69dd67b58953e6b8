"""Errors of the forces of an engine."""

import numpy as np

from analytic.forces import kinetostatics
from models.array import Array
from models.motion import Forces
from models.scene import Scene
from reports.contract.clauses.reactions import named

KINDS = ("force", "moment", "torque")


def misses(scene: Scene, found: Forces, *, over_moments: bool = False) -> dict[str, Array]:
    """Errors at each sample, by kind: of reactions over the largest, of moments over that times the
    longest link, or over the largest of them, of the torque over its own largest. None at dead
    points; NaN where a force is."""
    true = kinetostatics.forces(scene, found.time_s, bound=False, skip_dead_points=True)
    exact = dict(named(true))
    assert [name for name, _ in named(found)] == list(exact)
    of_kind = {kind: [exact[name] for name in exact if kind in name] for kind in KINDS}
    sizes = {
        kind: max((float(np.nanmax(np.abs(each))) for each in series), default=0.0)
        for kind, series in of_kind.items()
    }
    own = sizes["moment"] if over_moments else 0.0
    sizes["moment"] = max(own, 1e-9 * sizes["force"]) if own else sizes["force"] * scene.longest_m
    off: dict[str, Array] = {}
    for name, series in named(found):
        kind = next(kind for kind in KINDS if kind in name)
        error = np.where(np.isnan(exact[name]), 0.0, series - exact[name])
        error = np.linalg.norm(error.reshape(len(series), -1), axis=1) / sizes[kind]
        off[kind] = np.maximum(off.get(kind, 0.0), error)
    return off


def worst_of(scene: Scene, found: Forces, settled: int = 0) -> float:
    """The largest of all errors, after some samples."""
    return max(float(off[settled:].max()) for off in misses(scene, found).values())
