"""A user's own engine: its spelling and import, and checks of its answers before they are used.

A fault in it is reported with the place and the command that explains more, and not as one of
crankcheck. Stepping is passed through, so that times are its own.

`package.module:ATTRIBUTE` names any object that can be imported, also from the working folder of
the command; an installed package names its own in the entry points of `GROUP`.
"""

from __future__ import annotations

import importlib
import math
import os
import re
import sys
import traceback
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from models.errors import CrankcheckError, EngineError, cut, few, shown, suggestion
from models.motion import Forces, SliderForces, State
from models.scene import Scene
from models.scene.joints import bodies, joined_at
from sim.engine import (
    Batches,
    BodyPose,
    Drive,
    Engine,
    Facts,
    ForceSession,
    Log,
    Poses,
    Session,
    Settings,
    Unreported,
)

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint


GROUP = "crankcheck.engines"
"""Group of entry points."""
SPELLING = re.compile(r"[^\W\d]\w*(\.[^\W\d]\w*)*:[^\W\d]\w*(\.[^\W\d]\w*)*")
WRITTEN = "package.module:ATTRIBUTE"
"""Form of a spelling."""


def installed() -> list[EntryPoint]:
    """List the entry points of engines, of all packages installed here."""
    from importlib.metadata import entry_points  # whose import takes longer than all else here

    here = entry_points(group=GROUP)
    return sorted(set(here), key=lambda point: (point.name, point.value))


def spelling_of(point: EntryPoint) -> str:
    """Return the module and attribute of an entry point."""
    return f"{point.module}:{point.attr}"


def only_one(name: str, points: Iterable[EntryPoint]) -> EntryPoint:
    """Return the entry point of that name. Raises EngineError where two packages have it."""
    named = {spelling_of(point): point for point in points if point.name == name}
    if len(named) > 1:
        raise EngineError(
            f"engine {name}: two installed packages have one of that name: {' and '.join(named)}; "
            "remove one of them, or rename its entry point and its engine"
        )
    return next(iter(named.values()))


def found(spelling: str) -> object:
    """Import the object of a spelling.

    Raises
    ------
    EngineError
        A text that is no spelling, a module that is missing or cannot be imported (with the place
        of the failure), a missing attribute, with near names.
    """
    if not SPELLING.fullmatch(spelling):
        raise EngineError(f"engine {cut(spelling)!r}: write it {WRITTEN}")
    module, _, attribute = spelling.partition(":")
    value: object = _imported(spelling, module)
    for name in attribute.split("."):
        if not hasattr(value, name):
            raise EngineError(
                f"engine {spelling}: {module} has no {name}; "
                + suggestion(name, _public(value), "it has")
            )
        value = getattr(value, name)
    return value


def _public(value: object) -> list[str]:
    """Return suggestions: the engines of an object, or else all its public names."""
    names = [name for name in dir(value) if not name.startswith("_")]
    return [n for n in names if isinstance(getattr(value, n, None), Engine)] or names


def _imported(spelling: str, module: str) -> object:
    """Import the module. Raises EngineError in one line for any failure."""
    try:
        with _working_folder():
            importlib.invalidate_caches()  # it may have been written a moment ago
            return importlib.import_module(module)
    except (Exception, SystemExit) as error:
        if isinstance(error, ModuleNotFoundError) and f"{module}.".startswith(f"{error.name}."):
            raise EngineError(
                f"engine {spelling}: no module {error.name}, neither installed nor in "
                f"{Path.cwd()}; {suggestion(module, _modules(), 'modules there:')}"
            ) from None
        raise EngineError(
            f"engine {spelling}: {module} can not be imported: {failure(error)}; correct that first"
        ) from None


def failure(error: BaseException) -> str:
    """Describe an error and its place in one line."""
    text = cut(str(error).partition("\n")[0], 300)
    frames = traceback.extract_tb(error.__traceback__)
    own = [frame for frame in frames if not frame.filename.startswith("<frozen ")]
    place, line = (own[-1].filename, own[-1].lineno) if own else ("", None)
    if isinstance(error, SyntaxError) and error.filename:
        text, place, line = error.msg, error.filename, error.lineno
    return f"{type(error).__name__}: {text}" + (f" ({Path(place).name}, line {line})" * bool(place))


def _modules() -> Iterator[str]:
    """Yield the modules and packages in the working folder."""
    for path in sorted(Path.cwd().iterdir()):
        if path.suffix == ".py" or (path / "__init__.py").is_file():
            yield path.stem


@contextmanager
def _working_folder() -> Iterator[None]:
    """Put the working folder first during an import, as for `python -m pytest`; afterwards it is
    last, so that nothing in it hides later imports."""
    try:
        here = str(Path.cwd())
    except OSError:  # it is gone
        yield
        return
    sys.path.insert(0, here)
    try:
        yield
    finally:
        sys.path.remove(here)
        if not any(os.path.abspath(each or here) == here for each in sys.path):  # noqa: PTH100 - as sys.path has it
            sys.path.append(here)


PAIRS = ("origin", "velocity", "origin_acceleration")
"""Fields of `BodyPose` of shape (T, 2); all others are (T,)."""


class BrokenContractError(EngineError):
    """An engine that breaks its contract; ``fault`` says how, without the place."""

    def __init__(self, name: str, spelling: str, fault: str) -> None:
        self.fault = fault
        self._parts = name, spelling, fault
        super().__init__(
            f"engine {name}: {fault}; `crankcheck engines check {spelling}` prints what it has "
            "to do"
        )

    def __reduce__(self) -> tuple[type[BrokenContractError], tuple[str, str, str]]:
        """Rebuild the error from its parts, in another process too."""
        return type(self), self._parts


def watched(spelling: str, engine: Engine) -> Engine:
    """Return the engine, with every answer checked."""
    place = _Place(engine.name, spelling)

    def guarded(name: str, call: Callable[..., Any], kind: type) -> Callable[..., Any]:
        def answer(*arguments: object) -> object:
            with place.told(name):
                given = call(*arguments)
            return place.as_kind(name, given, kind)

        return answer

    def opened(
        scene: Scene, state: State, settings: Settings, dt_s: float, drive: Drive
    ) -> WatchedSession:
        with place.told("open"):
            session = engine.open(scene, state, settings, dt_s, drive)
        wanted = ["facts", "step", "record", "read"]
        wanted += ["record_forces"] * (engine.forces_of != "nothing")
        lacking = [name for name in wanted if not hasattr(session, name)]
        if lacking:
            raise place.fault("open", f"gave a session that lacks {', '.join(lacking)}")
        return WatchedSession(session, place, scene)

    def together(
        sessions: Sequence[WatchedSession], steps: int, every: int, threads: int
    ) -> list[Log]:
        assert engine.batches is not None
        own = [one.session for one in sessions]
        logs = engine.batches.record(own, steps, every, threads)
        if not isinstance(logs, Sequence) or len(logs) > len(own):
            raise place.fault("batches.record", f"gave not a log for each of {len(own)} worlds")
        return [
            one.checked("batches.record", log, steps // every + 1)
            for one, log in zip(sessions, logs, strict=False)
        ]

    batches: object = engine.batches
    if batches is not None:
        threads = getattr(batches, "threads", 0)
        if not isinstance(batches, Batches) or not isinstance(threads, int) or threads < 1:
            raise place.fault("batches", "is no Batches that takes one thread or more")
    return replace(
        engine,
        batches=engine.batches and replace(engine.batches, record=together),
        version=guarded("version", engine.version, str),
        check=guarded("check", engine.check, object),
        holds=guarded("holds", engine.holds, Mapping),
        in_seconds=guarded("in_seconds", engine.in_seconds, tuple),
        unreported=guarded("unreported", engine.unreported, Unreported),
        open=opened,
    )


@dataclass(frozen=True)
class _Place:
    name: str
    spelling: str

    def fault(self, what: str, text: str) -> BrokenContractError:
        """Make the error of a fault in one of an engine's functions."""
        return BrokenContractError(self.name, self.spelling, f"{what} {text}")

    @contextmanager
    def told(self, what: str) -> Iterator[None]:
        """Turn unexpected errors into faults of the engine."""
        try:
            yield
        except (CrankcheckError, MemoryError):
            raise
        except (Exception, SystemExit) as error:
            raise self.fault(what, f"raised {failure(error)}") from error

    def as_kind(self, what: str, given: object, kind: type) -> object:
        """Return a value of the required kind, or refuse it."""
        if isinstance(given, kind):
            return given
        raise self.fault(what, f"gave {shown(given)}, and has to give a {kind.__name__}")


class WatchedSession:
    """A session whose answers are checked."""

    def __init__(self, session: Session, place: _Place, scene: Scene) -> None:
        self.session, self._place, self._scene = session, place, scene
        self._names = bodies(scene)
        self.step = session.step

    def facts(self) -> Facts:
        """Read the model as the engine holds it now."""
        with self._place.told("facts"):
            facts = self.session.facts()
        self._place.as_kind("facts", facts, Facts)
        if text := next(_facts(facts), "") or self._wrong(facts.start, 1):
            raise self._place.fault("facts", text)
        return facts

    def read(self) -> Poses:
        """Read the current state."""
        with self._place.told("read"):
            poses = self.session.read()
        if text := self._wrong(poses, 1):
            raise self._place.fault("read", text)
        return poses

    def record(self, steps: int, every: int) -> Log:
        """Advance and log. An error in it ends the run, as for any engine."""
        return self._logged("record", self.session.record, steps, every)

    def record_forces(self, steps: int, every: int) -> Log:
        """Advance and log with forces, as `record`."""
        record = cast(ForceSession, self.session).record_forces
        log = self._logged("record_forces", record, steps, every)
        if text := wrong_forces(self._scene, log.forces, log.poses.time_s.size):
            raise self._place.fault("record_forces", text)
        return log

    def _logged(self, what: str, record: Callable[[int, int], Log], steps: int, every: int) -> Log:
        try:
            log = record(steps, every)
        except SystemExit as error:
            raise RuntimeError(f"it asked to end the process: {failure(error)}") from error
        return self.checked(what, log, steps // every + 1)

    def checked(self, what: str, log: Log, count: int) -> Log:
        """Return a log of so many samples, or of fewer where it diverged; or refuse it."""
        self._place.as_kind(what, log, Log)
        if text := self._wrong(log.poses, None if log.diverged else count):
            raise self._place.fault(what, text)
        return log

    def _wrong(self, poses: object, count: int | None) -> str:
        """Return the fault of poses of so many samples; None is any number from 1 on."""
        if not isinstance(poses, Poses):
            return f"gave {shown(poses)} for poses, and has to give Poses"
        size = getattr(poses.time_s, "size", -1)
        if size < 1 or (count is not None and size != count):
            return f"gave {max(size, 0)} samples, and has to give {count or 'the first at least'}"
        for name in self._names:
            if name not in poses.bodies:
                return f"gave no pose of {name}; it has {', '.join(poses.bodies)}"
            if text := _pose(poses.bodies[name], size):
                return f"gave for {name} {text}"
        return ""


def _pose(pose: object, size: int) -> str:
    """Return the fault of a body's pose, independent of its truth."""
    if not isinstance(pose, BodyPose):
        return f"{shown(pose)}, and has to give a BodyPose"
    for each in fields(BodyPose):
        shape = (size, 2) if each.name in PAIRS else (size,)
        if text := _wrong(each.name, getattr(pose, each.name), shape):
            return text
    return ""


def _facts(facts: Facts) -> Iterator[str]:
    for name in ("mass_kg", "inertia_kg_m2", "centre_m", "settings", "springs"):
        if not isinstance(getattr(facts, name), Mapping):
            yield f"gave {shown(getattr(facts, name))} for {name}, and has to give a dict"
    for name in ("velocity_shift", "acceleration_shift"):
        value = getattr(facts, name)
        if not _is_number(value):
            yield f"gave {shown(value)} for {name}, and has to give a number of steps"
    for name, spring in facts.springs.items() if isinstance(facts.springs, Mapping) else ():
        if not (isinstance(spring, tuple) and len(spring) == 3 and all(map(_is_number, spring))):
            yield f"gave {shown(spring)} for spring {name}, and has to give (rate, damping, free)"
    for what, pairs in (("gravity_m_s2", [facts.gravity_m_s2]), ("centre_m", facts.centre_m)):
        each = pairs.values() if isinstance(pairs, Mapping) else pairs
        if not all(isinstance(pair, tuple) and len(pair) == 2 for pair in each):
            yield f"gave {shown(list(each))} for {what}, and has to give pairs (x, y)"


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and math.isfinite(value)


def wrong_forces(scene: Scene, forces: object, size: int) -> str:
    """Return the fault of forces of so many samples, independent of their truth."""
    if not isinstance(forces, Forces):
        return f"gave {shown(forces)} for forces, and has to give Forces"
    pins = joined_at(scene)
    for what, given, wanted in (
        ("pins", forces.pins, pins),
        ("sliders", forces.sliders, scene.sliders),
    ):
        if not isinstance(given, Mapping) or list(given) != list(wanted):
            named = few(list(wanted), 12) or "none"
            return f"gave {shown(list(given))} for {what}, and the scene has {named}, in this order"
    for point, by_body in forces.pins.items():
        if not isinstance(by_body, Mapping) or tuple(by_body) != pins[point]:
            names = ", ".join(pins[point])
            return (
                f"gave for pin {point} {shown(by_body)}, and its bodies are {names}, in this order"
            )
    return next((f"gave {text}" for text in _wrong_arrays(forces, size) if text), "")


def _wrong_arrays(forces: Forces, size: int) -> Iterator[str]:
    """Yield the fault of each series, which has to be float64 of its shape: "" for none."""
    for point, by_body in forces.pins.items():
        for body, force in by_body.items():
            yield _wrong(f"the force of pin {point} on {body}", force, (size, 2))
    for name, slider in forces.sliders.items():
        if not isinstance(slider, SliderForces):
            yield f"for slider {name} {shown(slider)}, and has to give SliderForces"
            return
        yield _wrong(f"the normal force of slider {name}", slider.normal, (size,))
        yield _wrong(f"the moment of slider {name}", slider.moment, (size,))
    yield _wrong("torque", forces.torque, (size,))
    yield _wrong("the time_s of forces", forces.time_s, (size,))


def _wrong(what: str, values: object, shape: tuple[int, ...]) -> str:
    found = shown(values)
    if isinstance(values, np.ndarray):
        if values.shape == shape and values.dtype == np.float64:
            return ""
        found = f"{values.dtype} of shape {values.shape}"
    return f"{what} as {found}, and has to give float64 of shape {shape}"
