"""Tables of a cam, on the terminal and as JSON."""

from __future__ import annotations

import math
from collections.abc import Mapping

from rich.console import Console

from analytic.cams.cam_design import ExaminedCam
from models.scene.cam_laws import KINDS, CamLaw, peak_factors
from models.scene.cams import Cam
from reports.lectures.cams.profile_files import unit_of
from reports.output.console import say, show_rows

RATES = ("velocity", "acceleration", "jerk")
Rows = list[dict[str, object]]


def number_rows(found: ExaminedCam) -> dict[str, float | str | None]:
    """Return the numbers of a cam by name with unit; None where there is none."""
    cam, deg = found.cam, math.degrees
    pressure = (found.rise_pressure, found.return_pressure)
    (rise, rise_at), (back, back_at) = pressure
    rows: dict[str, float | str | None] = {
        "base_radius_m": cam.base_m,
        f"stroke_{unit_of(cam)}": cam.law.stroke,
        f"start_{unit_of(cam)}": cam.start,
        "pressure_rise_deg": deg(rise),
        "pressure_rise_at_deg": deg(rise_at),
        "pressure_return_deg": deg(back),
        "pressure_return_at_deg": deg(back_at),
        "convex_radius_m": found.convex_radius[0],
        "convex_radius_at_deg": deg(found.convex_radius[1]),
        "concave_radius_m": found.concave_radius[0],
        "concave_radius_at_deg": deg(found.concave_radius[1]),
    }
    if found.lift_off is not None and found.force_range_n is not None:
        rows["lift_off_rad_s"] = found.lift_off.omega_rad_s
        rows["lift_off_at_deg"] = deg(found.lift_off.phi_rad)
        rows["least_contact_force_n"], rows["largest_contact_force_n"] = found.force_range_n
    for n, (name, peak) in enumerate(zip(RATES, cam.law.peaks(), strict=True), 1):
        rows[f"peak_{name}_{_rate(cam, n)}"] = _finite(peak * found.speed_rad_s**n)
    endless = {name.replace("_m", "_at_deg").replace("_rad_s", "_at_deg") for name, x in
               rows.items() if x == math.inf}  # fmt: skip
    return {name: None if x == math.inf or name in endless else x for name, x in rows.items()}


def segment_rows(found: ExaminedCam) -> Rows:
    """Return the segments of the law, and the peaks of its rates by time at the cam's speed."""
    unit, law, start = unit_of(found.cam), found.cam.law, 0.0
    rows: Rows = []
    for one in law.segments:
        row = {"from_deg": math.degrees(start), "motion": one.kind}
        row |= {"span_deg": math.degrees(one.span_rad), f"lift_{unit}": one.lift}
        start += one.span_rad
        if one.kind not in ("dwell", "table"):
            for n, (name, factor) in enumerate(zip(RATES, peak_factors(one.kind), strict=True), 1):
                rate = (found.speed_rad_s / one.span_rad) ** n
                row[f"{name}_{_rate(found.cam, n)}"] = _finite(factor * abs(one.lift) * rate)
        rows.append(row)
    return rows


def _rate(cam: Cam, order: int) -> str:
    """The unit of a derivative of the lift by time, as in names."""
    return f"{unit_of(cam)}_s{order if order > 1 else ''}"


def _finite(value: float) -> float | str:
    return value if math.isfinite(value) else "infinite"


def factor_rows() -> Rows:
    """Return the peak factors of all laws: rises of unit lift over unit span, between dwells."""
    kinds = [kind for kind in KINDS if kind not in ("dwell", "table")]
    heads = ("c_velocity", "c_acceleration", "c_jerk")
    return [
        {"motion": kind} | dict(zip(heads, map(_finite, peak_factors(kind)), strict=True))
        for kind in kinds
    ]


def jump_rows(law: CamLaw, unit: str) -> Rows:
    """Return the knots where lift, velocity, acceleration or jerk by the cam's angle jump: the
    first of them that does."""
    names = ("lift", *RATES)
    rows: Rows = []
    for one in law.jumps:
        order = next(k for k, step in enumerate(one[1:]) if step)
        rows.append(
            {
                "at_deg": math.degrees(one.angle_rad),
                "jumps": names[order],
                f"by_{unit}_rad{order}": one[1 + order],
            }
        )
    return rows


def continuity(law: CamLaw) -> str:
    """Return the continuity of a law in words."""
    if law.continuous == 3:
        return "lift, velocity, acceleration and jerk are continuous"
    return f"{('lift', *RATES)[law.continuous + 1]} jumps, all before it is continuous"


def show_cam(console: Console, found: ExaminedCam, faults: list[str]) -> None:
    """Print all tables of a cam."""
    for name, value in number_rows(found).items():
        words = "none" if value is None else f"{value:.8g}" if isinstance(value, float) else value
        say(console, f"{name.replace('_', ' '):<28}{words}")
    unit = unit_of(found.cam)
    _show(console, segment_rows(found), f"law, peaks at {found.speed_rad_s:g} rad/s")
    _show(console, jump_rows(found.cam.law, unit)[:20], continuity(found.cam.law))
    _show(console, factor_rows(), "peak factors of a rise of unit lift over unit span")
    say(console, "\n" + "\n".join(faults or ["within all limits that were given"]))


def _show(console: Console, rows: Rows, title: str) -> None:
    say(console, f"\n{title}")
    if rows:
        show_rows(console, rows, list(dict.fromkeys(key for row in rows for key in row)))


def document(name: str, found: ExaminedCam, faults: list[str]) -> Mapping[str, object]:
    """Return all tables as one document for JSON."""
    law, unit = found.cam.law, unit_of(found.cam)
    return {
        "cam": name,
        "numbers": number_rows(found),
        "segments": segment_rows(found),
        "continuity": continuity(law),
        "jumps": jump_rows(law, unit),
        "peak_factors": factor_rows(),
        "exceeded": faults,
    }
