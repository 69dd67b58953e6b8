"""Task of a cam: its law, its follower, limits of its base circle, and loads of the follower."""

from __future__ import annotations

from functools import cached_property
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, model_validator

from models.files.faults import read_table
from models.files.pair_tables import MOST_SEGMENTS, SegmentTable, law_of
from models.files.schema import Degrees, Name, NonNegative, Number, Positive, Table
from models.files.schema import Text as NoteText
from models.lectures.shipped_tables import Source, find_table
from models.lectures.tasks import TASKS
from models.scene.cam_laws import CamLaw
from models.scene.cams import Follower, OscillatingFollower, TranslatingFollower

Pressure = Annotated[float, Field(strict=True, gt=0.0, lt=90.0)]


class FollowerTable(Table):
    """A translating follower (``offset_m``) or an oscillating one (``pivot_m``, ``arm_m`` or
    ``face_m``), with a knife edge, a roller or a flat face."""

    motion: Literal["translating", "oscillating"]
    contact: Literal["knife", "roller", "flat"]
    roller_m: NonNegative = 0.0
    offset_m: Number = 0.0
    pivot_m: NonNegative = 0.0
    arm_m: NonNegative = 0.0
    face_m: Number = 0.0

    @model_validator(mode="after")
    def _is_one(self) -> FollowerTable:
        others = ("offset_m",) if self.motion == "oscillating" else ("pivot_m", "arm_m", "face_m")
        for key in others:
            if getattr(self, key):
                raise ValueError(f"{key}: a {self.motion} follower has none; leave it out")
        self.follower  # noqa: B018  # raises ValueError
        return self

    @cached_property
    def follower(self) -> Follower:
        if self.motion == "translating":
            return TranslatingFollower(self.contact, self.roller_m, self.offset_m)
        return OscillatingFollower(
            self.contact, self.roller_m, pivot_m=self.pivot_m, arm_m=self.arm_m, face_m=self.face_m
        )


class BaseCircleTable(Table):
    """The base circle: its radius, or limits from which the smallest one follows; with both, limits
    that the cam is checked against. ``least_radius_m`` is the profile's least convex radius of
    curvature."""

    radius_m: Positive | None = None
    pressure_deg: Pressure | None = None
    return_pressure_deg: Pressure | None = None
    least_radius_m: NonNegative | None = None

    @model_validator(mode="after")
    def _gives_one(self) -> BaseCircleTable:
        if self.radius_m is self.pressure_deg is self.least_radius_m is None:
            raise ValueError("give radius_m, pressure_deg, or least_radius_m")
        if self.return_pressure_deg is not None and self.pressure_deg is None:
            raise ValueError("return_pressure_deg: give pressure_deg of the rise as well")
        return self


class FollowerLoadTable(Table):
    """Inertia, spring and weight of the follower: kg, N/m and N, or, of one that oscillates, kg
    m^2, N m/rad and N m about its pivot."""

    inertia: Positive
    stiffness: NonNegative = 0.0
    preload: Number = 0.0
    weight: Number = 0.0
    weight_angle_deg: Degrees = 0.0


class CamTask(Table):
    """A cam: segments of its law over a turn, its follower, base circle, sense, speed, loads."""

    name: Name
    source: Source
    note: NoteText = ""
    sense: Literal["counter-clockwise", "clockwise"] = "counter-clockwise"
    speed_rad_s: Positive = 10.0
    follower: FollowerTable
    base: BaseCircleTable
    segments: Annotated[list[SegmentTable], Field(min_length=1, max_length=MOST_SEGMENTS)]
    load: FollowerLoadTable | None = None

    @model_validator(mode="after")
    def _closes(self) -> CamTask:
        self.law  # noqa: B018  # raises ValueError
        return self

    @cached_property
    def law(self) -> CamLaw:
        return law_of(self.segments, turns=self.follower.motion == "oscillating")


def load_cam_task(name_or_path: str) -> tuple[CamTask, Path]:
    """Load a shipped cam task by name, or one of a file, with its path. Raises CrankcheckError for
    neither, and SceneError for a file with faults."""
    path = find_table(name_or_path, TASKS / "cam", "cam task", "crankcheck cam")
    return read_table(path, CamTask), path
