"""Pairs of bodies as engines join them: the hinges of pins, the lines of sliders, the ends of
springs; and refusals of bodies and loads that more than one engine cannot hold."""

from collections.abc import Iterator
from dataclasses import dataclass

from models.errors import EngineError
from models.scene import Scene, loads
from models.scene.joints import (
    End,
    Prism,
    Slot,
    block_name,
    joined_at,
    joints,
    line_ends,
    local_point,
    mass_of,
    riding_body,
)


@dataclass(frozen=True)
class Hinge:
    """Two bodies that share a point, as an engine joins them."""

    point: str
    first: str
    other: str


def hinges(scene: Scene, *firm: str) -> Iterator[Hinge]:
    """Yield the hinges of each pin: of its firmest body, in the order of ``firm``, with the others,
    one less than it has bodies."""
    for pin in joints(scene).pins:
        first, *others = sorted(pin.bodies, key=lambda name: (*firm, name).index(name))
        for other in others:
            yield Hinge(pin.point, first, other)


def joint_count(scene: Scene) -> int:
    """Return the number of hinges and slides."""
    return len([*hinges(scene)]) + len(joints(scene).slides)


def slide_of(scene: Scene, slider: str) -> Prism | Slot:
    """Return the joint of a slider."""
    return next(slide for slide in joints(scene).slides if slide.slider.name == slider)


def block_guides(scene: Scene) -> dict[str, str]:
    """Return the guide of each block without mass, which turns with it, by the block's name."""
    return {block_name(slot.slider): slot.slider.on for slot in joints(scene).slots}


@dataclass(frozen=True)
class RubbingJoint:
    """Constant friction: a couple [N m] between the two bodies of a pin, of which none is a block
    without mass, or a force [N] between the guide and the sliding body of a slider."""

    joint: str
    first: str
    second: str
    size: float


def rubbing_joints(scene: Scene, *, sliders: bool) -> Iterator[RubbingJoint]:
    """Yield the pins with constant friction, and the ``sliders``. Raises EngineError for a pin
    without exactly two bodies."""
    guides = block_guides(scene)
    for joint, law in scene.friction.items():
        slides = joint in scene.sliders
        if not isinstance(law, loads.ConstantFriction) or (slides and not sliders):
            continue
        if slides:
            slide = slide_of(scene, joint)
            yield RubbingJoint(joint, slide.slider.on, riding_body(slide), law.size)
            continue
        names = joined_at(scene).get(joint, ())
        if len(names) != 2:
            raise EngineError(
                f"{scene.name}: friction.{joint}: {len(names)} bodies meet there, and two rub on "
                "one another; use a pin of two, or a slider"
            )
        first, second = (guides.get(name, name) for name in names)
        yield RubbingJoint(joint, first, second, law.size)


def spring_ends(scene: Scene, spring: loads.Spring) -> tuple[End, End]:
    """Return the two bodies of a spring with the places on them [m]: its two points, the two copies
    of its pin, or a place of the line on the guide and the sliding point."""
    if isinstance(spring, loads.LineSpring):
        return line_ends(scene, spring)
    if isinstance(spring, loads.PinSpring):
        first, second = ((body, local_point(scene, body, spring.point)) for body in spring.bodies)
        return first, second
    slide = slide_of(scene, spring.slider)
    slider, rider = slide.slider, riding_body(slide)
    return (slider.on, slider.through_m), (rider, local_point(scene, rider, slider.point))


def refuse_driver_angle(scene: Scene, engine: str) -> None:
    """Refuse loads over the angle of a driver that is no crank. Raises EngineError."""
    driver = scene.driver
    if not driver.is_crank and any(load.over == "angle" for load in scene.loads.values()):
        raise EngineError(
            f"{scene.name}: a load follows the driver's angle, which {engine} gets only of a "
            f"crank; this driver is {driver.joint}"
        )


def refuse_pin_friction(scene: Scene, engine: str) -> None:
    """Refuse friction in pins. Raises EngineError."""
    if names := ", ".join(f"friction.{n}" for n in scene.friction if n not in scene.sliders):
        raise EngineError(
            f"{scene.name}: {names}: friction in pins of {engine} is not offered by crankcheck; "
            "remove it"
        )


def refuse_massless(scene: Scene, engine: str, body: str, *, turns: bool) -> None:
    """Refuse a body that a force would move at no cost. Raises EngineError."""
    mass, inertia = mass_of(scene, body)
    if mass <= 0.0 or (inertia <= 0.0 and turns):
        raise EngineError(
            f"{scene.name}: {body}: mass_kg {mass:g}, inertia_kg_m2 {inertia:g}; {engine} moves no "
            "body without both, give them"
        )
