"""The verification of one version, run with its own environment, and kept."""

import hashlib
import math
import os
import platform
import shutil
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from filelock import FileLock, Timeout
from packaging.version import InvalidVersion, Version

from models.errors import CrankcheckError
from reports.history import environments
from reports.output.write import check_folder, crankcheck_version, processor
from reports.quantities import QUANTITIES, named
from reports.results.runs import StoredCell, StoredRun
from reports.results.stored_runs import read_run
from reports.workers.signals import Ended, Runner, leave_to_parent, run_child
from sim.registry import declaration

ROOMS = Path(__file__).parents[2]
"""Folder of the packages of crankcheck: the checkout, or `crankcheck` where it is installed."""
FOLDER = Path(__file__).parents[__name__.count(".")]
"""Folder from which crankcheck is imported."""
RESULT = "verify.csv"
UNWIND_S = 2.0
"""Time below `reports.workers.signals.PATIENCE_S`: the child ends before this process is ended."""
LAUNCH = """\
import sys
from importlib.util import find_spec
if find_spec({engine!r}) is None:
    sys.exit("the environment holds no {engine}")
sys.path += {folders!r}
from {signals} import leave_to_parent
leave_to_parent()
from crankcheck.__main__ import main
sys.argv[0] = "crankcheck"
main()
"""
"""Code of the other interpreter: its own packages, such as the engine, go before borrowed ones."""
patient: Runner = partial(run_child, patience_s=UNWIND_S)


def borrowed() -> list[str]:
    """Return the folders of crankcheck and of all the packages that run it here, in order."""
    folders = [FOLDER, *(Path(folder) for folder in sys.path if folder)]
    return list(dict.fromkeys(str(folder.resolve()) for folder in folders if folder.is_dir()))


def code_key() -> str:
    """Return a name for crankcheck as it is: from its version, and the text of its code."""
    digest = hashlib.sha256(crankcheck_version().encode())
    for package in sorted(ROOMS.glob("*/__init__.py")):
        for path in sorted(package.parent.rglob("*.py")):
            digest.update(path.relative_to(ROOMS).as_posix().encode())
            digest.update(path.read_bytes())
    return digest.hexdigest()


def key_of(what: Iterable[object]) -> str:
    """Return a name for everything that a result depends on, but for the version of the engine.

    ``what`` are the cells to verify, with scene and settings in full, and any further inputs.
    """
    parts = [code_key(), environments.held_numpy(), platform.python_version(), processor()]
    return hashlib.sha256("\n".join([*parts, *map(repr, what)]).encode()).hexdigest()[:16]


def place(cache: Path, asked: environments.EngineVersion, key: str) -> Path:
    """Return the folder of the result of a version."""
    return cache / "results" / f"{asked.name}-{key}"


def kept(folder: Path) -> bool:
    """True if there is a result; it is written aside, so it is whole."""
    return (folder / RESULT).is_file()


def measure(
    folder: Path,
    asked: environments.EngineVersion,
    python: Path,
    arguments: Sequence[str],
    run: Runner = patient,
) -> None:
    """Run `crankcheck verify ARGUMENTS` with another interpreter, and keep the files it writes.

    Raises
    ------
    NotMeasuredError
        It wrote no result.
    OSError
        The cache can not be written.
    """
    aside = folder.with_name(f".{folder.name}.{os.getpid()}.tmp")
    try:
        aside.parent.mkdir(parents=True, exist_ok=True)
        shutil.rmtree(aside, ignore_errors=True)
        package = declaration(asked.engine).package
        signals = leave_to_parent.__module__
        code = LAUNCH.format(engine=package, folders=borrowed(), signals=signals)
        options = ["verify", "--engine", asked.engine, "-o", str(aside), *arguments]
        ended = run([str(python), "-P", "-c", code, *options], environments.clean_variables(), None)
        if not kept(aside):
            raise environments.NotMeasuredError(_not_run(ended))
        if folder.exists():
            shutil.rmtree(folder)
        aside.replace(folder)
    finally:
        shutil.rmtree(aside, ignore_errors=True)


def _not_run(ended: Ended) -> str:
    lines = [line.strip() for line in ended.complaint.splitlines() if line.strip()]
    if ended.code < 0:
        return f"not run: the process was ended by signal {-ended.code}"
    why = lines[-1].removeprefix("crankcheck: ") if lines else f"exit code {ended.code}"
    return environments.shortened(f"not run: {why}")


def user_cache(
    platform: str = sys.platform, variables: Mapping[str, str] = os.environ
) -> Path | None:
    """Return the folder of crankcheck among the user's caches on this system; None without a home.

    A variable that names no absolute path is ignored, as the XDG specification says.
    """
    named = variables.get("LOCALAPPDATA" if platform == "win32" else "XDG_CACHE_HOME", "")
    if named and Path(named).is_absolute():
        return Path(named) / "crankcheck"
    try:
        home = Path.home()
    except RuntimeError:
        return None
    usual = {"win32": "AppData/Local", "darwin": "Library/Caches"}
    return home / usual.get(platform, ".cache") / "crankcheck"


def cache_folder(named: Path | None) -> Path:
    """Return the folder that a user named, or the usual one, absolute and known to be writable.

    Raises
    ------
    CrankcheckError
        No usual place, or no right to write there.
    """
    folder = named or user_cache()
    if folder is None:
        raise CrankcheckError(
            "history: there is no home folder to keep environments in; name one with --cache DIR"
        )
    check_folder(folder, "--cache")
    return folder.resolve() / "history"


@contextmanager
def alone(path: Path, waiting: Callable[[], None]) -> Iterator[None]:
    """Run the block in one process at a time; ``waiting`` is called when another is in it."""
    path.parent.mkdir(parents=True, exist_ok=True)
    lock = FileLock(path)
    try:
        taken = lock.acquire(timeout=0)
    except Timeout:
        waiting()
        taken = lock.acquire()
    with taken:
        yield


NO_RUN = StoredRun("no result", {})


@dataclass(frozen=True)
class FollowedError:
    """An error that is followed over versions: the largest of some stored ones, as a pure number.

    ``tolerance`` gives the effect of rounding on it. ``rate`` marks errors that come of the others:
    where places are wrong, rates are too.
    """

    unit: str
    stored: tuple[str, ...]
    tolerance: str
    rate: bool = False


FOLLOWED: Mapping[str, FollowedError] = {
    "angle": FollowedError("rad", ("angle",), "angle"),
    "place": FollowedError("of L", ("displacement", "position"), "position"),
    "pin gap": FollowedError("of L", ("pin gap",), "gap"),
    "slider gap": FollowedError("of L", ("slider gap",), "gap"),
} | {
    name: FollowedError(f"of {QUANTITIES[name].share}", (name,), name, rate=True)
    for name in named("derived")
}


def errors_of(cell: StoredCell) -> dict[str, float]:
    """Return the followed errors of a cell, where it has a number for them."""
    numbers = {
        name: [
            cell.errors[each]
            for each in error.stored
            if math.isfinite(cell.errors.get(each, math.inf))
        ]
        for name, error in FOLLOWED.items()
    }
    return {name: max(each) for name, each in numbers.items() if each}


@dataclass(frozen=True)
class VersionResult:
    """A version with its verification, or with the reason why there is none.

    ``folder`` holds the files of the verification; ``kept`` says that an earlier call made them.
    """

    asked: environments.EngineVersion
    run: StoredRun = NO_RUN
    reason: str = ""
    folder: Path | None = None
    kept: bool = False

    @property
    def version(self) -> str:
        return str(self.asked.version)

    @property
    def cells(self) -> tuple[StoredCell, ...]:
        return tuple(self.run.cells.values())

    @property
    def calls_itself(self) -> str:
        """Version that the engine reports, which may differ from its package."""
        return self.run.facts.get(self.asked.engine, "")

    @property
    def misnamed(self) -> bool:
        """True if the engine gives itself another number than its package has."""
        try:
            told_version = Version(self.calls_itself)
        except InvalidVersion:
            return bool(self.calls_itself)
        # Post and local parts belong to the package; the engine does not know them.
        return Version(told_version.base_version) != Version(self.asked.version.base_version)


def read_version(folder: Path) -> StoredRun:
    """Return the verification in a folder of the cache. Raises CrankcheckError if it is damaged."""
    try:
        return read_run(folder)
    except CrankcheckError as error:
        raise CrankcheckError(
            f"not the result of a verification ({error}); run again with --again"
        ) from None


GAPS = ("pin gap", "slider gap")


def profiles_of(results: Sequence[VersionResult]) -> list[str]:
    """Return the profiles that were measured, in order."""
    return list(dict.fromkeys(cell.name.variant for each in results for cell in each.cells))


def overview(results: Sequence[VersionResult]) -> tuple[list[str], list[list[str]]]:
    """Return heads, and one row of texts per version."""
    profiles = profiles_of(results)
    heads = ["version"]
    for profile in profiles:
        heads += [f"{profile}:\nwithin", f"{profile}:\nworst gap"]
    return [*heads, "\nresult"], [_row(result, profiles) for result in results]


def _row(result: VersionResult, profiles: Sequence[str]) -> list[str]:
    texts = [result.version]
    for profile in profiles:
        cells = [cell for cell in result.cells if cell.name.variant == profile]
        within, known = (sum(c.verdict == word for c in cells) for word in ("within", "known"))
        share = f"{within} of {len(cells)}" + f", {known} known" * bool(known)
        texts += [share if cells else "-", _worst(cells)]
    return [*texts, result.reason or _ended(result)]


def _worst(cells: Sequence[StoredCell]) -> str:
    gaps = [error for cell in cells for name, error in errors_of(cell).items() if name in GAPS]
    return f"{max(gaps):.1e} L" if gaps else "-"


def _ended(result: VersionResult) -> str:
    """Say if the result is new, and which cells did not run to their end."""
    failed = [cell for cell in result.cells if not cell.ok]
    made = "kept from before" if result.kept else "new"
    if result.misnamed:
        made += f"; calls itself {result.calls_itself}"
    if not failed:
        return made
    first = failed[0]
    return (
        f"{made}; {len(failed)} of {len(result.cells)} cells did not run: {first.name.scene} "
        f"{first.name.variant}: {first.status}: {first.reason[:120]}"
    )
