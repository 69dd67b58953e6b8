"""`crankcheck advise`: errors of engines at a frame time, and the sub-steps to a target."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from rich.console import Console

from models.errors import CrankcheckError, listed
from models.files.reading import find_scenes, parse_scene, scene_texts
from models.scene import Scene
from reports.advise import search, table
from reports.advise.advice import Advice, offers, prices, timings
from reports.advise.demand import (
    MeasuredStudy,
    choices,
    demanded,
    evidence,
    stored_choices,
    stored_scenes,
)
from reports.output.console import say_whole, tell
from reports.output.write import Outputs, provenance
from reports.plan.requirements import chosen_engines, chosen_scenes, left_out_note, rigid_alone
from reports.requests.diff import stored_files
from reports.requests.options import Engines, Jobs, argument, option, seconds
from reports.results.lines import lines
from reports.store.reader import Stored, read_store
from reports.workers.progress import progress_bar
from sim.registry import engine

USUAL_SCENES = ("fourbar-lecture-1", "slider-crank-central")
"""Default scenes of the advice: a loop of pins, and a loop with a slider."""


@dataclass(frozen=True)
class AdviseRequest:
    dt_s: Annotated[
        float, option("Frame time of your program, as 1/60.", "--dt SECONDS", parser=seconds)
    ]
    speed: Annotated[float, option("Speed of the driver; clockwise is negative.", "RAD_S")]
    target: Annotated[float, "Error to reach, as a pure number: rad, lengths over L."]
    scenes: Annotated[
        Sequence[str], argument("SCENE", "Shipped names or scene files; default: two common ones.")
    ] = ()
    engines: Engines = ()
    study: Annotated[
        Path | None, option("Folder written by sweep -o, whose runs are used.", "DIR")
    ] = None
    turns: Annotated[float, "Turns of the driver in a run."] = 10.0
    jobs: Jobs = 0
    json: Annotated[Path | None, "Write the result as JSON."] = None

    def run(self, console: Console, progress: Console) -> int:
        """Answer, and return the exit code: 0 where some settings reach the target, 1 where none
        do, 2 where none could be run. Raises CrankcheckError for a faulty request before any
        run."""
        read = [*find_scenes(self.scenes), *stored_files(self.study)]
        outputs = Outputs({"--json": self.json})
        outputs.check(read)
        stored = None
        if self.study is not None:
            stored = read_store(self.study)
            tell(stored.notice)
        scenes, texts = _scenes(self, stored)
        demand = demanded(scenes, self.speed, self.dt_s, self.target, self.turns)
        if note := left_out_note(self.scenes):
            say_whole(progress, note)
        engines = chosen_engines(self.engines)
        every = lines(stored) if stored else ()
        wanted = choices(engines, stored_choices(every))
        known = evidence(stored, every, demand, texts, wanted) if stored else MeasuredStudy()
        with progress_bar(progress, "settings", len(wanted)) as advance:
            found = search.search_all(demand, wanted, known, self.jobs, lambda _: advance())
        if all(one.ended is not None and one.ended.status == "unsupported" for one in found):
            ends = {one.ended.reason: one.choice.label for one in found if one.ended}
            unrun = [f"{label}: {why}" for why, label in ends.items()]
            raise CrankcheckError(listed("advise", unrun))
        with progress_bar(progress, "timings", timings(demand, found)) as advance:
            priced = prices(demand, found, advance)
        facts = provenance({name: engine(name).version() for name in engines})
        named = bool(self.scenes or stored)
        advice = Advice(demand, offers(found, priced), priced.noise, known, facts, named)
        with outputs.written({"--json": lambda: table.document(advice)}):
            table.show_advice(console, advice)
        return 0 if advice.promises else 1


def _scenes(
    request: AdviseRequest, stored: Stored | None
) -> tuple[Sequence[Scene], Mapping[str, str]]:
    """The named scenes, else those of the study, else the usual ones; their texts."""
    if stored is not None and not request.scenes:
        texts = stored_scenes(stored)
        return [parse_scene(text, f"{stored.folder}: {n}") for n, text in texts.items()], texts
    names = request.scenes or USUAL_SCENES
    return chosen_scenes(names, rigid_alone("advise")), scene_texts(names)
