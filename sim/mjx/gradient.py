"""Derivatives of MJX's states, by forward mode: its solver's loop has no reverse mode.

All tangents go in at once: of the numbers of the model, of the state of the start, and of what is
set in each step.
"""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from models.array import Array
from sim.compiling import compiling
from sim.engine import Settings
from sim.engine.gradient import PoseGradient, Variation, slope
from sim.mjx.engine import MjxSession, filled, jax, jnp, mjx, rolled
from sim.mujoco.gradient import SceneNeighbours
from sim.mujoco.ported import IDLE

METHOD = "forward mode"


def gradient(
    variation: Variation, settings: Settings, dt_s: float, steps: Sequence[int]
) -> Iterator[PoseGradient]:
    """Differentiate the compiled loop by all dimensions at once. Raises EngineError."""
    session = MjxSession(variation.scene, variation.state, settings, dt_s, "prescribed")
    opened, last = SceneNeighbours.of(variation, {**IDLE, **settings}, dt_s), max(steps)
    with compiling(), session._as_numbers():
        given = [filled(rows(last + 1)) for rows in (session._controls, session._led)]
        leaves, kind = jax.tree_util.tree_flatten(session._there)
        moved = _slopes(opened, leaves)
        starts = np.array([opened.start_slope(name) for name in variation.names])
        tangents = jax.tree_util.tree_map(jnp.asarray, (moved, starts[:, 0], starts[:, 1]))
        start = session._now.qpos, session._now.qvel

        def after(units: Any) -> Any:
            """Return the joint coordinates after the steps, dimensions changed by so many units."""
            ahead, q, rate = (
                jax.tree_util.tree_map(lambda d: jnp.tensordot(units, d, 1), t) for t in tangents
            )
            model = [a if k not in ahead else a + ahead[k] for k, a in enumerate(leaves)]
            # A crank that is led stands at its start's coordinate, and as far on as it is led.
            led = jnp.asarray(given[1]).at[:, 0].add(q[session._crank])
            now = session._now.replace(qpos=start[0] + q, qvel=start[1] + rate)
            model = jax.tree_util.tree_unflatten(kind, model)
            rows = rolled(model, now, given[0], led, session._crank, last)[1]
            return rows[np.array(steps), : len(q)]

        by, none = {}, jnp.zeros(len(variation.names))
        for name, unit in zip(variation.names, jnp.eye(len(none)), strict=True):
            q, by[name] = (np.asarray(a, float) for a in jax.jvp(after, (none,), (unit,)))
    yield opened.result(METHOD, q, by)


def _slopes(opened: SceneNeighbours, leaves: Sequence[Any]) -> dict[int, Array]:
    """Return the derivatives (P, ...) of the numbers of the model that depend on dimensions."""
    with jax.enable_x64(True):
        near = [
            [jax.tree_util.tree_leaves(mjx.put_model(s._model, impl="jax")) for s in sessions]
            for sessions in opened.near.values()
        ]
        found = {}
        for k, leaf in enumerate(leaves):
            if jnp.issubdtype(leaf.dtype, jnp.inexact):
                by = np.array([slope([np.asarray(one[k]) for one in each]) for each in near])
                if by.any():
                    found[k] = by.astype(leaf.dtype)
    return found


GRADIENT = gradient
