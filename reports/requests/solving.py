"""How `solve` answers, shows and writes the reference of scenes of a kind: what all kinds share."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast, get_args

import numpy as np
from numpy.typing import ArrayLike
from rich.console import Console

from models.array import Array
from models.errors import CrankcheckError
from models.scene import Scene
from models.scene.driver import Controlled
from models.scene.elastic import Shape
from models.scene.laws import ConstantSpeed, Oscillating
from reports.output.console import say_whole
from reports.output.formats import SHEET_ROWS, write_frame
from reports.output.write import check_folder, write
from reports.requests.arguments import is_true, one_of, whole_of
from reports.requests.options import SolveOptions, given
from reports.requests.solution import Solution
from reports.way.way import way_of

if TYPE_CHECKING:
    from analytic.elastic.discretisation import Discretisation
    from analytic.elastic.elastic_motion import ElasticHistory


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
        from analytic.elastic.control import elastic_history

        stiffened = not is_true(self.linear, "--linear")
        by, start = self.discretisation(scene), self.start(scene)
        return elastic_history(scene, until_s, by, start, stiffened=stiffened)


def _number(value: object, option: str, most: int) -> int:
    """A whole number from 1 to ``most``. Raises CrankcheckError."""
    number = whole_of(value, option)
    if number > most:
        raise CrankcheckError(f"{option} {number}: at most {most}")
    return number


PAGE, WORKBOOK = ".html", ".xlsx"
FAMILY_ENDINGS = (WORKBOOK, PAGE, ".svg", ".pdf")
ON_SCREEN = 12
IN_A_FILE = 360
MOST_SAMPLES = 1_000_000
ENDLESS = 10**15
"""Steps beyond which a float does not count them."""
Names = str | Iterable[str] | None


@dataclass(frozen=True)
class Asked:
    """What is asked of a scene; ``wanted`` are links, points and sliders, None for all of them."""

    time_s: ArrayLike
    wanted: tuple[Names, Names, Names] = (None, None, None)
    choice: ElasticChoice = field(default_factory=ElasticChoice)
    bound: bool = True
    forces: bool = False


class Solving(ABC):
    """How scenes of a kind are solved; of a motion that is let go, or bends, over time alone."""

    of_links = ""
    """What is said of the links of a scene after its name."""

    @abstractmethod
    def solution(self, scene: Scene, asked: Asked) -> Solution:
        """The answer in Python. Raises CrankcheckError."""

    @abstractmethod
    def refuse(self, scene: Scene, request: SolveOptions) -> None:
        """Refuse what can not be asked of the scene. Raises CrankcheckError."""

    @abstractmethod
    def figure_files(self) -> Sequence[str]:
        """The names of the figures."""

    def instants(self, scene: Scene, request: SolveOptions) -> Array:
        """The times that the command has samples at [s]. Raises CrankcheckError."""
        return instants_of(scene, request)

    def answer(self, scene: Scene, request: SolveOptions, choice: ElasticChoice) -> Solution:
        """The answer of the command. Raises CrankcheckError."""
        asked = Asked(self.instants(scene, request), choice=choice, forces=request.forces)
        return self.solution(scene, asked)

    @abstractmethod
    def show(self, console: Console, solution: Any, request: SolveOptions) -> None:
        """Print an answer, and where there is more of it."""

    @abstractmethod
    def drawn(self, solution: Any, folder: Path) -> str:
        """Draw figures into a folder; returns what was written."""

    @abstractmethod
    def page(self, solution: Any) -> tuple[str, str]:
        """The page of an answer, and what it is."""

    def more(
        self, solution: Solution, columns: list[str], request: SolveOptions
    ) -> tuple[str, Callable[[Any], None] | None]:
        """What a workbook has beside the table, in words and as what puts it there."""
        return "", None

    def run(
        self, scene: Scene, request: SolveOptions, choice: ElasticChoice, console: Console
    ) -> None:
        """Show or write. Raises CrankcheckError for what can not be asked."""
        self.refuse(scene, request)
        if request.figures is not None:
            check_folder(request.figures, "--figures", self.figure_files())
        solution = self.answer(scene, request, choice)
        if request.output is None and request.figures is None:
            self.show(console, solution, request)
        else:
            say_whole(console, *self._written(solution, request))

    def _written(self, solution: Solution, request: SolveOptions) -> Iterator[str]:
        """Write what was asked for; what that is, a line each."""
        path, scene = request.output, solution.scene
        if request.figures is not None:
            yield self.drawn(solution, request.figures)
        if path is not None and is_page(request):
            page, words = self.page(solution)
            write(path, page)
            yield f"{path}: {words}"
        elif path is not None:
            frame, more, told = solution.frame(), None, ""
            if path.suffix.lower() == WORKBOOK:
                told, more = self.more(solution, list(frame.columns), request)
            origin = {"scene": scene.name, "source": scene.source}
            write_frame(path, frame, "motion", origin, more)
            yield f"{path}: {solution.time_s.size} samples of {scene.name}{self.of_links}{told}"


def solving_of(scene: Scene) -> Solving:
    """How a scene is solved."""
    return cast(Solving, way_of(scene).part("solving"))


def refuse_samples(request: SolveOptions) -> None:
    """Refuse samples of a page of a motion, which has its own. Raises CrankcheckError."""
    for name in given(request, "steps_per_turn", "steps") if is_page(request) else ():
        raise CrankcheckError(f"-o {request.output}: a page has its own samples; leave out {name}")


def is_page(request: SolveOptions) -> bool:
    """Whether a page is to be written."""
    return request.output is not None and request.output.suffix.lower() == PAGE


def elastic_choice(request: SolveOptions) -> ElasticChoice:
    """What was asked for of elastic links."""
    return ElasticChoice(
        request.modes, request.axial_modes, request.elements, request.shape, request.linear
    )


def refuse_times(scene: Scene, request: SolveOptions) -> None:
    """Refuse what is asked of free motion alone, of a scene that is driven. Raises
    CrankcheckError."""
    for option, value in (("--duration", request.duration), ("--steps", request.steps)):
        if value is not None:
            raise CrankcheckError(
                f'{option} {value:g}: {scene.name} is driven, and not let go (law = "free"); give '
                "--turns and --steps-per-turn"
            )


def instants_of(scene: Scene, request: SolveOptions) -> Array:
    """Those of whole turns, the last sample included [s]. Raises CrankcheckError."""
    turns = 1.0 if request.turns is None else request.turns
    steps = request.steps_per_turn
    if steps is None:
        steps = ON_SCREEN if request.output is None else IN_A_FILE
    if not (math.isfinite(turns) and turns > 0.0):
        raise CrankcheckError(f"--turns {turns:g}: give a number above 0; 1 is one period")
    if steps < 1:
        raise CrankcheckError(f"--steps-per-turn {steps}: give at least 1")
    most = most_samples(request)
    steps = min(steps, ENDLESS)
    last = turns * steps * (1 - 1e-12)  # may be infinite
    if not last <= most - 1:
        raise CrankcheckError(
            f"--turns {turns:g} --steps-per-turn {steps}: {last + 1:.7g} samples; at most {most}: "
            "take fewer turns, or fewer steps in a turn"
        )
    samples = math.ceil(last) + 1
    step_s = scene.driver.law.period_s / steps
    return step_s * np.arange(samples, dtype=np.float64)


def most_samples(request: SolveOptions) -> int:
    """That a file of its kind has room for."""
    is_workbook = request.output is not None and request.output.suffix.lower() == WORKBOOK
    return SHEET_ROWS if is_workbook else MOST_SAMPLES
