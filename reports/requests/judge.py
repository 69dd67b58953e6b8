"""`judge`: a log of the user's own, or a run, compared with the closed form; and its files."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, overload

from rich.console import Console

from analytic.cams.outline import outlined
from analytic.free.free_motion import loosened
from models.errors import CrankcheckError
from models.files.inputs import names_in
from models.files.reading import find_scene, load_scene
from models.scene import Scene
from reports.judge import known, tolerance
from reports.logs.map_file import Map, read_map
from reports.output.console import say_whole
from reports.output.formats import junit
from reports.output.numbers import finite
from reports.output.printed import present
from reports.output.write import Outputs, check_file, provenance, write
from reports.own_log.judged import JudgedLog, judge_log, row_table
from reports.own_log.log_limits import EVERY, LogRequest
from reports.own_log.table import show, suite, verdict_line
from reports.plan.requirements import given_of
from reports.plan.steps import positive
from reports.protocol.way import way_of
from reports.requests import any_log, arguments, options
from reports.requests.compare import CellVerdict, verdict_of_run
from reports.requests.options import argument, option, output_option, seconds
from reports.requests.shown import Shown
from reports.requests.solution import drawn
from sim.engine import Run

if TYPE_CHECKING:
    import pandas as pd


def write_log_map(path: Path, log: Path, scene: Scene, map_: Map) -> str:
    """Write the map of a log, or a form of it to be filled in; return a description of it.

    An entry that a refusal of the log names, such as a decimal comma, is made. Raises
    CrankcheckError for a log that no map alone can correct.
    """
    from reports.logs.meanings import blank_map, columns_worth, map_text, understood  # pandas

    fault: CrankcheckError | None = None
    tried, entries = [map_], dict[str, str]()
    while True:
        blank = None
        try:
            columns = columns_worth(log, scene, map_)
            blank = blank_map(columns, scene, map_)
            text = map_text(understood(columns, scene, map_), map_.file)
        except CrankcheckError as error:
            fault = fault or error
            entry = ENTRY.search(str(error))
            if entry:
                key, value, table = entry.groups()
                part = getattr(map_, table).model_copy(update={key: value})
                mended = map_.model_copy(update={table: part})
                if mended not in tried:
                    map_, entries[key] = mended, f", with {entry[0]}"
                    tried.append(map_)
                    continue
            if blank is None:
                raise fault from None
            text, lacks = blank
            write(path, text)
            return f"the columns of {log}; fill in {lacks}, then judge with --map {path}"
        write(path, text)
        return f"columns of {log}, as understood{''.join(entries.values())}"


ENTRY = re.compile(r"(\w+) = '([^']+)' in \[(file|time)\]")
"""An entry of a map, as a refusal prints it."""


def contents(judged: JudgedLog, facts: Mapping[str, str]) -> dict[str, Callable[[], str]]:
    """The contents of the files, by option."""

    def page() -> str:
        from reports.page.log_page import log_page  # the drawings, which nothing else here needs

        return log_page(judged, facts)

    return {
        "--json": lambda: _json(judged, facts),
        "--junit": lambda: junit(suite(judged, facts)),
        "-o": page,
    }


def _json(judged: JudgedLog, facts: Mapping[str, str]) -> str:
    """Facts, verdict, findings, causes and errors; numbers that are not finite are null."""
    fit = judged.fit
    document = {
        "facts": facts,
        "log": judged.log.source,
        "scene": judged.scene.name,
        "verdict": judged.verdict,
        "drive": judged.drive,
        "fit": vars(fit) if fit else None,
        "samples": judged.log.time_s.size,
        "findings": [vars(finding) for finding in judged.findings],
        "causes": [{**vars(each), "correction": dict(each.correction)} for each in judged.causes],
        "not_judged": judged.not_judged,
        "not_used": dict(judged.log.unused),
        "notes": judged.notes,
        "errors": row_table(judged),
    }
    return json.dumps(finite(document), indent=2) + "\n"


Target = float | Mapping[str, float] | None
"""The largest error as a pure number, for all quantities together or for each."""


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class LogVerdict(Shown, JudgedLog):
    """Verdict on a log of your own.

    ``verdict`` is "within" or "out"; ``findings`` are the answers of all rules, and ``failures``
    those that make the verdict; ``causes`` explain errors out of tolerance, and delays within it;
    ``not_judged`` are quantities of the scene that the log lacks; ``facts`` says where the numbers
    come from.
    """

    facts: Mapping[str, str]

    def frame(self) -> pd.DataFrame:
        """Table of errors: a row per error with a limit, with the columns that it was read from."""
        import pandas as pd

        return pd.DataFrame(row_table(self))

    def show(self, console: Console) -> None:
        show(console, self, self.facts)

    def _drawn(self) -> str:
        return drawn(self.scene, self.beside.motion)


@overload
def judge(
    scene: arguments.SceneLike,
    log: Run,
    *,
    target: Target = None,
    step_s: None = None,
    drive: str = "scene",
    map: None = None,
    require: str | Iterable[str] = (),
    forces: bool = False,
    free: bool = False,
) -> CellVerdict: ...


@overload
def judge(
    scene: arguments.SceneLike,
    log: any_log.LogLike,
    *,
    target: Target = None,
    step_s: float | None = None,
    drive: str = "scene",
    map: any_log.MapLike = None,
    require: str | Iterable[str] = (),
    forces: bool = False,
    free: bool = False,
    segments: int | None = None,
    springs: str | None = None,
) -> LogVerdict: ...


@arguments.told_at_the_call
def judge(
    scene: arguments.SceneLike,
    log: Run | any_log.LogLike,
    *,
    target: Target = None,
    step_s: float | None = None,
    drive: str = "scene",
    map: any_log.MapLike = None,
    require: str | Iterable[str] = (),
    forces: bool = False,
    free: bool = False,
    segments: int | None = None,
    springs: str | None = None,
) -> CellVerdict | LogVerdict:
    """Compare a log of your own with the closed form, as `crankcheck judge` does.

    Parameters
    ----------
    scene : Scene, str or path
        A shipped name, the path of a scene file, or a scene.
    log : path, DataFrame, Mapping, Motion or Run
        A file (.csv, .tsv, .txt, .parquet, .xlsx), a frame, columns by name, or a motion; without
        times it is judged at its angles of the driver. For a run the verdict is that of `check`
        without other steps.
    target : float, Mapping or None
        The largest error as a pure number (rad; lengths over that of the longest link), for all
        quantities together or for each.
    step_s : float or None
        The step of the solver [s], from which a budget follows. One of the two is needed.
    drive : str
        ``scene``: the reference follows the scene's driver; ``fitted``: speed and start are fitted
        to the log; ``logged``: the geometry alone is judged, at the logged angle of the driver.
    map : path, Mapping or None
        Meaning of columns whose names do not say it: a TOML file, or a mapping with its content.
    require : str or Iterable[str]
        Quantities or bodies that have to be in the log.
    forces : bool
        Judge its columns of forces and torque as well; of a run, the forces that it logged.
    free : bool
        The log is of a driven scene, released at time 0; of a run this is known.
    segments, springs : int or None, str or None
        The solver's model of elastic links, as in `run`; of a run this is known.

    Raises
    ------
    CrankcheckError
        A log that can not be read, has nothing of the scene, or a column that names a body or a
        known quantity and is neither understood nor ignored; no target and no step.
    """
    with_forces, is_free = arguments.is_true(forces, "forces"), arguments.is_true(free, "free")
    asked = any_log.LogOptions(step_s, drive, map, require, with_forces, is_free, segments, springs)
    return judged(scene, log, target_of(target), asked)


def judged(
    scene: arguments.SceneLike,
    log: Run | any_log.LogLike,
    limits: Mapping[str, float],
    asked: any_log.LogOptions,
) -> CellVerdict | LogVerdict:
    """Judge a log or a run within limits by quantity; `EVERY` has the limit of all others."""
    scene = arguments.scene_of(scene)
    tolerance.check_names(scene)
    required = names_in(asked.require, "--require")
    if isinstance(log, Run):
        any_log.refuse_run(scene, log, replace(asked, require=required))
        every = limits.get(EVERY)
        scene = any_log.scene_of_run(scene, log)
        _refuse_other_targets(scene, limits)
        way = way_of(scene)
        if log.steps < way.least_judged:  # its drift and order would be those of its start
            raise CrankcheckError(
                f"{scene.name}: the run has {log.steps} steps, and a judgement of free motion "
                f"needs {way.least_judged}; use a shorter step, or a longer time"
            )
        named = limits if every is None else {name: limits.get(name, every) for name in way.targets}
        return verdict_of_run(scene, log, named)
    scene = _released(scene, free=asked.free)
    _refuse_other_targets(scene, limits)
    given = given_of([scene], asked.segments, asked.springs)
    request = LogRequest(
        target=limits,
        step_s=0.0 if asked.step_s is None else positive("--step", asked.step_s, "seconds"),
        drive=any_log.drive_of(asked.drive, forces=asked.forces),
        require=required,
        segments=given.segments,
        springs=given.springs,
    )
    found = judge_log(any_log.log_of(scene, log, asked.map, forces=asked.forces), request)
    notes = tuple(arguments.in_python(note) for note in found.notes)
    return LogVerdict(**arguments.parts_in_python(found) | {"notes": notes}, facts=provenance({}))


def _released(scene: Scene, *, free: bool) -> Scene:
    return loosened(scene) if free else scene


def _refuse_other_targets(scene: Scene, target: Mapping[str, float]) -> None:
    """Refuse targets of quantities that the scene has not. Raises CrankcheckError."""
    of_some = [*target.keys() - {EVERY}]
    tolerance.refuse_of_other_kinds("--target", of_some, [way_of(scene).limits])


def target_of(target: Target) -> dict[str, float]:
    """The target by quantity; `EVERY` has the target of all. Raises CrankcheckError."""
    if target is None or isinstance(target, Mapping):
        return arguments.tolerances_of(target, "--target")
    return {EVERY: positive("--target", target, "pure numbers, such as 1e-3")}


@dataclass(frozen=True)
class JudgeRequest:
    scene: options.SceneName
    log: Annotated[Path, argument("LOG", "Your log: .csv, .tsv, .txt, .parquet or .xlsx.")]
    map: Annotated[Path | None, option("TOML with the meaning of the columns.", "FILE")] = None
    write_map: Annotated[
        Path | None, option("Write the map as understood, without a judgement.", "FILE")
    ] = None
    drive: Annotated[str, "scene; fitted: its speed and start; logged: geometry at its angle."] = (
        "scene"
    )
    step_s: Annotated[
        float | None, option("Step of the solver.", "--step SECONDS", parser=seconds)
    ] = None
    target: Annotated[
        Sequence[str],
        option("Largest pure error, such as 1e-3 or angle=1e-4; may be repeated.", "NUMBER"),
    ] = ()
    require: Annotated[
        Sequence[str], option("Quantity or body that the log must have.", "NAME")
    ] = ()
    format: options.TextFormat = "text"
    json: Annotated[Path | None, "Write errors and findings as JSON."] = None
    junit: Annotated[Path | None, "Write JUnit XML, one case per error."] = None
    output: Annotated[Path | None, output_option("Write a page, .html.")] = None
    free: Annotated[bool, "The log shows the driven scene released at time 0."] = False
    forces: Annotated[bool, "Also judge its columns of forces and torque."] = False
    segments: options.SegmentCount = None
    springs: options.SpringKind = None
    known: options.KnownPath = None
    write_known: options.WriteKnown = None
    strict_known: options.StrictKnown = False

    def run(self, console: Console, progress: Console) -> int:
        """Answer, and return the exit code: 0 within, 1 out. Raises CrankcheckError for a log that
        can not be read and for a faulty request, before anything is written."""
        scene = outlined(load_scene(self.scene))
        scene = _released(scene, free=self.free)
        files = {"-o": self.output, "--json": self.json, "--junit": self.junit}
        outputs = Outputs(files | {"--write-known": self.write_known})
        asked = _checked(self, scene, outputs)
        failing, before = known.known_of(self.known), known.written_before(self.write_known)
        tolerance.check_names(scene)
        _refuse_other_targets(scene, asked.target)
        if self.write_map is not None:
            map_ = read_map(self.map) if self.map else Map()
            told = write_log_map(self.write_map, self.log, scene, map_)
            say_whole(console, f"{self.write_map}: {told}")
            return 0
        log = any_log.log_of(scene, self.log, self.map, forces=self.forces)
        (judged,) = known.marked([judge_log(log, asked)], failing)
        facts = provenance({})
        written = {"--write-known": lambda: known.known_file([judged], before)}
        with outputs.written(contents(judged, facts) | written):
            title = f"judge {judged.log.source}: {verdict_line(judged).plain}"
            present(console, self.format, title, partial(show, judged=judged, facts=facts))
        return int(judged.verdict == "out" or (self.strict_known and bool(judged.mended)))


def _checked(request: JudgeRequest, scene: Scene, outputs: Outputs) -> LogRequest:
    """The request for the judgement. Raises CrankcheckError for a fault that shows beforehand."""
    check_file(request.write_map, "--write-map", (".toml",))
    check_file(request.output, "-o", (".html",))
    files = {"--write-map": request.write_map, **outputs.files}
    Outputs(files).check((find_scene(request.scene), request.log, request.map, request.known))
    drive = any_log.drive_of(request.drive, forces=request.forces)
    if request.step_s is not None and not request.step_s > 0.0:
        raise CrankcheckError(f"--step {request.step_s:g}: give a time above 0, in seconds")
    given = given_of([scene], request.segments, request.springs)
    return LogRequest(
        target=tolerance.parse(request.target, "--target", EVERY),
        step_s=request.step_s or 0.0,
        drive=drive,
        require=request.require,
        segments=given.segments,
        springs=given.springs,
    )
