"""How elastic links are to be described and started, as a user says it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, cast, get_args

from models.controlled import Controlled
from models.elastic import Shape
from models.errors import CrankcheckError
from models.laws import ConstantSpeed, Oscillating
from models.scene import Scene
from reports.requests.arguments import is_true, one_of, whole_of

if TYPE_CHECKING:  # a third of a second: not for scenes with rigid links
    from analytic.elastic.discretisation import Discretisation
    from analytic.elastic.sampled import ElasticHistory

MOST_MODES, MOST_ELEMENTS = 20, 12
"""More change nothing but the time that they take: the stiffest of them follow nothing."""
STARTS_AS = "quasi-static"
"""What a scene starts with that does not say."""


@dataclass(frozen=True)
class ElasticChoice:
    """What was asked for, each None where it was not: so many sines across and along each link, or
    so many elements; the shape at time 0; ``linear`` leaves the shortening of bent links out."""

    modes: int | None = None
    axial_modes: int | None = None
    elements: int | None = None
    shape: str | None = None
    linear: bool = False

    @property
    def options(self) -> list[str]:
        """Those that were given."""
        given = {
            "--modes": self.modes,
            "--axial-modes": self.axial_modes,
            "--elements": self.elements,
            "--shape": self.shape,
            "--linear": self.linear or None,
        }
        return [name for name, value in given.items() if value is not None]

    def refuse_of_rigid(self, scene: Scene) -> None:
        """Raises CrankcheckError where anything was asked for of a scene without elastic links."""
        for option in self.options:
            raise CrankcheckError(
                f"{option}: {scene.name} has no elastic links; give it a table [elastic.LINK], or "
                f"leave {option} out"
            )

    def discretisation(self, scene: Scene) -> Discretisation:
        """Raises CrankcheckError for numbers that are none, and for those that go together."""
        from analytic.elastic.discretisation import REFERENCE, Elements, Modes

        usual = Modes()
        gives_way = scene.is_free or isinstance(scene.driver.law, Controlled)
        if self.elements is not None:
            for option, value in (("--modes", self.modes), ("--axial-modes", self.axial_modes)):
                if value is not None:
                    raise CrankcheckError(
                        f"--elements with {option}: a link is described by elements or by modes; "
                        "give one of them"
                    )
            return Elements(_number(self.elements, "--elements", MOST_ELEMENTS))
        links = scene.elastic.values()
        for option, value, kind in (
            ("--modes", self.modes, "bends"),
            ("--axial-modes", self.axial_modes, "stretches"),
        ):
            if value is not None and not any(getattr(each, kind) for each in links):
                raise CrankcheckError(
                    f"{option} {value}: no elastic link of {scene.name} {kind}; give one "
                    f"{kind} = true, or leave {option} out"
                )
        if self.modes is None and self.axial_modes is None and not gives_way:
            return REFERENCE
        return Modes(
            usual.across if self.modes is None else _number(self.modes, "--modes", MOST_MODES),
            usual.along
            if self.axial_modes is None
            else _number(self.axial_modes, "--axial-modes", MOST_MODES),
        )

    def start(self, scene: Scene) -> Shape:
        """The shape at time 0. Raises CrankcheckError for a periodic motion of what is not."""
        asked = self.shape or scene.start.shape or STARTS_AS
        chosen = cast(Shape, one_of(asked, "--shape", get_args(Shape)))
        law = scene.driver.law
        told = isinstance(law, ConstantSpeed | Oscillating) and not isinstance(law, Controlled)
        if chosen == "periodic" and not told:
            words = "is let go" if scene.is_free else "does not come back after a period"
            raise CrankcheckError(
                f"--shape periodic: the driver of {scene.name} {words}; give it a constant "
                "speed, or --shape quasi-static"
            )
        return chosen

    def motion(self, scene: Scene, until_s: float) -> ElasticHistory:
        """The motion of a scene from 0 to a time [s], whatever its driver does.

        Raises CrankcheckError for what can not be asked, and what it does not allow.
        """
        from analytic.elastic.elastic_history import elastic_history

        stiffened = not is_true(self.linear, "--linear")
        by, start = self.discretisation(scene), self.start(scene)
        return elastic_history(scene, until_s, by, start, stiffened=stiffened)


def _number(value: object, option: str, most: int) -> int:
    """A whole number from 1 to ``most``. Raises CrankcheckError."""
    number = whole_of(value, option)
    if number > most:
        raise CrankcheckError(f"{option} {number}: at most {most}")
    return number
