"""Tables of higher pairs in a scene file: gears `[gears.NAME]`, cams `[cams.NAME]`."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Annotated, Literal

from pydantic import Field, StrictBool, StrictInt, model_validator

from models.errors import cut, few
from models.files import schema
from models.files.schema import LISTED, Name
from models.scene import GROUND, Scene, Slider
from models.scene.cam_laws import CamLaw, CamSegment
from models.scene.cams import Cam, Follower, OscillatingFollower, TranslatingFollower
from models.scene.joints import less, sliding_body, turned
from models.scene.pairs import FITS, CamPair, Gear, Points, shared_point

Teeth = Annotated[StrictInt, Field(ge=1, le=100_000)]
STEEPEST_DEG = 45.0
"""Largest pressure angle of a table [deg]; teeth in use have 14.5 to 30."""
MOST_SEGMENTS, MOST_ROWS = 100, 100_000
LEAST_FACETS, MOST_FACETS = 12, 10_000


class GearTable(schema.Table):
    """Two gears in mesh: ``bodies`` with ``teeth``, in ``internal`` pairs the ring as the second,
    on centres carried by ``carrier``."""

    bodies: tuple[Name, Name]
    teeth: tuple[Teeth, Teeth]
    carrier: Name = GROUND
    internal: StrictBool = False
    module_m: schema.Positive | None = None
    pressure_angle_deg: Annotated[schema.Positive, Field(le=STEEPEST_DEG)] = 20.0
    efficiency: Annotated[schema.Positive, Field(le=1.0)] = 1.0
    phase_deg: schema.Degrees = 0.0

    @model_validator(mode="after")
    def _ring_has_more_teeth(self) -> GearTable:
        if self.internal and self.teeth[1] <= self.teeth[0]:
            raise ValueError(
                f"teeth are {self.teeth[0]} and {self.teeth[1]}; the second of an internal pair is "
                "the ring, which has more teeth: exchange them, or leave internal out"
            )
        return self

    def gear(self, name: str) -> Gear:
        """Make the pair of a scene without faults (`faults_of_gears`)."""
        angles = math.radians(self.pressure_angle_deg), math.radians(self.phase_deg)
        own = self.bodies, self.teeth, self.carrier, self.internal, self.module_m
        return Gear(name, *own, angles[0], self.efficiency, angles[1])


def gear_table(gear: Gear) -> Mapping[str, object]:
    """Write the table of a pair."""
    return {
        "bodies": gear.bodies,
        "teeth": gear.teeth,
        "carrier": gear.carrier,
        "internal": gear.internal,
        **({} if gear.module_m is None else {"module_m": gear.module_m}),
        "pressure_angle_deg": schema.in_degrees(gear.pressure_angle_rad),
        "efficiency": gear.efficiency,
        "phase_deg": schema.in_degrees(gear.phase_rad),
    }


def _unknown(key: str, known: Collection[str], *bodies: tuple[str, object]) -> Iterator[str]:
    """Yield one line per name, at its place in a raw table, that is not known."""
    for place, body in bodies:
        if isinstance(body, str) and body not in known:
            yield f"{key}.{place}: found {cut(body)}; {schema.use_one_of(known)}"


def faults_of_gears(gears: schema.RawTables, names: schema.NamesInTables) -> Iterator[str]:
    """Yield one line per raw table whose bodies or carrier are missing, or are one body."""
    for key, _, table in schema.each_of(gears, "gears"):
        listed, carrier = table.get("bodies"), table.get("carrier", GROUND)
        bodies = [b for b in (listed if isinstance(listed, list) else []) if isinstance(b, str)]
        named = [*(("bodies", b) for b in bodies), ("carrier", carrier)]
        yield from _unknown(key, [GROUND, *names.points], *named)
        if len(bodies) == 2 and bodies[0] == bodies[1]:
            yield f"{key}.bodies: found {cut(bodies[0])} twice; name two bodies"
        elif carrier in bodies:
            yield (
                f"{key}.carrier: {cut(carrier)} is one of the two gears; name the body that "
                "carries both centres"
            )


def faults_of_meshes(scene: Scene) -> Iterator[str]:
    """Yield one line per pair whose gears do not turn on its carrier, whose centre distance does
    not fit, or with a body that is elastic."""
    for name, gear in scene.gears.items():
        key, points = f"gears.{name}", scene.points_of
        for body in dict.fromkeys((*gear.bodies, gear.carrier)):
            if body in scene.elastic:
                yield f"{key}: {body} is elastic, and gears and carriers are rigid here"
        try:
            distance = gear.distance_m(points)
        except ValueError as error:
            yield f"{key}: {error}"
            continue
        if gear.module_m is None:
            continue
        count = abs(gear.teeth[0] + gear.second)
        fitting = 0.5 * gear.module_m * count
        if abs(distance - fitting) > FITS * fitting:
            yield (
                f"{key}.module_m: {gear.module_m:g} with {gear.teeth[0]} and {gear.teeth[1]} teeth "
                f"needs a centre distance of {fitting:.9g} m, found {distance:.9g} m; use "
                f"{2.0 * distance / count:.9g}, leave it out, or move the centres"
            )


class SegmentTable(schema.Table):
    """A part of a law of motion: its kind, the turn of the cam, and the change of lift; for a table
    the ``points`` (angle, lift) from (0, 0) on, and the ``order`` of its spline."""

    motion: str
    span_deg: schema.Degrees
    lift_m: schema.Number = 0.0
    lift_deg: schema.Degrees = 0.0
    points: Annotated[list[schema.Coordinates], Field(max_length=MOST_ROWS)] = Field(
        default_factory=list
    )
    order: Literal[1, 3, 5, 7] = 5

    def segment(self, *, turns: bool) -> CamSegment:
        """Make the segment, of a lift in rad where the follower ``turns``. Raises ValueError."""
        if (self.lift_m if turns else self.lift_deg) != 0.0:
            wanted = ("lift_deg", "oscillates") if turns else ("lift_m", "translates")
            raise ValueError(f"its follower {wanted[1]}: give {wanted[0]}")
        by = math.radians(1.0) if turns else 1.0
        rows = tuple((math.radians(angle), by * lift) for angle, lift in self.points)
        lift = math.radians(self.lift_deg) if turns else self.lift_m
        return CamSegment(self.motion, math.radians(self.span_deg), lift, rows, self.order)


def law_of(segments: Sequence[SegmentTable], *, turns: bool) -> CamLaw:
    """Make the law of a cam, lifts in rad where its follower ``turns``. Raises ValueError."""
    made = []
    for number, one in enumerate(segments, 1):
        try:
            made.append(one.segment(turns=turns))
        except ValueError as error:
            raise ValueError(f"segment {number}: {error}") from None
    return CamLaw(tuple(made))


class CamTable(schema.Table):
    """A cam and its follower: the body of a ``slider``, or a ``follower`` that is pinned to the
    ``carrier`` and has its roller, or its face, at the point ``tip``, to the right of the line from
    its pivot to the cam, or to the ``left``. With ``facets`` engines hold it by contact."""

    cam: Name
    slider: Name = ""
    follower: Name = ""
    tip: Name = ""
    carrier: Name = GROUND
    contact: Literal["knife", "roller", "flat"] = "roller"
    base_radius_m: schema.Positive
    roller_radius_m: schema.NonNegative = 0.0
    face_m: schema.Number = 0.0
    clockwise: StrictBool = False
    start_deg: schema.Degrees = 0.0
    left: StrictBool = False
    facets: Annotated[StrictInt, Field(le=MOST_FACETS)] = 0
    segments: Annotated[list[SegmentTable], Field(min_length=1, max_length=MOST_SEGMENTS)]

    @model_validator(mode="after")
    def _is_of_one_kind(self) -> CamTable:
        if bool(self.slider) == bool(self.follower):
            raise ValueError("name the follower: slider = ..., or follower = ... and tip = ...")
        if bool(self.tip) != bool(self.follower):
            raise ValueError("tip is the point of a follower at its cam: give both, or a slider")
        if self.contact != "flat" and self.face_m:
            raise ValueError(f"face_m: a {self.contact} has no face; leave it out")
        if self.left and self.slider:
            raise ValueError("left: a follower that slides has no side; leave it out")
        if self.facets != 0 and self.facets < LEAST_FACETS:
            raise ValueError(
                f"facets: found {self.facets}; give {LEAST_FACETS} or more for a cam by contact, "
                "or 0 for a relation"
            )
        return self

    def pair(
        self, name: str, points: Mapping[str, Points], sliders: Mapping[str, Slider]
    ) -> CamPair:
        """Make the pair of a scene without faults of names (`faults_of_cams`); ``points`` are those
        of all bodies. Raises ValueError for a law or a geometry without a cam."""
        law = law_of(self.segments, turns=not self.slider)
        side, sense = -1 if self.left else 1, -1 if self.clockwise else 1
        if self.slider:
            line, body = sliders[self.slider], sliding_body(sliders[self.slider])
            follower: Follower = self._translating(points, line)
        else:
            body, follower, sense = self.follower, self._oscillating(points), sense * side
        profile = Cam(law, self.base_radius_m, follower, sense)
        start, joint = math.radians(self.start_deg), (self.slider, self.tip)
        return CamPair(
            name, self.cam, body, self.carrier, profile, *joint, side, start, self.facets
        )

    def _translating(self, points: Mapping[str, Points], line: Slider) -> TranslatingFollower:
        """Return a follower whose offset is that of its line from the cam's centre."""
        centre = points[self.carrier][shared_point(points, self.cam, self.carrier)]
        away = turned(less(line.through_m, centre), 0.5 * math.pi - line.direction_rad)
        offset = 0.0 if self.contact == "flat" else away[0]
        return TranslatingFollower(self.contact, self.roller_radius_m, offset)

    def _oscillating(self, points: Mapping[str, Points]) -> OscillatingFollower:
        """Return a follower whose arm is that of its tip, and its pivot that of its link."""
        own, base = points[self.follower], points[self.carrier]
        if self.tip not in own:
            have = few(own, LISTED)
            raise ValueError(f"tip: {self.follower} has no point {self.tip}; use one of {have}")
        pivot = shared_point(points, self.follower, self.carrier)
        apart = math.dist(base[shared_point(points, self.cam, self.carrier)], base[pivot])
        if self.contact == "flat":
            return OscillatingFollower("flat", pivot_m=apart, face_m=self.face_m)
        arm = math.dist(own[pivot], own[self.tip])
        return OscillatingFollower(self.contact, self.roller_radius_m, apart, arm)


def cam_table(pair: CamPair) -> Mapping[str, object]:
    """Write the table of a cam."""
    law, follower, turns = pair.profile.law, pair.profile.follower, not pair.slider
    body = {"follower": pair.follower, "tip": pair.tip, "left": pair.side < 0}
    face_m = getattr(follower, "face_m", 0.0)
    return {
        "cam": pair.cam,
        **(body if turns else {"slider": pair.slider}),
        "carrier": pair.carrier,
        "contact": follower.contact,
        "base_radius_m": pair.profile.base_m,
        "roller_radius_m": follower.roller_m,
        **({"face_m": face_m} if face_m else {}),
        "clockwise": pair.sense < 0,
        "start_deg": schema.in_degrees(pair.start_rad),
        **({"facets": pair.facets} if pair.facets else {}),
        "segments": [segment_table(one, turns=turns) for one in law.segments],
    }


def segment_table(segment: CamSegment, *, turns: bool) -> Mapping[str, object]:
    """Write a segment of a law, of a lift in rad where the follower ``turns``."""

    def lift(value: float) -> float:
        return schema.in_degrees(value) if turns else value

    rows = [[schema.in_degrees(angle), lift(value)] for angle, value in segment.points]
    table = {"points": rows, "order": segment.order} if rows else {}
    return {
        "motion": segment.kind,
        "span_deg": schema.in_degrees(segment.span_rad),
        "lift_deg" if turns else "lift_m": lift(segment.lift),
        **table,
    }


def faults_of_cams(cams: schema.RawTables, names: schema.NamesInTables) -> Iterator[str]:
    """Yield one line per raw table whose bodies or slider are missing, or are one body."""
    for key, _, table in schema.each_of(cams, "cams"):
        cam, follower, carrier = (table.get(one) for one in ("cam", "follower", "carrier"))
        yield from _unknown(key, names.points, ("cam", cam), ("follower", follower))
        yield from _unknown(key, [GROUND, *names.points], ("carrier", carrier))
        yield from _unknown(key, names.sliders, ("slider", table.get("slider")))
        bodies = [cam, follower, table.get("carrier", GROUND)]
        twice = next((one for one in bodies if one is not None and bodies.count(one) > 1), None)
        if isinstance(twice, str):
            yield f"{key}: found {cut(twice)} twice; cam, follower and carrier are three bodies"


def faults_of_guides(scene: Scene) -> Iterator[str]:
    """Yield a line per cam whose follower slides on another body than its carrier, or is
    elastic."""
    for name, pair in scene.cams.items():
        if pair.slider and (on := scene.sliders[pair.slider].on) != pair.carrier:
            yield (
                f"cams.{name}.slider: {pair.slider} slides on {on}, and the carrier is "
                f"{pair.carrier}; name the body that carries both cam and follower"
            )
        for body in (pair.cam, pair.follower, pair.carrier):
            if body in scene.elastic:
                yield f"cams.{name}: {body} is elastic, and cams and followers are rigid here"
