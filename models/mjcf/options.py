"""Options of the MJCF text of a scene, and the drive of its crank."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from xml.sax.saxutils import quoteattr

from models.scene import Scene
from models.scene.joints import inertia_scale
from models.scene.laws import ConstantSpeed

FLYWHEEL_RATIO = 1e12
"""Armature of the driven joint over the inertia scale of the scene."""
AttributeValue = str | float | int | Sequence[float]
Attributes = Mapping[str, AttributeValue]


@dataclass(frozen=True)
class Writing:
    """Options of the text; missing ones are MuJoCo's own defaults.

    ``option`` and ``flag`` are attributes of the elements of that name, ``connect`` of every
    ``equality/connect``, ``rubbing`` of friction in joints, if different. ``servo_gain`` [N m
    s/rad] replaces the flywheel by a velocity servo; a ``free`` crank has neither. The keyframe's
    velocities belong to ``delay_s`` after its positions.
    """

    close: str | tuple[str, ...] = ()
    option: Attributes = field(default_factory=dict)
    flag: Attributes = field(default_factory=dict)
    connect: Attributes = field(default_factory=dict)
    rubbing: Attributes = field(default_factory=dict)
    flywheel_ratio: float = FLYWHEEL_RATIO
    servo_gain: float | None = None
    delay_s: float = 0.0
    free: bool = False

    @property
    def flywheel(self) -> bool:
        """True if a flywheel prescribes the speed of the crank."""
        return self.servo_gain is None and not self.free


STIFF_STEPS, STIFF_DAMPING = 5.0, 0.6
"""Time constant of the loop closures in steps, and their damping ratio. Their product sets the
stiffness of the closing spring: at 2, the least that MuJoCo allows, RK4 resolves it badly, above 4
it yields more. Searches over several scenes (`crankcheck tune`) lead to about 3; against 4 and 1
the worst shipped scene has 1.6 times less error, and 3 times less in accelerations."""
STIFF_IMPEDANCE = 0.9999
"""Largest impedance in MuJoCo: the loop closures yield by 0.01 %."""
TOLERANCE = 1e-22
"""Tolerance of the solver, over the flywheel's ratio: MuJoCo scales its stopping rule by the
inertia of the whole model, and by default stops before the first iteration, with open loops."""
STEPS_PER_PERIOD = 1000
FREE_STEP_S = 1e-3
"""Largest step of free motion, which has no period [s]."""


def exact(scene: Scene, steps: float = STEPS_PER_PERIOD) -> Writing:
    """Return RK4 with ``steps`` per period of the driver, or per duration of free motion with a
    millisecond at most; the loops are as stiff as that step allows."""
    dt_s = scene.driver.law.period_s / steps
    tolerance = TOLERANCE / FLYWHEEL_RATIO
    if scene.is_free:
        dt_s, tolerance = min(dt_s, FREE_STEP_S), TOLERANCE
    return Writing(
        option={"timestep": dt_s, "integrator": "RK4", "tolerance": tolerance},
        connect={
            "solref": (STIFF_STEPS * dt_s, STIFF_DAMPING),
            "solimp": (STIFF_IMPEDANCE, STIFF_IMPEDANCE, 0.001, 0.5, 2.0),
        },
        free=scene.is_free,
    )


def has_control(scene: Scene, writing: Writing) -> bool:
    """True if the model has an actuator with a control at each step."""
    if not writing.flywheel:
        return not writing.free
    return not isinstance(scene.driver.law, ConstantSpeed)


def armature(scene: Scene, writing: Writing) -> float:
    """Return the inertia of the flywheel on the crank [kg m^2], or mass on a slider [kg]; 0 for
    none."""
    if not writing.flywheel:
        return 0.0
    return writing.flywheel_ratio * inertia_scale(scene) / scene.driver_arm_m**2


AttributeRow = dict[str, AttributeValue]


def attributes(row: Attributes) -> str:
    """Write attributes of an element; numbers in the shortest form of the same double."""
    return "".join(f" {name}={quoteattr(_text(value))}" for name, value in row.items())


def _text(value: AttributeValue) -> str:
    if isinstance(value, str):
        return value
    if isinstance(value, int | float):
        return repr(value if isinstance(value, int) else float(value) + 0.0)
    return " ".join(_text(number) for number in value)


def commentable(text: str) -> str:
    """Return text for an XML comment, where two hyphens would end it."""
    return text.replace("--", "- -").replace("--", "- -")
