"""`crankcheck judge`: read a user's log, judge it, show, write."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from analytic.free.loosened import loosened
from models.errors import CrankcheckError, harmless
from models.files import find_scene, load_scene
from models.scene import Scene
from reports.judge.tolerance import check_names, parse, refuse_of_other_motion
from reports.logs.blank_map import blank_map
from reports.logs.columns import read_columns
from reports.logs.map_file import Map, map_text, read_map
from reports.logs.meanings import understood, wanted
from reports.output.junit import junit
from reports.output.numbers import finite
from reports.output.provenance import provenance
from reports.output.write import check_file, check_outputs, write
from reports.own_log.drives import chosen_drive, refuse_geometry_alone
from reports.own_log.judged import JudgedLog, LogRequest, judge_log
from reports.own_log.junit import suite
from reports.own_log.log_limits import EVERY
from reports.own_log.markdown import markdown
from reports.own_log.rows import row_table
from reports.own_log.table import show
from reports.plan.elastic import given_of
from reports.requests.options import SceneName, SegmentCount, SpringKind, seconds

FORMATS = ("text", "md")


@dataclass(frozen=True)
class JudgeRequest:
    """What `judge` was asked for, as given."""

    scene: SceneName
    log: Annotated[
        Path, typer.Argument(metavar="LOG", help="Your log: .csv, .tsv, .txt, .parquet or .xlsx.")
    ]
    map: Annotated[
        Path | None, typer.Option(metavar="FILE", help="TOML that says what columns mean.")
    ] = None
    write_map: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Write the map of what was understood, and end."),
    ] = None
    drive: Annotated[
        str,
        typer.Option(help="scene, fitted (speed and start), or logged (geometry at its angle)."),
    ] = "scene"
    step_s: Annotated[
        float | None,
        typer.Option("--step", metavar="SECONDS", parser=seconds, help="Step of the solver."),
    ] = None
    target: Annotated[
        Sequence[str],
        typer.Option(
            metavar="NUMBER", help="Largest pure error, such as 1e-3 or angle=1e-4; repeatable."
        ),
    ] = ()
    require: Annotated[
        Sequence[str],
        typer.Option(metavar="NAME", help="Quantity or body that has to be in the log."),
    ] = ()
    format: Annotated[str, typer.Option(metavar="text|md", help="What is printed.")] = "text"
    json: Annotated[Path | None, typer.Option(help="Write errors and findings as JSON.")] = None
    junit: Annotated[Path | None, typer.Option(help="Write JUnit XML, a case per error.")] = None
    output: Annotated[Path | None, typer.Option("-o", "--output", help="Write a page, .html.")] = (
        None
    )
    free: Annotated[
        bool, typer.Option("--free", help="It is of the driven scene, let go at time 0.")
    ] = False
    forces: Annotated[
        bool, typer.Option("--forces", help="Judge its columns of forces and torque as well.")
    ] = False
    segments: SegmentCount = None
    springs: SpringKind = None

    def run(self, console: Console, progress: Console) -> int:
        """Do it; returns the exit code: 0 within, 1 out. Raises CrankcheckError for what can not be
        read or asked, before anything is written."""
        scene = load_scene(self.scene)
        if self.free:
            scene = loosened(scene)
        asked = _checked(self, scene)
        check_names(scene)
        refuse_of_other_motion(
            "--target",
            [*asked.target.keys() - {EVERY}],
            [scene.is_free],
            bends=bool(scene.elastic),
        )
        map_ = read_map(self.map) if self.map else Map()
        if self.write_map is not None:
            told = f"{self.write_map}: {_write_map(self.write_map, self.log, scene, map_)}"
            console.print(harmless(told), highlight=False, markup=False, soft_wrap=True)
            return 0
        # No name for the columns, which take as much memory as all readings.
        log = understood(
            read_columns(self.log, map_.layout, wanted(scene, map_, forces=self.forces)),
            scene,
            map_,
            forces=self.forces,
        )
        judged = judge_log(log, asked)
        facts = provenance({})
        try:
            _write(self, judged, facts)
        finally:  # a full disk costs the file, and not the verdict with it
            if self.format == "md":
                console.print(
                    markdown(judged, facts), markup=False, highlight=False, soft_wrap=True
                )
            else:
                show(console, judged, facts)
        return int(judged.verdict == "out")


def _checked(request: JudgeRequest, scene: Scene) -> LogRequest:
    """What the log is to be judged by. Raises CrankcheckError for what can be told before."""
    if request.format not in FORMATS:
        raise CrankcheckError(f"--format {request.format!r}: unknown; use text or md")
    endings = {"--write-map": (".toml",), "-o": (".html",)}
    files = {"--write-map": request.write_map, "-o": request.output}
    for option, path in files.items():
        if path is not None:
            check_file(path, option, endings[option])
    files |= {"--json": request.json, "--junit": request.junit}
    check_outputs(files, inputs=(find_scene(request.scene), request.log, request.map))
    drive = chosen_drive(request.drive)
    refuse_geometry_alone(drive, forces=request.forces)
    if request.step_s is not None and not request.step_s > 0.0:
        raise CrankcheckError(f"--step {request.step_s:g}: give a time above 0, in seconds")
    given = given_of(scene, request.segments, request.springs)
    return LogRequest(
        target=parse(request.target, "--target", EVERY),
        step_s=request.step_s or 0.0,
        drive=drive,
        require=request.require,
        segments=given.segments,
        springs=given.springs,
    )


def _write_map(path: Path, log: Path, scene: Scene, map_: Map) -> str:
    """Write the map of a log, or a form of it to be filled in; returns what that is.

    Raises CrankcheckError for a log that no map alone can mend.
    """
    columns = read_columns(log, map_.layout, wanted(scene, map_))
    try:
        text = map_text(understood(columns, scene, map_), map_.file)
    except CrankcheckError:
        blank = blank_map(columns, scene, map_)
        if blank is None:
            raise
        text, lacks = blank
        write(path, text)
        return f"the columns of {log}, to be filled in: {lacks}; then judge with --map {path}"
    write(path, text)
    return f"what {log} says, as it was understood"


def _write(request: JudgeRequest, judged: JudgedLog, facts: Mapping[str, str]) -> None:
    """Every output that was asked for, each whole or not at all."""
    if request.json:
        write(request.json, _json(judged, facts))
    if request.junit:
        write(request.junit, junit(suite(judged, facts)))
    if request.output:
        # It brings the drawings, which nothing else here needs.
        from reports.page.log_page import log_page

        write(request.output, log_page(judged, facts))


def _json(judged: JudgedLog, facts: Mapping[str, str]) -> str:
    """Facts, verdict, findings, causes and errors; what is not finite is null."""
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
