"""Velocities and accelerations, as the engine reports them and by differencing the places."""

from __future__ import annotations

from dataclasses import replace

from reports.quantities.moving import moving
from reports.quantities.quantity import Criterion, Quantity, Tolerance

OPEN_SHARE = 1e-3
"""Ten times what MuJoCo's stiffest documented impedance (0.9999) leaves of an acceleration."""
LOAD_SHARE = 5e-3
"""Twice what MuJoCo's tuned constraints, of three steps' time constant, were seen to make of what
loads shake their bodies by from step to step: 0.7e-3 to 2.5e-3, at 90 to 1440 steps a turn."""
SECOND_ORDER = Tolerance(
    "Second order, with the third derivative of the motion, about curvature^1.5; as reported, "
    "with the share of an acceleration that soft constraints keep open, over a step.",
    cap=5e-2,  # a twentieth of the driver's speed; twice the worst at 90 steps a turn
    coefficient=3.0,
    power=1.5,
    conditioned=True,
    share=OPEN_SHARE,
    share_order=1,
    load_share=LOAD_SHARE,
    rate=1,
    jump=1.0,
)
TWICE_DERIVED = Tolerance(
    "Second order, with the fourth derivative of the motion, about curvature^2; as reported, "
    "engines with soft constraints keep a share of it open at every step.",
    cap=0.5,  # twice the worst at 90 steps a turn, where second differences are coarse
    coefficient=10.0,
    power=2.0,
    conditioned=True,
    share=OPEN_SHARE,
    load_share=LOAD_SHARE,
    rate=2,
    parts=True,
)
FREE_RATE = Tolerance(
    "As the phase, which the mechanism passes on to its velocities as their rates say.",
    cap=0.2,
    coefficient=14.0,
    power=1.5,
    lasting=1.8,
    drifting=1.0,
    opening=0.7,
    share=OPEN_SHARE,
    share_order=1,
    rate=1,
    jump=1.0,
)
VELOCITY = Quantity(
    name="velocity",
    role="derived",
    head="veloc.\n/ w",
    measures=(
        moving("link", 1, "angular_velocity_error_rad_s"),
        moving("slider", 1, "slider_speed_error_m_s"),
        moving("point", 1, "velocity_error_m_s"),
    ),
    instants=lambda run: run.velocity_time_s,
    criteria=(
        Criterion(
            "CC106",
            "velocity, reported",
            "The velocities that the engine reports, against the closed form at the instants "
            "that they belong to (some engines log them half a step away from the positions).",
            "Use the differenced velocities, or shorten the step.",
            short="vel",
            diagram="velocity, as reported",
            tolerance=SECOND_ORDER,
            free_motion=FREE_RATE,
        ),
        Criterion(
            "CC107",
            "velocity, differenced",
            "The error of the velocities that central differences of the logged positions give.",
            "Shorten the step; an error of the position that jumps from step to step shows here "
            "first.",
            short="vel'",
            diagram="velocity, from logged places",
            tolerance=replace(
                SECOND_ORDER,
                reason="Second order, with the third derivative of the motion, about "
                "curvature^1.5.",
                share=0.0,
                differenced=1,
                jump=0.5,
            ),
        ),
    ),
)
ACCELERATION = Quantity(
    name="acceleration",
    role="derived",
    head="accel.\n/ w^2",
    measures=(
        moving("link", 2, "angular_acceleration_error_rad_s2"),
        moving("slider", 2, "slider_acceleration_error_m_s2"),
        moving("point", 2, "acceleration_error_m_s2"),
    ),
    instants=lambda run: run.acceleration_time_s,
    silent=lambda run: not run.reports_accelerations,
    criteria=(
        Criterion(
            "CC108",
            "acceleration, reported",
            "The accelerations that the engine reports, against the closed form at the instants "
            "that they belong to; an engine that reports none is not judged.",
            "Use an integrator of higher order (MuJoCo: RK4), or shorten the step.",
            short="acc",
            diagram="acceleration, as reported",
            tolerance=TWICE_DERIVED,
        ),
        Criterion(
            "CC114",
            "acceleration, differenced",
            "The error of the accelerations that second differences of the logged positions give.",
            "Shorten the step; noise grows with 1/dt^2 and is part of the limit.",
            short="acc'",
            tolerance=replace(
                TWICE_DERIVED,
                reason="Second order, with the fourth derivative of the motion, about curvature^2.",
                share=0.0,
                differenced=2,
                jump=1.0,
                parts=False,
            ),
        ),
    ),
)
