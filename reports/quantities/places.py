"""Position and motion of a mechanism: its crank, links, sliders and points, the gaps of its joints,
and the rates, as the engine reports them and by differencing the positions."""

from dataclasses import replace

import numpy as np

from models.motion import Motion
from models.scene import Scene
from models.scene.driver import driver_place
from models.scene.joints import joints
from reports.quantities import quantity

EPSILON = float(np.finfo(np.float64).eps)
WITHIN_A_STEP = quantity.Tolerance(
    "A step moves the pins along tangents, which leaves a gap of step^2/2 times the curvature "
    "to close; a dyad enlarges it by 1/sine of its transmission angle. To close it an engine "
    "moves its bodies by the jolt times step^2; twice that if it is larger.",
    cap=2e-2,  # about a degree; ten times the worst at 180 steps a turn
    coefficient=1.0,
    power=1.0,
    conditioned=True,
    closes=True,
)


FREE_PLACE = quantity.Tolerance(
    "That of the phase, times the rates of the places, and the gap of a step.",
    cap=0.1,
    coefficient=9.0,
    power=1.0,
    lasting=1.8,
    drifting=1.0,
    opening=0.7,
)


def _commanded(scene: Scene, reference: Motion) -> quantity.Series:
    """Return its angle; for a slider its displacement over the longest length."""
    commanded = scene.driver.law.at(reference.time_s)[0]
    return {scene.driver.name: commanded / scene.driver_arm_m}


def driver_series(scene: Scene, motion: Motion | None) -> quantity.Series:
    """Return the coordinate of the driver, that of a slider over the longest length."""
    course = driver_place(scene, motion) if motion else None
    return {} if course is None else {scene.driver.name: course / scene.driver_arm_m}


DRIVE = quantity.Quantity(
    name="drive",
    role="drive",
    measures=(
        quantity.Measure(
            body_kind="driver",
            column="drive_error_rad",
            unit="rad",
            share="rad",
            scale=lambda scene, reference: 1.0,
            truth=_commanded,
            logged=lambda scene, run: driver_series(scene, run.motion),
            bound=lambda scene, reference: {
                n: 2 * EPSILON * np.abs(each) for n, each in _commanded(scene, reference).items()
            },
        ),
    ),
    criteria=(
        quantity.Criterion(
            "CC102",
            "drive",
            "Everything is compared at the commanded time: a crank that lags or leads spoils "
            "every other number.",
            "Drive with --drive prescribed; a servo needs a higher gain, or a shorter step.",
            short="drive",
            diagram="drive: the crank's angle",
            tolerance=quantity.Tolerance(
                "A prescribed drive leaves the rounding of an angle summed step by step, and room "
                "for a flywheel that the mechanism slows by a part in 1e12.",
                floor=1e-9,
            ),
        ),
    ),
)


def _place(
    name: str,
    measure: quantity.Measure,
    head: str,
    rule: str,
    short: str,
    explanation: str,
    cure: str,
) -> quantity.Quantity:
    """Return a quantity of the positions of one kind of bodies; its rule has its name."""
    criterion = quantity.Criterion(
        rule, name, explanation, cure, short, WITHIN_A_STEP, free_motion=FREE_PLACE
    )
    return quantity.Quantity(name, "place", (measure,), (criterion,), head)


ANGLE = _place(
    "angle",
    quantity.moving("link", 0, "angle_error_rad"),
    "angle\nrad",
    "CC103",
    "ang",
    "The angle of every link but the driver against the closed form at the commanded time.",
    "Shorten the step (--steps-per-turn); if the error at the logged crank angle is small, change "
    "the drive.",
)
DISPLACEMENT = _place(
    "displacement",
    quantity.moving("slider", 0, "displacement_error_m"),
    "place\n/ L",
    "CC104",
    "disp",
    "The displacement of every slider along its line against the closed form.",
    "Shorten the step (--steps-per-turn).",
)
POSITION = _place(
    "position",
    quantity.moving("point", 0, "position_error_m"),
    "place\n/ L",
    "CC113",
    "pos",
    "The place of every named point against the closed form.",
    "Shorten the step (--steps-per-turn).",
)


def _gap(kind: quantity.BodyKind, column: str) -> quantity.Measure:
    """Return the measure of the gap at a shared pin or slider, or of gears or a cam; the reference
    has none."""

    def truth(scene: Scene, reference: Motion) -> quantity.Series:
        every = {"slider": scene.sliders, "gear": scene.gears, "cam": scene.cams}
        pins = [pin.point for pin in joints(scene).pins if pin.point not in scene.sliders]
        return dict.fromkeys(every.get(kind, pins), np.zeros_like(reference.time_s))

    return quantity.Measure(
        body_kind=kind,
        column=column,
        unit="m",
        share="L",
        scale=lambda scene, _: scene.longest_m,
        truth=truth,
        logged=lambda _, run: run.gaps,
    )


GAP = quantity.Quantity(
    name="gap",
    role="closure",
    head="gap\n/ L",
    measures=(
        _gap("point", "pin_gap_m"),
        _gap("slider", "slider_gap_m"),
        _gap("gear", "gear_slip_m"),
        _gap("cam", "cam_gap_m"),
    ),
    criteria=(
        quantity.Criterion(
            "CC105",
            "pin gap",
            "Two bodies that share a pin or a slider must not come apart: an open loop is "
            "another mechanism, however well the crank turns.",
            "Stiffen the joint (settings of the engine), or shorten the step.",
            short="gap",
            diagram="closure: the widest gap",
            tolerance=replace(
                WITHIN_A_STEP,
                reason="The gap of a step, step^2/2 times the curvature, or the jolt that closes "
                "it, if that is larger.",
                conditioned=False,
            ),
            free_motion=replace(WITHIN_A_STEP, conditioned=False),
        ),
    ),
)


OPEN_SHARE = 1e-3
"""Ten times the open share of an acceleration at MuJoCo's stiffest documented impedance, 0.9999."""
LOAD_SHARE = 5e-3
"""Twice the observed response of MuJoCo's tuned constraints, of three steps' time constant, to the
change of loads on their bodies from step to step: 0.7e-3 to 2.5e-3, at 90 to 1440 steps a turn."""
SECOND_ORDER = quantity.Tolerance(
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
TWICE_DERIVED = quantity.Tolerance(
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
FREE_RATE = quantity.Tolerance(
    "That of the phase, times the rates of the velocities.",
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
VELOCITY = quantity.Quantity(
    name="velocity",
    role="derived",
    head="veloc.\n/ w",
    measures=(
        quantity.moving("link", 1, "angular_velocity_error_rad_s"),
        quantity.moving("slider", 1, "slider_speed_error_m_s"),
        quantity.moving("point", 1, "velocity_error_m_s"),
    ),
    instants=lambda run: run.velocity_time_s,
    criteria=(
        quantity.Criterion(
            "CC106",
            "velocity, reported",
            "The velocities that the engine reports, against the closed form at their own instants "
            "(some engines log them half a step away from the positions).",
            "Use the differenced velocities, or shorten the step.",
            short="vel",
            diagram="velocity, as reported",
            tolerance=SECOND_ORDER,
            free_motion=FREE_RATE,
        ),
        quantity.Criterion(
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
ACCELERATION = quantity.Quantity(
    name="acceleration",
    role="derived",
    head="accel.\n/ w^2",
    measures=(
        quantity.moving("link", 2, "angular_acceleration_error_rad_s2"),
        quantity.moving("slider", 2, "slider_acceleration_error_m_s2"),
        quantity.moving("point", 2, "acceleration_error_m_s2"),
    ),
    instants=lambda run: run.acceleration_time_s,
    silent=lambda run: not run.reports_accelerations,
    criteria=(
        quantity.Criterion(
            "CC108",
            "acceleration, reported",
            "The accelerations that the engine reports, against the closed form at their own "
            "instants; an engine that reports none is not judged.",
            "Use an integrator of higher order, if the engine has one, or shorten the step.",
            short="acc",
            diagram="acceleration, as reported",
            tolerance=TWICE_DERIVED,
        ),
        quantity.Criterion(
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
