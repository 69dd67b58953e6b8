"""Engines of a user's own: how they are found, refused, and watched while they run."""

import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from analytic.kinematics import solve
from models.errors import EngineError
from models.files.reading import load_scene
from sim import registry
from sim.engine import Run
from sim.own_engine import known, watched
from sim.own_engine.watched import BrokenContractError
from sim.registry import brought, capability, declaration, engine
from sim.run import run, time_run
from tests.worlds.own_engines import CODE, fresh, installed, with_faults
from tests.worlds.runs import opened

FOURBAR = load_scene("fourbar-lecture-1")
START = solve(FOURBAR, np.zeros(1)).state()


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A working folder with the example in it, in a process that has met no engine yet."""
    (tmp_path / "penalty_engine.py").write_text(CODE)
    with fresh(tmp_path, monkeypatch):
        yield tmp_path


def ran(name: str) -> Run:
    return run(FOURBAR, START, name, dt_s=1e-3, steps=20)


def wrong(folder: Path, old: str, new: str) -> str:
    """The example with a fault, as a module of its own."""
    (folder / "faulty_penalty.py").write_text(with_faults({old: new}))
    return "faulty_penalty:ENGINE"


def test_one_in_the_working_folder_is_known_by_name_and_has_its_adapter_alone(folder: Path) -> None:
    found = engine("penalty_engine:ENGINE")
    assert found.name == "penalty"
    assert engine("penalty") is found is engine("penalty_engine:ENGINE")
    assert ran("penalty").engine == "penalty"
    assert sys.path[-1] == str(folder)
    assert sys.path[0] != str(folder)
    assert known.spellings() == {"penalty": "penalty_engine:ENGINE"}
    assert declaration("penalty").offers == ()
    assert "penalty" not in registry.usual()
    with pytest.raises(EngineError, match="penalty: it has no knobs; use mujoco or pymunk"):
        capability("penalty", "knobs")


def test_a_process_that_is_told_the_spelling_finds_it_by_name(folder: Path) -> None:
    known.told({"penalty": "penalty_engine:ENGINE"})
    assert engine("penalty").version() == "1.0"


@pytest.mark.parametrize(("text", "words"), [
    ("penalty_engin:ENGINE", "no module penalty_engin, neither .*mean penalty_engine?"),
    ("penalty_engine.more:ENGINE", "no module penalty_engine.more, .*penalty_engine"),
    ("penalty_engine:ENGIN", "penalty_engine has no ENGIN; did you mean ENGINE?"),
    ("penalty_engine:PROFILES", "found a dict, which lacks name, profiles, version, check"),
    ("penalty_engine:PenaltySession", "found a class, PenaltySession, which lacks name"),
    ("penalty_engine:VERSION", "found '1.0', which lacks name"),
    ("penalty_engine:", "write it package.module:ATTRIBUTE"),
    ("../penalty_engine.py:ENGINE", "write it package.module:ATTRIBUTE"),
    ("penalty_engine", "unknown; there are mujoco, pymunk, .*; one of your own is written"),
])  # fmt: skip
def test_what_is_not_to_be_found_is_told_with_what_would_work(text: str, words: str) -> None:
    with pytest.raises(EngineError, match=words):
        engine(text)


@pytest.mark.parametrize(("line", "words"), [
    ("1 / 0", r"ZeroDivisionError: division by zero \(faulty.py, line 2\)"),
    ("import nothing_there", r"ModuleNotFoundError: No module named 'nothing_there'"),
    ("def", r"SyntaxError: invalid syntax \(faulty.py, line 2\)"),
    ("raise SystemExit(3)", r"SystemExit: 3 \(faulty.py, line 2\)"),
    ("raise ValueError('one\\ntwo')", r"ValueError: one \(faulty.py, line 2\); correct that"),
])  # fmt: skip
def test_a_module_that_fails_is_told_in_one_line(folder: Path, line: str, words: str) -> None:
    (folder / "faulty.py").write_text(f"\n{line}\n")
    with pytest.raises(EngineError, match=words) as raised:
        engine("faulty:ENGINE")
    assert "\n" not in str(raised.value)
    assert str(folder) not in sys.path[:1]


@pytest.mark.parametrize(("old", "new", "words"), [
    ('*("penalty"', '*("a/b"', "name is 'a/b'; give letters, digits"),
    ('*("penalty"', '*("MuJoCo"', "calls itself MuJoCo, as the mujoco that crankcheck has"),
    (", PROFILES, lambda", ", [], lambda", "profiles is a list; give a dict of Profile"),
    ("lambda: VERSION", "VERSION", "version is '1.0'; give a function"),
    ("cc.Setting(c, why)", "c", "'damping' is 0.1; give a Setting"),
    (
        "reports_accelerations=False", "placing=lambda settings: 'cast'",
        "placing of profile 'tuned' gives 'cast'; give integrated"),
    ("reports_accelerations=False", "order=0", "order is 0; give a whole number above 0"),
    ("reports_accelerations=False", "reports_accelerations=0", "give True or False"),
    ("reports_accelerations=False", "applies_springs=None", "applies_springs is None; give"),
    ("reports_accelerations=False", "forces_of='all'", "forces_of is 'all'; give nothing or s"),
    ("reports_accelerations=False", "precision='half'", "precision is 'half'; give double or s"),
    ("reports_accelerations=False", "floor=0", "floor is 0; give a number above 0"),
    ("reports_accelerations=False", "no_forces=None", "no_forces is None; give words"),
    ("reports_accelerations=False", "unreported={'A'}", "unreported is a set; give a function"),
])  # fmt: skip
def test_an_object_that_is_no_engine_is_told_all_that_is_wrong(
    folder: Path, old: str, new: str, words: str
) -> None:
    with pytest.raises(EngineError, match=words):
        engine(wrong(folder, old, new))


def test_two_of_one_name_are_refused(folder: Path) -> None:
    (folder / "other_engine.py").write_text(CODE)
    engine("penalty_engine:ENGINE")
    with pytest.raises(EngineError, match="calls itself penalty, as penalty_engine:ENGINE does"):
        engine("other_engine:ENGINE")
    (folder / "again.py").write_text("from penalty_engine import ENGINE\n")
    assert engine("again:ENGINE") is engine("penalty")


def test_an_installed_package_brings_its_engine(folder: Path) -> None:
    installed(folder)
    sys.path.append(str(folder))
    assert engine("penalty").version() == "1.0"
    (entry,) = brought()
    assert (entry.name, entry.version, entry.broken) == ("penalty", "1.0", "")
    with pytest.raises(EngineError, match="'penaltie': unknown; did you mean penalty"):
        engine("penaltie")


def test_entry_points_that_do_not_hold_what_they_say_are_told(folder: Path) -> None:
    points = {"soft": "penalty_engine:ENGINE", "gone": "not_there:ENGINE", "twice": "a:ENGINE"}
    installed(folder, points)
    installed(folder, {"twice": "b:ENGINE"}, "another")
    sys.path.append(str(folder))
    told = {entry.name: entry.broken for entry in brought()}
    assert "gives an engine that calls itself penalty; give both the same name" in told["soft"]
    assert "no module not_there" in told["gone"]
    assert "two installed packages have one of that name: a:ENGINE and b:ENGINE" in told["twice"]


def test_nothing_is_looked_up_for_an_engine_of_ours(monkeypatch: pytest.MonkeyPatch) -> None:
    def looked() -> None:
        raise AssertionError

    monkeypatch.setattr(known, "installed", looked)
    monkeypatch.setattr(watched, "installed", looked)
    assert registry.usual() == ["mujoco", "pymunk"]
    assert all(engine(name) for name in registry.usual())
    assert registry.available()


READ = "return self._poses([self._row()])"


@pytest.mark.parametrize(("old", "new", "words"), [
    ("    def facts(self):", "    def fact(self):", "open gave a session that lacks facts"),
    ("self.names, crank = cc", "1 / 0; self.names, crank = cc", "open raised ZeroDivisionErr"),
    ("return cc.Facts(", "return None and cc.Facts(", "facts gave None, and has to give a Facts"),
    ("velocity_shift=SHIFT", "velocity_shift=None", "facts gave None for velocity_shift"),
    ("gravity_m_s2=self.scene", "gravity_m_s2=[0.0] or self.scene", "gravity_m_s2, and has to"),
    (
        "settings={**self", "springs={'s': (1.0, None, 0.0)}, settings={**self",
        r"gave \(1.0, None, 0.0\) for spring s, and has to give \(rate, damping, free\)"),
    ("settings={**self", "springs=[], settings={**self", r"gave \[\] for springs, and has"),
    (READ, "return None", "facts gave None for poses, and has to give Poses"),
    (", omega, none, none[:, 0].copy())", ", omega, none, none)", r"alpha as float64 of shape"),
    ("theta, speed, omega", "theta.astype('f'), speed, omega", "crank theta as float32"),
    ("poses[name] = ", "poses[name + '!'] = ", "gave no pose of crank; it has crank!"),
    ("rows.append(self._row())", "pass", "record gave 1 samples, and has to give 21"),
    ("return cc.Log(", "return (", r"record gave .* and has to give a Log"),
    ("lambda: VERSION", "lambda: 1", "version gave 1, and has to give a str"),
])  # fmt: skip
def test_what_breaks_the_contract_at_run_is_told_with_its_place(
    folder: Path, old: str, new: str, words: str
) -> None:
    spelled = wrong(folder, old, new)
    with pytest.raises(BrokenContractError, match=words) as raised:
        ran(spelled)
    assert "`crankcheck engines check faulty_penalty:ENGINE` prints" in str(raised.value)


def test_what_is_raised_while_it_runs_is_a_row(folder: Path) -> None:
    spelled = wrong(folder, "            self._push()\n", "            raise SystemExit(4)\n")
    done = ran(spelled)
    assert done.status == "crashed"
    assert "it asked to end the process" in done.reason


FORCES = """
    def record_forces(self, steps, every):
        import dataclasses
        log = self.record(steps, every)
        none = np.full((len(log.poses.time_s), 2), np.nan)
        pins = {p: {b: none for b in names} for p, names in cc.joined_at(self.scene).items()}
        forces = cc.Forces(log.poses.time_s, pins, {}, none[:, 0])
        return dataclasses.replace(log, forces=forces)

    def read(self):"""


@pytest.mark.parametrize(("old", "new", "words"), [
    ("record_forces", "record_force", "open gave a session that lacks record_forces"),
    ("forces=forces)", "forces=None)", "record_forces gave None for forces, and has to give F"),
    ("pins, {}, none", "{}, {}, none", r"gave \[\] for pins, and the scene has A, D, B, C, in"),
    ("for b in names}", "for b in names[::-1]}", "its bodies are ground, crank, in this order"),
    ("b: none for", "b: none[:, 0] for", r"pin A on ground as float64 of shape \(21,\), and has"),
    ("none[:, 0])", "[0.0])", r"gave torque as \[0.0\], and has to give float64 of shape"),
])  # fmt: skip
def test_forces_of_a_wrong_kind_are_told_with_what_they_have_to_be(
    folder: Path, old: str, new: str, words: str
) -> None:
    declared = {"reports_accelerations=False": "reports_accelerations=False, forces_of='steps'"}
    sound = with_faults({"\n    def read(self):": FORCES, **declared})
    (folder / "sound_penalty.py").write_text(sound.replace('*("penalty"', '*("sound"'))
    given = run(FOURBAR, START, "sound_penalty:ENGINE", dt_s=1e-3, steps=20, with_forces=True)
    assert given.motion.forces is not None
    (folder / "faulty_penalty.py").write_text(sound.replace(old, new))
    with pytest.raises(BrokenContractError, match=words):
        run(FOURBAR, START, "faulty_penalty:ENGINE", dt_s=1e-3, steps=20, with_forces=True)


def test_stepping_is_not_watched(folder: Path) -> None:
    """Times are the engine's own."""
    timing = time_run(FOURBAR, START, "penalty_engine:ENGINE", dt_s=1e-3, steps=20, repeats=1)
    assert timing.best.us_per_step > 0.0
    assert opened(FOURBAR, "penalty").step.__qualname__ == "PenaltySession.step"
