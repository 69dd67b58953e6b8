"""Answering, showing and writing in `solve`: the part that all kinds of scenes share."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, cast, get_args

import numpy as np
from numpy.typing import ArrayLike
from rich.console import Console

from models.array import Array
from models.errors import CrankcheckError
from models.scene import Scene, driver, elastic, laws
from reports.output.console import say_whole
from reports.output.formats import SHEET_ROWS, write_frame
from reports.output.write import check_folder, write
from reports.protocol.way import way_of
from reports.requests.arguments import is_true, one_of, whole_of
from reports.requests.options import SolveOptions, given, name_of
from reports.requests.solution import Solution

if TYPE_CHECKING:
    from analytic.elastic.discretisation import Discretisation
    from analytic.elastic.elastic_motion import ElasticHistory
    from reports.figures.style import FigureSet


MOST_MODES, MOST_ELEMENTS = 20, 12
"""Limits: more modes or elements only take time, as the stiffest of them do not respond."""
STARTS_AS = "quasi-static"
"""Default shape of elastic links at time 0."""


@dataclass(frozen=True)
class ElasticChoice:
    """Options of elastic links, each None by default: so many sines across and along each link, or
    so many elements; the shape at time 0; ``linear`` leaves the shortening of bent links out."""

    modes: int | None = None
    axial_modes: int | None = None
    elements: int | None = None
    shape: str | None = None
    linear: bool = False

    @property
    def options(self) -> list[str]:
        """The given options."""
        values = vars(self) | {"linear": self.linear or None}
        return [name_of(field) for field, value in values.items() if value is not None]

    def refuse_of_rigid(self, scene: Scene) -> None:
        """Refuse options of elastic links for a scene without them. Raises CrankcheckError."""
        for option in self.options:
            raise CrankcheckError(
                f"{option}: {scene.name} has no elastic links; give it a table [elastic.LINK], or "
                f"leave {option} out"
            )

    def discretisation(self, scene: Scene) -> Discretisation:
        """The modes or elements. Raises CrankcheckError for invalid numbers or combinations."""
        from analytic.elastic.discretisation import REFERENCE, Elements, Modes

        usual = Modes()
        gives_way = scene.is_free or isinstance(scene.driver.law, driver.Controlled)
        if self.elements is not None:
            for option, value in (("--modes", self.modes), ("--axial-modes", self.axial_modes)):
                if value is not None:
                    raise CrankcheckError(
                        f"--elements with {option}: a link has elements or modes; give one of them"
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

    def start(self, scene: Scene) -> elastic.Shape:
        """The shape at time 0. Raises CrankcheckError for a periodic shape that can not be."""
        asked = self.shape or scene.start.shape or STARTS_AS
        chosen = cast(elastic.Shape, one_of(asked, "--shape", get_args(elastic.Shape)))
        law = scene.driver.law
        told = isinstance(law, laws.ConstantSpeed | laws.Oscillating) and not isinstance(
            law, driver.Controlled
        )
        if chosen == "periodic" and not told:
            words = "is in free motion" if scene.is_free else "is not periodic"
            raise CrankcheckError(
                f"--shape periodic: the driver of {scene.name} {words}; give it a constant "
                "speed, or --shape quasi-static"
            )
        return chosen

    def motion(self, scene: Scene, until_s: float) -> ElasticHistory:
        """The motion of a scene from 0 to a time [s], for any law of its driver.

        Raises CrankcheckError for invalid options, and for options that the scene does not allow.
        """
        from analytic.elastic.control import elastic_history

        stiffened = not is_true(self.linear, "--linear")
        by, start = self.discretisation(scene), self.start(scene)
        return elastic_history(scene, until_s, by, start, stiffened=stiffened)


def _number(value: object, option: str, most: int) -> int:
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
"""Number of steps beyond which a float does not count them."""
Names = str | Iterable[str] | None
WorkbookExtras = tuple[str, Callable[[Any], None] | None]
"""Extras of a workbook beside its table: their description, and a function that writes them."""


@dataclass(frozen=True)
class Asked:
    """A request for a solution; ``wanted`` are links, points and sliders, None for all of them."""

    time_s: ArrayLike
    wanted: tuple[Names, Names, Names] = (None, None, None)
    choice: ElasticChoice = field(default_factory=ElasticChoice)
    bound: bool = True
    forces: bool = False


class Solving(ABC):
    """Solving of scenes of a kind; free motion and elastic links are solved over time alone."""

    of_links = ""
    """Words on the links of a scene, after its name."""

    @abstractmethod
    def solution(self, scene: Scene, asked: Asked) -> Solution:
        """The answer in Python. Raises CrankcheckError."""

    @abstractmethod
    def refuse(self, scene: Scene, request: SolveOptions) -> None:
        """Refuse a request that the scene does not allow. Raises CrankcheckError."""

    def instants(self, scene: Scene, request: SolveOptions) -> Array:
        """The times of the command's samples [s]. Raises CrankcheckError."""
        return instants_of(scene, request)

    def answer(self, scene: Scene, request: SolveOptions, choice: ElasticChoice) -> Solution:
        """The answer of the command. Raises CrankcheckError."""
        asked = Asked(self.instants(scene, request), choice=choice, forces=request.forces)
        return self.solution(scene, asked)

    @abstractmethod
    def show(self, console: Console, solution: Any, request: SolveOptions) -> None:
        """Print an answer, and where to find more of it."""

    @abstractmethod
    def figures(self) -> FigureSet[Any]:
        """The figures of an answer."""

    @abstractmethod
    def course(self, solution: Any) -> object:
        """The motion that is drawn in the figures of an answer."""

    @abstractmethod
    def page(self, solution: Any) -> tuple[str, str]:
        """The page of an answer, and its description."""

    def more(self, solution: Solution, columns: list[str], request: SolveOptions) -> WorkbookExtras:
        """Extras of a workbook beside the table with these columns."""
        return "", None

    def run(
        self, scene: Scene, request: SolveOptions, choice: ElasticChoice, console: Console
    ) -> None:
        """Show or write the answer. Raises CrankcheckError for a faulty request."""
        self.refuse(scene, request)
        if request.figures is not None:
            check_folder(request.figures, "--figures", self.figures().files)
        solution = self.answer(scene, request, choice)
        if request.output is None and request.figures is None:
            self.show(console, solution, request)
        else:
            say_whole(console, *self._written(solution, request))

    def _written(self, solution: Solution, request: SolveOptions) -> Iterator[str]:
        """Write the requested files; yield a line on each."""
        path, scene = request.output, solution.scene
        if request.figures is not None:
            yield self.figures().written(self.course(solution), request.figures)
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
    """The solving of the scene's kind."""
    return cast(Solving, way_of(scene).part("solving"))


def refuse_samples(request: SolveOptions) -> None:
    """Refuse a number of samples for a page, which has its own. Raises CrankcheckError."""
    for name in given(request, "steps_per_turn", "steps") if is_page(request) else ():
        raise CrankcheckError(f"-o {request.output}: a page has its own samples; leave out {name}")


def is_page(request: SolveOptions) -> bool:
    """True if the output is a page."""
    return request.output is not None and request.output.suffix.lower() == PAGE


def elastic_choice(request: SolveOptions) -> ElasticChoice:
    """The options of elastic links."""
    return ElasticChoice(
        request.modes, request.axial_modes, request.elements, request.shape, request.linear
    )


def refuse_times(scene: Scene, request: SolveOptions) -> None:
    """Refuse options of free motion for a driven scene. Raises CrankcheckError."""
    for option, value in (("--duration", request.duration), ("--steps", request.steps)):
        if value is not None:
            raise CrankcheckError(
                f'{option} {value:g}: {scene.name} is driven, not in free motion (law = "free"); '
                "give --turns and --steps-per-turn"
            )


def instants_of(scene: Scene, request: SolveOptions) -> Array:
    """Times of whole turns, the last sample included [s]. Raises CrankcheckError."""
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
    """Largest number of samples in a file of the output's kind."""
    is_workbook = request.output is not None and request.output.suffix.lower() == WORKBOOK
    return SHEET_ROWS if is_workbook else MOST_SAMPLES
