"""The one place that writes files: checked before the work, whole or not at all after it; and the
provenance of a result: versions, processor, system, time.

A symbolic link is never followed to its target. A link that a user names as a file is refused; a
link in the place of a file of ours is replaced, as a file would be. A folder that he names may be a
link, ours in it may not.
"""

import contextlib
import errno
import os
import platform
import re
import sys
import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from models.errors import CrankcheckError

DEVICES, PROCESSES = Path("/dev"), Path("/proc")
"""Folders of the system's links to the streams of a process (`/dev/stdout`, `>(gzip)`); users have
theirs in folders of the first (`/dev/shm`), not in it."""
NOT_XML = re.compile("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
"""Characters that XML 1.0 can not hold, escaped or not."""


def check_file(
    path: Path | None,
    option: str,
    endings: tuple[str, ...] = (),
    *,
    inputs: Iterable[Path | None] = (),
    edited: bool = False,
) -> None:
    """Refuse a file that could not be written, before anything is run. Raises CrankcheckError for
    an ending that is not one of ``endings``, a link, a folder in its place, no folder to hold it,
    no right to write there, that it is read (``inputs``), or that no command wrote it, unless its
    owner may have ``edited`` it. None, for no file, is right."""
    if path is None:
        return
    if endings and path.suffix.lower() not in endings:
        ending = repr(path.suffix) if path.suffix else "no ending"
        raise CrankcheckError(f"{option} {path}: found {ending}; use {', '.join(endings)}")
    with _looking_at(path, option):
        if not _is_stream(path):
            refuse_link(path, option)
            _refuse_input(path, option, inputs)
    _check_place(path, option)
    if not edited and option not in EDITED:
        with _looking_at(path, option):
            _refuse_foreign(path, option)


PAGES = (".html", ".htm")
DOCUMENTS = (
    *(b"{", b"<?xml", b"<!doctype html", b"## crankcheck", b"<mujoco "),
    *(b"PK", b"PAR1", b"%PDF", b"\x89PNG", b"GIF8"),
)
MARKS = (b"crankcheck", b"<!-- Planar: in the x-y plane")
TABLES = (
    *(b"driver_deg,time_s,", b"driver_m,time_s,"),
    *(b"scene,", b"fault,", b"turned_rad,", b"# Known failures", b'"""Reactions '),
)
"""First bytes of what commands write: of files with a mark, of which a model has the second; and of
CSV, known failures and recipes, which have none."""
LOG = re.compile(rb"time_s,(?:velocity_time_s,)?([^,]+)_theta_rad,\1_omega_rad_s\b")
"""First columns of a log; one of a user's own is hardly written so."""
EDITED = ("--write", "--write-map", "--write-scene")
"""Options of scenes and maps, which their owner edits."""


def _refuse_foreign(path: Path, option: str) -> None:
    """Refuse a file that is there, with content, and is no document of a command. Raises
    CrankcheckError."""
    raw = path.read_bytes() if path.is_file() and not _is_stream(path) else b""
    if raw.startswith(b"PK"):  # a workbook, whose parts are compressed
        import zipfile

        with contextlib.suppress(zipfile.BadZipFile, KeyError), zipfile.ZipFile(path) as parts:
            raw += parts.read("docProps/core.xml")
    ours = raw.startswith(DOCUMENTS) and any(mark in raw for mark in MARKS)
    if raw and not (ours or raw.startswith(TABLES) or LOG.match(raw)):
        raise CrankcheckError(
            f"{option} {path}: there is a file that crankcheck did not write; name another, or "
            "remove it"
        )


def refuse_link(path: Path, option: str) -> None:
    """Refuse a symbolic link. Raises CrankcheckError that names its target."""
    if path.is_symlink():
        raise CrankcheckError(
            f"{option} {path}: a link to {os.path.realpath(path)}; name this file itself, or "
            "remove the link"
        )


def _check_place(path: Path, option: str) -> None:
    """Refuse the place of a file that could not be written there. Raises CrankcheckError."""
    with _looking_at(path, option):
        link = path.is_symlink()
        if path.is_dir() and not link:
            raise CrankcheckError(f"{option} {path}: a folder; name a file in it")
        if path.exists() and not link and not os.access(path, os.W_OK):
            raise CrankcheckError(f"{option} {path}: no right to write it; choose another file")
        folder = path.parent
        if not folder.is_dir():
            raise CrankcheckError(f"{option} {path}: there is no folder {folder}; create it first")
        if _is_stream(path):
            return
        if not os.access(folder, os.W_OK | os.X_OK):
            raise CrankcheckError(f"{option} {path}: no right to write in {folder}; choose another")
        _try_in(folder)


def _try_in(folder: Path) -> None:
    """Make a file there for a moment: in some folders (/proc) none can be. Raises OSError."""
    with tempfile.TemporaryFile(dir=folder):
        pass


def _is_stream(path: Path) -> bool:
    """True for a device or a pipe, which is written into and not replaced; or a link of the
    system's own, to any file."""
    if not path.exists() or path.is_dir():
        return False
    folder = path.parent.resolve()
    if path.is_symlink():
        return folder == DEVICES or folder.is_relative_to(PROCESSES)
    return not path.is_file()


def _write_into(stream: Path, raw: bytes) -> None:
    """Write into a stream; into one that this process has open already, at its position: earlier
    text stays, and later text comes after."""
    if stream.is_symlink() and stream.parent.resolve() == DEVICES:
        stream = stream.parent / stream.readlink()  # /dev/stdout: /proc/self/fd/1
    if stream.parent.resolve() == Path("/proc/self/fd").resolve():
        sys.stdout.flush()
        with os.fdopen(os.dup(int(stream.name)), "wb") as file:
            file.write(raw)
    else:
        stream.write_bytes(raw)


def check_folder(
    path: Path, option: str, files: Iterable[str] = (), *, inputs: Iterable[Path | None] = ()
) -> None:
    """Refuse a folder that could be neither written nor created, or whose ``files`` could not be
    replaced or are read (``inputs``). Raises CrankcheckError."""
    read = list(inputs)
    with _looking_at(path, option):
        nearest = path
        while not nearest.exists() and nearest != nearest.parent:
            refuse_link(nearest, option)  # to nothing
            nearest = nearest.parent
        if not nearest.is_dir():
            raise CrankcheckError(f"{option} {path}: {nearest} is a file; name a folder")
        if not os.access(nearest, os.W_OK | os.X_OK):
            raise CrankcheckError(
                f"{option} {path}: no right to write in {nearest}; choose another"
            )
        _try_in(nearest)
    for name in files if nearest == path else ():
        _check_place(path / name, option)
        _refuse_input(path / name, option, read)


@dataclass(frozen=True)
class Outputs:
    """Files that a request names, each None where it names none, by their options, and a folder for
    all of them; ``names`` in the folder come with the option of the same content."""

    files: Mapping[str, Path | None]
    folder: Path | None = None
    names: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Take a folder that is named as a page for the file of the option -o."""
        if "-o" in self.names.values() and self.folder and self.folder.suffix in PAGES:
            object.__setattr__(self, "files", {**self.files, "-o": self.folder})
            object.__setattr__(self, "folder", None)

    def check(self, inputs: Iterable[Path | None] = ()) -> None:
        """Refuse files as `check_file`, ``names`` in the folder that could not be written, and two
        of all these that are one file. Raises CrankcheckError."""
        outputs = [(option, path) for option, path in self.files.items() if path is not None]
        read = list(inputs)
        for option, path in outputs:
            check_file(path, option, inputs=read)
        if self.folder is not None:
            check_folder(self.folder, "-o", self.names, inputs=read)
            outputs += [("-o", self.folder / name) for name in self.names]
        taken: dict[Path, str] = {}
        for option, path in outputs:
            with _looking_at(path, option):
                real = path.parent.resolve() / path.name
                several = _is_stream(path)  # /dev/stdout takes them one after the other
            if real in taken and not several:
                raise CrankcheckError(
                    f"{taken[real]} and {option}: both name {path}; give each a file of its own"
                )
            taken[real] = option

    @contextlib.contextmanager
    def written(self, contents: Mapping[str, Callable[[], bytes | str]]) -> Iterator[None]:
        """Write the requested contents, by name, or by option, each whole or not at all, and show
        in the block; a full disk costs the file, and not the shown text. Raises CrankcheckError."""
        try:
            for name, content in contents.items():
                inside = self.folder / name if self.folder and name in self.names else None
                places = [*filter(None, (self.files.get(self.names.get(name, name)), inside))]
                made = content() if places else ""
                for place in places:
                    write(place, made)
        finally:
            yield


def _refuse_input(path: Path, option: str, inputs: Iterable[Path | None]) -> None:
    for read in inputs:
        try:
            same = read is not None and read.samefile(path)
        except (OSError, ValueError):  # one of them is not there, which whoever reads it says
            same = False
        if same:
            raise CrankcheckError(
                f"{option} {path}: that is {read}, which is read; name another file"
            )


@contextlib.contextmanager
def _looking_at(path: Path, option: str) -> Iterator[None]:
    """Turn the refusal of a look at a path into a user's fault."""
    try:
        yield
    except (OSError, RuntimeError) as error:  # RuntimeError: links that lead to each other
        why = getattr(error, "strerror", None) or str(error)
        raise CrankcheckError(f"{option} {path}: {why}; choose another place") from None


def write(path: Path, content: bytes | str) -> None:
    """Write a file whole: aside first, then renamed over the old one, or over a link. Raises
    CrankcheckError where the system refuses (disk full, rights taken away since the check)."""
    raw = content.encode() if isinstance(content, str) else content
    try:
        if _is_stream(path):
            _write_into(path, raw)
            return
        path.parent.mkdir(parents=True, exist_ok=True)
        aside = path.with_name(f".{path.name[:100]}.{os.getpid()}.tmp")
        try:
            aside.unlink(missing_ok=True)  # of a process of the same number that was killed
            with aside.open("xb") as file:  # never an existing file, or a link
                file.write(raw)
                file.flush()
                os.fsync(file.fileno())  # a name that stands for nothing is all that a crash leaves
            aside.replace(path)
        finally:
            with contextlib.suppress(OSError):
                aside.unlink(missing_ok=True)
    except OSError as error:
        why = error.strerror or str(error)
        space = "free some space there, or " * (error.errno in (errno.ENOSPC, errno.EDQUOT))
        raise CrankcheckError(
            f"{path}: can not be written: {why}; {space}choose another place"
        ) from None


def clean(text: str) -> str:
    """Return the text with the characters replaced that neither XML nor a workbook can hold."""
    return NOT_XML.sub("\ufffd", text)


def crankcheck_version() -> str:
    """Return the installed version of crankcheck."""
    try:
        return version("crankcheck")
    except PackageNotFoundError:  # run from a source tree that was not installed
        return "not installed"


def provenance(engines: Mapping[str, str]) -> dict[str, str]:
    """Return the facts that a result needs to be repeated; ``engines`` maps name to version."""
    return {
        "crankcheck": crankcheck_version(),
        **engines,
        "numpy": version("numpy"),
        "python": platform.python_version(),
        "processor": processor(),
        "processors": str(os.cpu_count() or 1),
        "system": f"{platform.system()} {platform.machine()}",
        "made": datetime.now(UTC).isoformat(timespec="seconds"),
    }


def processor() -> str:
    """Return the processor by its own name where the system has it."""
    if sys.platform == "linux":
        try:
            for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
                if line.startswith("model name"):
                    return line.partition(":")[2].strip()
        except OSError:
            pass
    return platform.processor() or platform.machine()
