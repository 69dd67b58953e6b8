"""Tables `[springs.NAME]` and `[friction.JOINT]` of a scene file."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping

from pydantic import model_validator

from models.errors import cut, few
from models.files import schema
from models.files.schema import LISTED, Name, NonNegative
from models.scene import GROUND, Link, Point, loads


class SpringTable(schema.Table):
    """A spring with a damper: between two ``points``, in a ``pin`` (between two ``bodies``), or
    along a ``slider``."""

    points: tuple[Name, Name] | None = None
    pin: Name | None = None
    bodies: tuple[Name, Name] | None = None
    slider: Name | None = None
    rate_n_m: NonNegative | None = None
    damping_n_s_m: NonNegative | None = None
    free_m: schema.Number | None = None
    rate_n_m_rad: NonNegative | None = None
    damping_n_m_s: NonNegative | None = None
    free_deg: schema.Degrees | None = None

    @model_validator(mode="after")
    def _is_of_one_kind(self) -> SpringTable:
        if sum(each is not None for each in (self.points, self.pin, self.slider)) != 1:
            raise ValueError("give its place, one of points = [...], pin = ..., slider = ...")
        along = {"rate_n_m": self.rate_n_m, "damping_n_s_m": self.damping_n_s_m}
        turning = {"rate_n_m_rad": self.rate_n_m_rad, "damping_n_m_s": self.damping_n_m_s}
        own, others = (turning, along) if self.pin is not None else (along, turning)
        lengths = {"free_m": self.free_m, "free_deg": self.free_deg}
        other_free = "free_m" if self.pin is not None else "free_deg"
        wrong = [key for key, value in others.items() if value is not None]
        wrong += [other_free] * (lengths[other_free] is not None)
        if wrong:
            where = "a pin" if self.pin is not None else "points, or a slider"
            raise ValueError(f"{wrong[0]} does not belong to {where}; give {' and '.join(own)}")
        if not any(own.values()):
            raise ValueError(f"a spring needs a rate or a damping above 0: {' or '.join(own)}")
        if self.bodies is not None and self.pin is None:
            raise ValueError("bodies belong to a spring in a pin; leave them out")
        if self.points is not None and self.points[0] == self.points[1]:
            raise ValueError(f"found {self.points[0]} twice; name two points")
        if self.points is not None and self.free_m is not None and self.free_m < 0.0:
            raise ValueError(f"free_m is {self.free_m:g}; a distance is 0 or more")
        return self

    def spring(
        self, name: str, ground: Mapping[str, Point], links: Mapping[str, Link]
    ) -> loads.Spring:
        """Make the spring of a scene without faults (`faults_of_springs`)."""
        if self.pin is not None:
            points = {link: each.points for link, each in links.items()}
            first, second = self.bodies or schema.bodies_at(self.pin, ground, points)
            rate, damping = self.rate_n_m_rad or 0.0, self.damping_n_m_s or 0.0
            free = math.radians(self.free_deg or 0.0)
            return loads.PinSpring(name, rate, damping, free, self.pin, (first, second))
        own = (name, self.rate_n_m or 0.0, self.damping_n_s_m or 0.0, self.free_m or 0.0)
        if self.points is not None:
            return loads.LineSpring(*own, self.points)
        assert self.slider is not None
        return loads.SlideSpring(*own, self.slider)


def spring_table(spring: loads.Spring) -> Mapping[str, object]:
    """Write the table of a spring."""
    if isinstance(spring, loads.PinSpring):
        return {
            "pin": spring.point,
            "bodies": spring.bodies,
            "rate_n_m_rad": spring.rate,
            "damping_n_m_s": spring.damping,
            "free_deg": schema.in_degrees(spring.free),
        }
    own = {"rate_n_m": spring.rate, "damping_n_s_m": spring.damping, "free_m": spring.free}
    if isinstance(spring, loads.LineSpring):
        return {"points": spring.points, **own}
    return {"slider": spring.slider, **own}


def faults_of_springs(springs: schema.RawTables, names: schema.NamesInTables) -> Iterator[str]:
    """Yield one line per spring of the raw tables whose ends are missing or ambiguous."""
    sliders = schema.each_of(names.sliders, "sliders")
    on_lines = (slider.get("point", name) for _, name, slider in sliders)
    everywhere = sorted(names.of_bodies.union(p for p in on_lines if isinstance(p, str)))
    for key, _, table in schema.each_of(springs, "springs"):
        ends = table.get("points")
        both = [end for end in ends if isinstance(end, str)] if isinstance(ends, list) else []
        for point in both:
            if point not in everywhere:
                yield (
                    f"{key}.points: no body has a point {cut(point)}; use {few(everywhere, LISTED)}"
                )
        for body, own in {GROUND: names.ground, **names.points}.items():
            if len(set(both)) == 2 and own.issuperset(both):
                yield (
                    f"{key}.points: {' and '.join(both)} are points of {cut(body)}, at a "
                    "constant distance; name points of two bodies"
                )
        slider = table.get("slider")
        if isinstance(slider, str) and slider not in names.sliders:
            have = schema.use_one_of(names.sliders, "there is none")
            yield f"{key}.slider: found {cut(slider)}; {have}"
        pin = table.get("pin")
        if isinstance(pin, str):
            yield from _faults_of_pin(key, pin, table.get("bodies"), names.at(pin))


def _faults_of_pin(key: str, pin: str, bodies: object, met: list[str]) -> Iterator[str]:
    if len(met) < 2:
        yield f"{key}.pin: fewer than two links, or links and the ground, meet at {cut(pin)}"
    elif bodies is None and len(met) > 2:
        yield f"{key}.bodies: {few(met, LISTED)} meet at {cut(pin)}; name two of them"
    if isinstance(bodies, list) and len(bodies) == 2 and bodies[0] == bodies[1]:
        yield f"{key}.bodies: found {cut(str(bodies[0]))} twice; name two bodies"
    for body in bodies if isinstance(bodies, list) else []:
        if isinstance(body, str) and body not in met:
            yield f"{key}.bodies: {cut(body)} is not at {cut(pin)}; use two of {few(met, LISTED)}"


class FrictionTable(schema.Table):
    """Friction in the joint that the table is named after; `faults_of_friction`, which knows the
    joints, checks that its keys fit a pin or a slider."""

    mu: NonNegative | None = None
    radius_m: schema.Positive | None = None
    torque_n_m: NonNegative | None = None
    force_n: NonNegative | None = None

    @model_validator(mode="after")
    def _rubs_in_one_way(self) -> FrictionTable:
        kinds = [key for key in ("mu", "torque_n_m", "force_n") if getattr(self, key) is not None]
        if self.radius_m is not None and self.mu is None:
            raise ValueError("radius_m is that of a pin with mu, which is missing; add mu")
        if len(kinds) != 1:
            raise ValueError(
                f"found {' and '.join(kinds) or 'none of them'}; give one of mu (with radius_m in "
                "a pin), torque_n_m (a pin) and force_n (a slider)"
            )
        return self

    def friction(self, joint: str) -> loads.Friction:
        """Make the friction of a joint."""
        if self.mu is not None:
            return loads.CoulombFriction(joint, self.mu, self.radius_m or 0.0)
        size = self.torque_n_m if self.force_n is None else self.force_n
        assert size is not None
        return loads.ConstantFriction(joint, size)


def friction_table(friction: loads.Friction, *, slides: bool) -> Mapping[str, object]:
    """Write the table of friction, in a slider or a pin."""
    if isinstance(friction, loads.ConstantFriction):
        return {"force_n" if slides else "torque_n_m": friction.size}
    table = {"mu": friction.mu}
    return table if slides else {**table, "radius_m": friction.radius_m}


def faults_of_friction(friction: schema.RawTables, names: schema.NamesInTables) -> Iterator[str]:
    """Yield one line per friction that has no joint, or a joint of another kind."""
    counts = Counter(names.ground)
    for points in names.points.values():
        counts.update(points)
    counts.update(names.blocks.values())
    pins = [point for point, count in counts.items() if count == 2]
    for key, joint, table in schema.each_of(friction, "friction"):
        if joint in names.sliders:
            for what in ("radius_m", "torque_n_m"):
                if what in table:
                    yield (
                        f"{key}.{what}: belongs to a pin, and {cut(joint)} is a slider; leave "
                        "it out, or, if you mean the pin of its block, give the slider a name "
                        "other than its point's"
                    )
        elif counts[joint] > 2:
            yield (
                f"{key}: {counts[joint]} bodies meet at {cut(joint)}, and it is open which of "
                "them rub; give each two of them a pin of their own"
            )
        elif joint in pins:
            if "force_n" in table:
                yield f"{key}.force_n: belongs to a slider, and this is a pin; use torque_n_m"
            if "mu" in table and "radius_m" not in table:
                yield f"{key}.radius_m: missing; mu of a pin acts at its radius: add it"
        else:
            have = [*sorted(pins), *(name for name in names.sliders if name not in pins)]
            yield f"{key}: no joint of two bodies has that name; {schema.use_one_of(have)}"
