"""A motion, or the log of a run, as a pandas frame with units in the column names.

``C_rod_fx_n`` is the force of pin C on the rod [N], along x; ``C_rod_f_n`` its size.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from models.array import Array
from models.motion import BodyMotion, Forces, Motion
from sim.engine import Run

if TYPE_CHECKING:
    import pandas as pd


def motion_frame(motion: Motion, *, lengths: bool = True) -> pd.DataFrame:
    """One row per sample: each link, point and slider with its rates, vectors also by length; how
    elastic links are bent in their middle and stretched; and the forces, where there are any
    (`reports.describe.frame`)."""
    import pandas as pd

    columns: dict[str, object] = {"time_s": motion.time_s}
    for name, link in motion.links.items():
        columns[f"{name}_theta_rad"] = link.theta
        columns[f"{name}_omega_rad_s"] = link.omega
        columns[f"{name}_alpha_rad_s2"] = link.alpha
    for name, point in motion.points.items():
        for symbol, vectors, unit in (
            ("", point.position, "m"),
            ("v", point.velocity, "m_s"),
            ("a", point.acceleration, "m_s2"),
        ):
            columns[f"{name}_{symbol}x_{unit}"] = vectors[:, 0]
            columns[f"{name}_{symbol}y_{unit}"] = vectors[:, 1]
            if symbol and lengths:
                columns[f"{name}_{symbol}_{unit}"] = np.hypot(vectors[:, 0], vectors[:, 1])
    for name, slider in motion.sliders.items():
        columns[f"{name}_slider_displacement_m"] = slider.displacement
        columns[f"{name}_slider_speed_m_s"] = slider.speed
        columns[f"{name}_slider_acceleration_m_s2"] = slider.acceleration
    for name, shape in motion.elastic.items():
        columns[f"{name}_deflection_m"] = shape.middle
        columns[f"{name}_extension_m"] = shape.extension
    if motion.forces is not None:
        columns |= force_columns(motion.forces, lengths=lengths)
    return pd.DataFrame(columns)


def run_frame(run: Run) -> pd.DataFrame:
    """What a run logged, one row per sample, no rows where it logged nothing.

    As `motion_frame`, but for lengths of vectors, and how far each pin and slider is open. The
    instants that velocities and accelerations belong to stand beside those of the places where they
    are others. What the engine does not report is left out.
    """
    if run.motion is None:
        import pandas as pd

        return pd.DataFrame({"time_s": np.zeros(0)})
    frame = motion_frame(run.motion, lengths=False)
    for name, gap_m in run.gaps.items():
        frame[f"{name}_gap_m"] = gap_m
    frame = frame.dropna(axis="columns", how="all")
    instants = {"velocity_time_s": run.velocity_time_s}
    if run.reports_accelerations:
        instants["acceleration_time_s"] = run.acceleration_time_s
    if run.motion.forces is not None:
        instants["force_time_s"] = run.motion.forces.time_s
    others = {
        name: time_s
        for name, time_s in instants.items()
        if time_s is not None and np.any(time_s != run.motion.time_s)
    }
    for place, (name, time_s) in enumerate(others.items(), 1):
        frame.insert(place, name, time_s)
    return frame


def cleaned(motion: Motion) -> Motion:
    """The motion to be read by people: numbers that are 0 within their own bound are 0, and those
    without a bound, of which nothing is known, NaN."""
    if motion.bound is None:
        return motion
    links, points, sliders = motion.bound.links, motion.bound.points, motion.bound.sliders
    return replace(
        motion,
        links={n: _cleaned(m, links[n]) for n, m in motion.links.items()},
        points={n: _cleaned(m, points[n]) for n, m in motion.points.items()},
        sliders={n: _cleaned(m, sliders[n]) for n, m in motion.sliders.items()},
    )


def _cleaned(body: BodyMotion, bound: BodyMotion) -> BodyMotion:
    """One body's arrays; a bound is per sample, also for vectors."""
    fields = {}
    for name, values in vars(body).items():
        limit = vars(bound)[name]
        shown = np.where(np.abs(values.T) <= limit, 0.0, values.T)
        fields[name] = np.where(np.isfinite(limit), shown, np.nan).T
    return type(body)(**fields)


def acted_on(acting: Forces) -> Iterator[tuple[str, str, str, Array]]:
    """Each pin, the body whose force is told, from what, and that force [N], (T, 2).

    Where two bodies meet, it is the one on the second, from the first; of more, it is that on each,
    from the pin.
    """
    for point, bodies in acting.pins.items():
        names = list(bodies)
        told = names[1:] if len(names) == 2 else names
        for name in told:
            yield point, name, names[0] if len(names) == 2 else "pin", bodies[name]


def force_columns(acting: Forces, *, lengths: bool = True) -> dict[str, Array]:
    """Columns by name: the driving torque or force, pins by point and body, sliders, and
    what rubs; vectors also by length."""
    columns = {"torque_n_m" if acting.drive_unit == "N m" else "drive_force_n": acting.torque}
    for point, body, _, force in acted_on(acting):
        stem = f"{point}_{body.replace(' ', '_')}"
        columns[f"{stem}_fx_n"], columns[f"{stem}_fy_n"] = force[:, 0], force[:, 1]
        if lengths:
            columns[f"{stem}_f_n"] = np.hypot(force[:, 0], force[:, 1])
    for name, slider in acting.sliders.items():
        columns[f"{name}_slider_normal_n"] = slider.normal
        columns[f"{name}_slider_moment_n_m"] = slider.moment
    for joint, series in acting.friction.items():
        is_slider = joint in acting.sliders
        columns[f"{joint}_slider_friction_n" if is_slider else f"{joint}_friction_n_m"] = series
    return columns
