"""A model of the user's own, read: its scene, and what is needed to run it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import mujoco  # type: ignore[import-untyped]  # ships no stubs
import numpy as np

from models.errors import suggestion
from models.scene import Scene
from sim.engine import Poses
from sim.measure import gaps
from sim.mujoco.own_model.closures import name_of
from sim.mujoco.own_model.component import component
from sim.mujoco.own_model.disturbing import Disturbance, disturbances
from sim.mujoco.own_model.fault import ModelError
from sim.mujoco.own_model.file import load
from sim.mujoco.own_model.limbs import Limbs, limbs_of
from sim.mujoco.own_model.linkage import Linkage, linkage
from sim.mujoco.own_model.naming import scene_name
from sim.mujoco.own_model.points import nearly
from sim.mujoco.own_model.scene import Matter, SceneRead, matter_of, scene_of
from sim.tree_poses import body_poses


@dataclass(frozen=True, eq=False)
class OwnModel:
    """A compiled model with the scene that was read off it; ``keyframe`` is the one to start from,
    None for the pose as drawn."""

    model: Any
    linkage: Linkage
    read: SceneRead
    limbs: Limbs
    keyframe: int | None

    @property
    def scene(self) -> Scene:
        """Without a branch; its driver turns at 1 rad/s from where it is drawn."""
        return self.read.scene

    @property
    def driven(self) -> int:
        """The joint that is driven."""
        return self.linkage.component.driven

    @property
    def loops(self) -> list[int]:
        """The equalities that close loops, or are part of a link."""
        return [each.index for each in self.linkage.component.closures]

    @property
    def dt_s(self) -> float:
        """The file's own step [s]."""
        return float(self.model.opt.timestep)

    @cached_property
    def disturbances(self) -> list[Disturbance]:
        return disturbances(self.linkage)

    @cached_property
    def near_points(self) -> list[str]:
        """Points of a link that may have been meant to be one."""
        called = self.read.names
        return [
            f"{called[near.link]}: {near.first} and {near.second} are {near.distance_m:.3g} m apart"
            for near in nearly(self.read.points, self.linkage)
        ]

    def matter(self, body: str) -> Matter:
        """Mass and inertia of a body of the scene, as its bodies in the model add up to."""
        link = next(link for link, name in self.read.names.items() if name == body and link)
        return matter_of(self.linkage, link)

    def drawn(self) -> Poses:
        """The pose that the file asks for: as drawn, or that of the keyframe."""
        model = self.model
        qpos = model.qpos0 if self.keyframe is None else model.key_qpos[self.keyframe]
        q = np.array(self.limbs.senses) * np.array(qpos)[list(self.limbs.positions)]
        still = np.zeros((1, len(q)))
        poses = body_poses(self.limbs.limbs, q[None], still, still)
        shown = {name: poses[limb] for name, limb in self.limbs.shown.items()}
        return Poses(np.zeros(1), shown)

    def open_m(self) -> Mapping[str, float]:
        """By how much each joint is open in that pose [m]."""
        return {name: float(gap[0]) for name, gap in gaps(self.scene, self.drawn()).items()}


def read_model(path: Path, joint: str, key: str | None = None) -> OwnModel:
    """The model of a file, driven by one of its joints, from one of its keyframes if one is named.

    Raises
    ------
    ModelError
        See `load`, `component`, `linkage` and `scene_of`; no keyframe of that name.
    """
    model = load(path)
    names = [name_of(model, mujoco.mjtObj.mjOBJ_KEY, index) for index in range(model.nkey)]
    if key is not None and key not in names:
        there = [name for name in names if name]
        hint = suggestion(key, there, "it has") if there else "the model has none with a name"
        raise ModelError(f"--key {key!r}: no keyframe of that name; {hint}")
    try:
        joined = linkage(component(model, joint))
        scene = scene_of(joined, scene_name(path.stem, "model", ()), f"read off {path.name}")
    except ModelError as error:
        raise ModelError(f"{path}: {error}") from None
    keyframe = None if key is None else names.index(key)
    return OwnModel(model, joined, scene, limbs_of(joined, scene), keyframe)
