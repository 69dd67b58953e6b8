"""`crankcheck history`: the same verification with several versions of an engine."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from rich.console import Console
from rich.progress import Progress

from models.errors import CrankcheckError
from models.files.reading import find_scenes
from reports.history import table, verification
from reports.history.environments import EngineVersion, NotMeasuredError, ready, uv_here, wanted
from reports.judge.cell import Cell
from reports.output.console import say_whole
from reports.output.write import check_folder, provenance, refuse_link, write
from reports.plan.requirements import left_out_note
from reports.protocol.length import clock_of
from reports.requests import options
from reports.requests.options import argument, option
from reports.requests.verify import IN_FOLDER, VerifyRequest, plan
from reports.results.stored_runs import scene_digests
from reports.workers.signals import run_child
from sim.registry import ENGINES, FIRST, engine

FILES = ("history.csv", "history.md")
LENGTHS = ("turns", "duration_s", "dt_s", "steps_per_turn")


@dataclass(frozen=True)
class HistoryRequest:
    """Arguments of `history`, as given; as in `verify` where the names are the same."""

    engine: Annotated[str, argument("ENGINE", f"Engine, such as {FIRST}.")]
    versions: Annotated[Sequence[str], argument("VERSION", "Released versions of it.")]
    scenes: Annotated[
        Sequence[str], option("Shipped name or file; may be repeated; default: all.", "--scene")
    ] = ()
    profiles: Annotated[
        Sequence[str], option("Profile; default: tuned and as-shipped.", "--profile")
    ] = ()
    dt_s: options.StepS = None
    steps_per_turn: options.StepsPerTurn = None
    turns: Annotated[float | None, "Turns of the driver (default 2)."] = None
    free: Annotated[bool, "Free motion; default: all free scenes."] = False
    duration_s: options.Duration = None
    jobs: options.Jobs = 0
    cache: Annotated[Path | None, option("Folder for environments and results.", "DIR")] = None
    again: Annotated[bool, "Verify again, in the same environments."] = False
    folder: Annotated[
        Path | None,
        option("Write the tables, and the verification of each version.", "-o --output DIR"),
    ] = None

    def run(self, console: Console, progress: Console) -> int:
        """Answer, and return the exit code: 0 when every version has a result, 2 when one has none.
        Raises CrankcheckError for a faulty request before installing."""
        _refuse_own(self.engine)
        versions = wanted(self.engine, self.versions)
        if not versions:
            raise CrankcheckError(f"history {self.engine}: name versions, such as 3.6.0 3.7.0")
        verified = _verification(self)
        cells, names = plan(verified), verified.names
        cache = verification.cache_folder(self.cache)
        _check_outputs(self, versions)
        uv = uv_here()
        if note := left_out_note(names):
            say_whole(progress, note)
        # The files of a result hold the digests of the scenes' texts, by which they are compared.
        key, results = verification.key_of([*cells, scene_digests(names)]), []
        with Progress(console=progress, transient=True, disable=not progress.is_terminal) as bar:
            task = bar.add_task("", total=2 * len(versions))
            for asked in versions:

                def tell(what: str, steps: int = 0, asked: EngineVersion = asked) -> None:
                    called = f"{asked.engine} {asked.version}"
                    bar.update(task, advance=steps, description=f"{called}: {what}")

                results.append(
                    _measured(self, asked, verification.place(cache, asked, key), cache, uv, tell)
                )
                bar.update(task, completed=2 * len(results))
        footer = _footer(self, cells, results)
        try:
            _write(self, results, footer)
        finally:
            table.show(console, results, footer)
        missing = [result for result in results if not result.cells]
        for result in missing:
            text = f"crankcheck: {self.engine} {result.version}: {result.reason}"
            progress.print(text, markup=False, soft_wrap=True)
        return 2 if missing else 0


def _refuse_own(name: str) -> None:
    """Refuse an engine without versions in a registry. Raises CrankcheckError, which suggests near
    names for an unknown engine."""
    if name not in ENGINES:
        own = engine(name).name
        raise CrankcheckError(
            f"history {own}: only {', '.join(ENGINES)} have released versions; write `verify "
            f"--engine {name} -o DIR` with each version of yours, and compare two with `diff`"
        )


def _verification(request: HistoryRequest) -> VerifyRequest:
    same = ("scenes", "profiles", "free", "jobs", *LENGTHS)
    fields = {name: getattr(request, name) for name in same}
    return VerifyRequest(engines=(request.engine,), **fields)


def _arguments(request: HistoryRequest) -> list[str]:
    """The same verification as arguments of the command line; the engine goes before them."""
    words = [f"--jobs={request.jobs}", *["--free"] * request.free]
    words += [f"--profile={name}" for name in request.profiles]
    numbers = {options.option_of(HistoryRequest, name): getattr(request, name) for name in LENGTHS}
    words += [f"{option}={value!r}" for option, value in numbers.items() if value is not None]
    return [*words, "--", *request.scenes]


def _measured(
    request: HistoryRequest,
    asked: EngineVersion,
    folder: Path,
    cache: Path,
    uv: str | None,
    tell: Callable[..., None],
) -> verification.VersionResult:
    """The result of one version in ``folder``, kept or made now; or the reason for none."""
    lock = cache / "locks" / f"{asked.name}.lock"
    try:
        with verification.alone(lock, lambda: tell("waiting for another crankcheck")):
            from_before = verification.kept(folder) and not request.again
            if not from_before:
                tell("installing")
                python = ready(cache, asked, uv, run_child)
                tell("verifying", 1)
                verification.measure(folder, asked, python, _arguments(request))
            return verification.VersionResult(
                asked, verification.read_version(folder), folder=folder, kept=from_before
            )
    except NotMeasuredError as error:
        return verification.VersionResult(asked, reason=str(error))
    except OSError as error:
        raise CrankcheckError(
            f"--cache {cache}: {error.strerror or error}; free some space there, or choose "
            "another place"
        ) from None


def _check_outputs(request: HistoryRequest, versions: Sequence[EngineVersion]) -> None:
    """Refuse outputs that can not be written, before anything is installed."""
    if request.folder is None:
        return
    read = find_scenes(request.scenes)
    check_folder(request.folder, "-o", FILES, inputs=read)
    for version in versions:
        refuse_link(request.folder / version.name, "-o")
        check_folder(request.folder / version.name, "-o", IN_FOLDER, inputs=read)


def _write(
    request: HistoryRequest, results: Sequence[verification.VersionResult], footer: str
) -> None:
    """Write the verification of each version into a folder of its own, and the history of all."""
    if request.folder is None:
        return
    for result in results:
        for path in sorted(result.folder.iterdir()) if result.folder else ():
            write(request.folder / result.asked.name / path.name, path.read_bytes())
    write(request.folder / FILES[0], table.table_text(results))
    write(request.folder / FILES[1], table.page(results, footer))


def _footer(
    request: HistoryRequest, cells: Sequence[Cell], results: Sequence[verification.VersionResult]
) -> str:
    """Units, settings and versions; the result's place where no -o was given."""
    first = cells[0]
    step, long = clock_of(first.drive).words(first.dt_s, first.steps_per_turn, first.turns)
    if len({round(cell.steps_per_turn, 3) for cell in cells}) > 1:
        step = f"dt {first.dt_s:.4g} s"
    measured = [result for result in results if result.folder]
    names = " ".join(result.version for result in measured) or "none"
    facts = provenance({request.engine: names})
    lines = [
        first.way.units,
        f"{step}, {long}; settings are those of this crankcheck's profiles in every version.",
        ", ".join(f"{name} {value}" for name, value in facts.items()),
    ]
    if request.folder is None and measured:
        lines.append("Results: " + ", ".join(str(result.folder) for result in measured))
    return "\n".join(lines)
