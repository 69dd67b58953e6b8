"""`crankcheck verify`: run, compare, judge, show, write."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, cast

from rich.console import Console
from rich.progress import Progress

from models.errors import CrankcheckError
from models.files.reading import find_scenes
from models.scene import Scene
from reports.judge import known, rows, tolerance
from reports.judge.cell import Cell, Checked
from reports.output.console import say_whole, tell
from reports.output.formats import csv, json_text, junit, parquet
from reports.output.printed import Print, as_html, present
from reports.output.write import Outputs, provenance
from reports.plan import batches, requirements
from reports.plan.singular import gives_forces, silent_note
from reports.protocol.length import Length
from reports.protocol.way import driven_by, laid_out, way_of
from reports.requests.options import (
    PRESCRIBED,
    VerifyOptions,
    given,
    numbers,
    refuse_of_models,
)
from reports.requests.solution import drawn
from reports.verify.advised import check_all
from reports.verify.table import show, suite, summary
from sim.engine import Drive
from sim.registry import engine

if TYPE_CHECKING:
    from reports.results.changes import Diff
    from reports.results.runs import StoredRun


@dataclass(frozen=True)
class VerifyRequest(VerifyOptions):
    @property
    def names(self) -> Sequence[str]:
        """The scenes by name; with ``free`` the scenes of free motion where none is named."""
        return requirements.free_names(self.scenes) if self.free else self.scenes

    def run(self, console: Console, progress: Console) -> int:
        """Answer, and return the exit code: 0 within, 1 out of tolerance or worse than the
        baseline, 2 not to be run. Raises CrankcheckError for a faulty request before running."""
        if self.mjcf is not None:
            from reports.requests.verify_model import verify_model

            return verify_model(self, console, progress)
        refuse_of_models(self)
        cells = plan(self)
        outputs = Outputs(self.files, self.folder, IN_FOLDER)
        if self.baseline is not None:  # which ``-o`` may go on from, and no other output write over
            from reports.requests.diff import stored_files

            Outputs(self.files).check(stored_files(self.baseline))
        outputs.check([*find_scenes(self.names), self.known])
        failing = known.known_of(self.known, self.names)
        before = known.written_before(self.write_known)
        digests = _digests(self)
        silent = (
            silent_note(requirements.chosen_engines(())) if self.forces and not self.engines else ""
        )
        say_whole(progress, *passages(cells), silent, requirements.left_out_note(self.names))
        base = _baseline(self, cells, digests)
        with Progress(console=progress, transient=True, disable=not progress.is_terminal) as bar:
            task = bar.add_task("verifying", total=len(cells))
            jobs = self.jobs or int(self.worlds is not None)  # costs are of one run at a time
            checked = check_all(cells, jobs, lambda _: bar.advance(task))
        if self.worlds is None:  # known failures are those of runs alone
            checked = known.marked(checked, failing)
        engines = dict.fromkeys(cell.engine for cell in cells)
        facts = provenance({name: engine(name).version() for name in engines})
        shows: list[Print] = [partial(show, checked=checked, facts=facts)]
        diff = None
        if base:
            from reports.diff.document import show_diff
            from reports.results.changes import compare
            from reports.results.runs import run_of

            diff = compare(base, run_of(checked, facts, digests), self.factor)
            shows.append(partial(show_diff, diff=diff))
        title = f"verify: {summary(checked).plain}"

        def page() -> str:
            from reports.page.build import printed_page  # whose packages nothing else here needs

            scenes = {one.cell.scene.name: one.cell.scene for one in checked}.values()
            pictures = [*map(drawn, scenes), _of_batches(checked)]
            return printed_page(title, facts, as_html("".join(pictures), *shows))

        files = contents(checked, facts, digests, diff, before) | {"verify.html": page}
        with outputs.written(files):
            present(console, self.format, title, *shows)
        mended = self.strict_known and any(one.mended for one in checked)
        return _code(checked, diff, progress) or int(mended)


def _of_batches(checked: Sequence[Checked]) -> str:
    """The diagram of batches, as SVG; "" where there are none."""
    if not any(one.cell.worlds for one in checked):
        return ""
    from reports.figures.batches import batches_picture  # and its packages

    return batches_picture([rows.cell_row(one) for one in checked])


def _code(checked: Sequence[Checked], diff: Diff | None, progress: Console) -> int:
    """The exit code; the gated cells that could not be run are printed."""
    gated = [one for one in checked if one.cell.gated]
    missing = [one for one in gated if one.verdict == "unsupported"]
    for one in missing:
        progress.print(f"crankcheck: {one.cell.label}: {one.reason}", markup=False, soft_wrap=True)
    if missing:
        return 2
    out = any(one.verdict == "out" for one in gated)
    return int(out or (diff is not None and diff.code() == 1))


def plan(request: VerifyOptions) -> list[Cell]:
    """The cells of the request; with forces, engines that report none run without them unless they
    are named. Raises CrankcheckError for cells that can not be run."""
    limits = tolerance.parse(request.tolerance)
    sizes = _sizes(request)
    if not request.forces:
        tolerance.refuse_forces_unasked("--tol", limits)
    facets = [] if request.facets is None else [request.facets]
    scenes = requirements.by_contact(_scenes(request), facets)
    if sizes:
        scenes = batches.startable(scenes, named=bool(request.scenes))
    _refuse_options(request, scenes)
    tolerance.refuse_of_other_kinds("--tol", limits, (way_of(scene).limits for scene in scenes))
    engines = requirements.chosen_engines(request.engines)
    if sizes and not request.engines:
        engines = batches.with_batches(engines)
    only = requirements.PROFILES[:1] if sizes else ()
    profiles = requirements.chosen_profiles(request.profiles or only, engines)
    given = requirements.given_of(scenes, request.segments, request.springs)
    asked = Length(request.dt_s, request.steps_per_turn, request.turns, request.duration_s)
    length_of = batches.batch_length if sizes else requirements.usual_length
    lengths = {
        (name, scene.name): length_of(name, scene, asked, named=bool(request.scenes))
        for name in engines
        for scene in scenes
    }
    laid = {
        (scene.name, length): laid_out(scene, length, given, with_forces=request.forces)
        for scene in scenes
        for length in {lengths[name, scene.name]: None for name in engines}
        if length
    }
    return [
        Cell(
            scene=scene,
            engine=name,
            profile=profile,
            dt_s=laid[scene.name, length][0],
            steps=laid[scene.name, length][1],
            gated=gated,
            drive=driven_by(scene, cast(Drive, request.drive)),
            tolerance=limits,
            converge=request.converge and not worlds,
            with_forces=request.forces and (bool(request.engines) or gives_forces(name)),
            segments=given.segments,
            springs=given.springs,
            worlds=worlds,
            threads=threads,
        )
        for scene in scenes
        for profile, gated in profiles
        for name in engines
        if (length := lengths[name, scene.name]) and profile in engine(name).profiles
        for worlds, threads in batches.batches_of(name, sizes)
    ]


def _sizes(request: VerifyOptions) -> list[int]:
    """The numbers of worlds of batches. Raises CrankcheckError for other options that batches do
    not have."""
    sizes = numbers("--worlds", request.worlds, int, "whole numbers", "1,16,256")
    for option in given(request, *NOT_IN_BATCHES) if sizes else ():
        raise CrankcheckError(f"--worlds and {option}: not offered for batches; leave out one")
    return batches.checked_sizes(sizes)


def _scenes(request: VerifyOptions) -> list[Scene]:
    if request.free:
        return requirements.scenes_of(request.scenes, free=True)

    def check(scene: Scene) -> None:
        tolerance.check_names(scene)
        if not scene.is_free:
            requirements.refuse_unfollowed(scene)

    return [
        requirements.under_control(scene)
        for scene in requirements.chosen_scenes(request.scenes, check)
    ]


def _refuse_options(request: VerifyOptions, scenes: Sequence[Scene]) -> None:
    if request.drive not in ("prescribed", "servo"):
        raise CrankcheckError(
            f"--drive {request.drive!r}: unknown; use prescribed or servo, --free for free motion, "
            "or name the model with that joint with --mjcf FILE"
        )
    other = [scene.name for scene in scenes if request.drive not in way_of(scene).drives]
    if other and request.drive != PRESCRIBED:
        raise CrankcheckError(
            f"--drive {request.drive}: {other[0]} is in free motion, without a drive; leave "
            "--drive out, or the scene"
        )
    lengths = {"--duration": request.duration_s, "--turns": request.turns}
    lengths["--steps-per-turn"] = request.steps_per_turn
    requirements.refuse_other_options(scenes, lengths)


def passages(cells: Sequence[Cell]) -> list[str]:
    """Notes on change points, and on elastic links in free motion that is cut short, once for every
    scene and duration of the cells."""
    runs = {(cell.scene.name, cell.dt_s * cell.steps): cell for cell in cells}
    notes = (cell.way.note(cell.scene, duration_s) for (_, duration_s), cell in runs.items())
    return [note for note in dict.fromkeys(notes) if note]


def _baseline(
    request: VerifyOptions, cells: Sequence[Cell], digests: Mapping[str, str]
) -> StoredRun | None:
    """The cells of the baseline that will run now, read before anything is written over it. Raises
    CrankcheckError for no stored run, and for nothing to compare with."""
    if request.baseline is None:
        return None
    from reports.results.changes import compare
    from reports.results.runs import planned_run
    from reports.results.stored_runs import read_run

    base = read_run(request.baseline)
    tell(base.notice)
    planned = planned_run(cells, digests)
    compare(base, planned, request.factor)  # raises, where nothing is to be compared
    return base.only(planned.cells)


def _digests(request: VerifyRequest) -> dict[str, str]:
    """The digests of the texts of the scenes, where they are kept or compared."""
    if not (request.baseline or request.folder or request.json):
        return {}
    from reports.results.stored_runs import scene_digests

    return scene_digests(request.names)


NOT_IN_BATCHES = [
    *("baseline", "forces", "free", "duration_s", "segments", "springs"),
    *("known", "strict_known", "write_known"),
]
IN_FOLDER = {
    "verify.csv": "--csv",
    "verify.json": "--json",
    "verify.junit.xml": "--junit",
    "errors.parquet": "",
    "verify.html": "-o",
}


def contents(
    checked: Sequence[Checked],
    facts: Mapping[str, str],
    digests: Mapping[str, str],
    diff: Diff | None,
    before: Sequence[known.KnownFailure],
) -> dict[str, Callable[[], bytes | str]]:
    """Contents of the files: cells, their origin, digests of the texts of their scenes, changes
    since the baseline, and known failures with reasons from ``before``."""

    def suites() -> str:
        if diff is None:
            return junit(suite(checked, facts))
        from reports.diff.document import suite as diff_suite

        return junit(suite(checked, facts), diff_suite(diff))

    return {
        "verify.csv": lambda: csv(rows.cell_frame(checked)),
        "verify.json": lambda: _json(checked, facts, digests),
        "verify.junit.xml": suites,
        "errors.parquet": lambda: parquet(rows.error_frame(checked)),
        "--write-known": lambda: known.known_file(
            (one for one in checked if one.cell.gated), before
        ),
    }


def _json(checked: Sequence[Checked], facts: Mapping[str, str], digests: Mapping[str, str]) -> str:
    """Facts, digests of scenes, and cells with their findings; null for numbers not finite."""
    cells = [
        rows.cell_row(one)
        | {
            "settings": dict(one.settings),
            "not_reported": list(one.errors.not_reported) if one.errors else [],
            "notes": list(one.errors.notes) if one.errors else [],
            "findings": [vars(finding) for finding in one.findings],
            "known": one.known_text,
        }
        for one in checked
    ]
    return json_text({"provenance": facts, "scenes": digests, "cells": cells})
