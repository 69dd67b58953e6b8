"""A user's own MJCF file as read: its linkage as a scene, and MuJoCo with its model."""

import copy
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from pathlib import Path
from typing import Any

import mujoco  # type: ignore[import-untyped]  # ships no stubs
import numpy as np

from models.errors import EngineError, suggestion
from models.motion import State
from models.scene import Scene
from sim.engine import Engine, Poses, measure, tree_poses
from sim.mujoco.own_model import disturbing, file, session, variants
from sim.mujoco.own_model.component import component, loose_joints
from sim.mujoco.own_model.linkage import linkage, nearly
from sim.mujoco.own_model.planar_model import PlanarModel, limbs_of
from sim.mujoco.own_model.scene import scene_of
from sim.mujoco.stepped import VERSION, compiled
from sim.registry.own_models import MOST_TURNS, Advised, Disturbance, Tour


@dataclass(frozen=True, eq=False)
class ReadModel:
    """An MJCF file as read: `sim.registry.own_models.OwnModel`."""

    path: Path
    planar: PlanarModel

    @property
    def scene(self) -> Scene:
        return self.planar.read.scene

    @property
    def dt_s(self) -> float:
        return float(self.planar.model.opt.timestep)

    @cached_property
    def _present(self) -> list[Disturbance]:
        return disturbing.disturbances(self.planar.linkage)

    @property
    def disturbances(self) -> list[Disturbance]:
        """Disturbances, with points of a link that may have been meant to be one."""
        read = self.planar.read
        near = nearly(read.parts.points, self.planar.linkage)
        of_links = [Disturbance("near points", f"{read.names[at]}: {text}") for at, text in near]
        return [*self._present, *of_links]

    @property
    def files(self) -> list[Path]:
        return file.files(self.path)

    def drawn(self) -> Poses:
        limbs = self.planar.limbs
        q = self.planar.pose()
        still = np.zeros((1, len(q)))
        poses = tree_poses.body_poses(limbs.limbs, q[None], still, still)
        return Poses(np.zeros(1), {name: poses[limb] for name, limb in limbs.shown.items()})

    def coordinate_rad(self) -> float:
        planar = self.planar
        return float(planar.qpos[planar.model.jnt_qposadr[planar.driven]])

    def open_m(self) -> Mapping[str, float]:
        return {name: float(gap[0]) for name, gap in measure.gaps(self.scene, self.drawn()).items()}

    def loose(self) -> list[str]:
        return loose_joints(self.planar.linkage.component)

    @property
    def notes(self) -> Sequence[str]:
        return self.planar.linkage.component.notes

    def welds(self) -> list[str]:
        own = self.planar.linkage.component
        united = [each.bodies for each in own.closures if each.kind == "weld"]
        return [" and ".join(file.body_name(own.model, body) for body in two) for two in united]

    def outside(self, scene: Scene, state: State) -> list[str]:
        return self.planar.outside(scene, state)

    def tour(self, scene: Scene, states: Sequence[State]) -> Tour:
        try:
            return session.tour(self.planar, scene, states)
        except file.ModelError as error:
            raise file.ModelError(f"{self.path}: {error}") from None

    def engine(self, advised: Advised) -> Engine:
        """Return MuJoCo with this model, and the lines of its report as profiles."""

        opened = partial(session.OwnModelSession, self.planar)
        present = dict.fromkeys(each.kind for each in self._present if each.kind in variants.OFF)
        lines = variants.profiles(present, advised)
        return Engine("mujoco", lines, version=lambda: VERSION, check=variants.checked, open=opened)

    def patch(self, dt_s: float, advised: Advised) -> str:
        """Return the recommended settings as a diff, applied and compiled; in words, where the file
        does not hold all that it would change."""
        planar = self.planar
        told = variants.advice(planar.model, dt_s, advised)
        try:
            raw = file.text_of(self.path)
            new = variants.patched(raw, planar.loops, int(planar.model.neq), told)
            found = compiled(new, self.path)
            text = variants.diff(self.path, raw, new)
        except EngineError as error:
            return f"{error}: {told.words()}\n"
        settings = variants.profiles((), advised)[variants.RECOMMENDED].values
        wanted = copy.copy(planar.model)
        variants.applied(wanted, planar.loops, settings, dt_s)
        if variants.held(found, planar.loops, settings) != variants.held(
            wanted, planar.loops, settings
        ):
            return f"its includes override the file itself: {told.words()}\n"
        return text


def read_model(path: Path, joint: str, key: str | None = None) -> ReadModel:
    """Read a file, driven by one of its joints, from a keyframe if named.

    Raises ModelError as `load`, `component`, `linkage` and `scene_of`; for no keyframe of that
    name, or one that is not finite, and for a hinge with so many turns that the rounding of its
    angle would be judged.
    """
    model = file.load(path)
    names = [file.name_of(model, "key", index) for index in range(model.nkey)]
    if key is not None and key not in names:
        there = [name for name in names if name]
        hint = suggestion(key, there, "it has") if there else "the model has none with a name"
        raise file.ModelError(f"--key {key!r}: no keyframe of that name; {hint}")
    keyframe = None if key is None else names.index(key)
    if keyframe is not None:
        for what in ("qpos", "mpos", "mquat"):
            if not np.isfinite(getattr(model, f"key_{what}")[keyframe]).all():
                raise file.ModelError(f"{path}: keyframe {key}: its {what} is not finite")
        model = _moved(model, keyframe)
    try:
        qpos = model.qpos0 if keyframe is None else model.key_qpos[keyframe]
        joined = linkage(component(model, joint, qpos))
        scene = scene_of(joined, file.scene_name(path.stem, "model", ()), f"read off {path.name}")
    except file.ModelError as error:
        raise file.ModelError(f"{path}: {error}") from None
    planar = PlanarModel(model, joined, scene, limbs_of(joined, scene), keyframe)
    for each in planar.limbs.joints:
        turns = float(planar.qpos[planar.model.jnt_qposadr[each.index]]) / math.tau
        if each.kind == "hinge" and not abs(turns) <= MOST_TURNS:
            raise file.ModelError(
                f"{path}: joint {each.name} reads {turns:.3g} turns in this pose; take whole "
                f"turns off it, to within {MOST_TURNS}"
            )
    return ReadModel(path, planar)


def _moved(model: Any, keyframe: int) -> Any:
    """Return the model with its mocap bodies placed by the keyframe: they are ground."""
    moved = copy.copy(model)
    places = model.key_mpos[keyframe].reshape(-1, 3)
    turns = model.key_mquat[keyframe].reshape(-1, 4)
    for body in np.flatnonzero(model.body_mocapid >= 0):
        mocap = int(model.body_mocapid[body])
        turn = np.array(turns[mocap])
        mujoco.mju_normalize4(turn)
        moved.body_pos[body], moved.body_quat[body] = places[mocap], turn
    return moved
