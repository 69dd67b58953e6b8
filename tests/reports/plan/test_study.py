"""Studies: files, the command line over them, their scenes, and the grid that they make; and the
search for the coarsest step, on errors whose law is known."""

import math
import tomllib
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
import yaml

from models.errors import CrankcheckError
from models.files.reading import load_scene
from models.scene import Scene
from models.scene.characteristics import Constant
from models.scene.loads import ConstantFriction, Load
from reports.judge.cell import Cell
from reports.plan.chosen_study import StudyChoice, chosen_study
from reports.plan.grid import digest, grid, line_key
from reports.plan.requirements import left_out_note
from reports.plan.steps import FINER, RESOLUTION, coarsest
from reports.plan.study import Study, Variant, load_study
from reports.requests.sweep import SweepRequest, asked

TOML = """
scenes = ["fourbar-lecture-1"]
steps_per_turn = [90, 180.0]
turns = 3
[[variants]]
name = "stiff"
engine = "mujoco"
profile = "as-shipped"
settings = { solref_timeconst_steps = [2, 4], solimp_dmin = 0.9999 }
[[variants]]
engine = "pymunk"
profile = "tuned"
"""
FREE = """
scenes = ["fourbar-swing"]
free = true
dt_s = [2e-3, 1e-3]
duration_s = 0.5
[[variants]]
engine = "pymunk"
profile = "tuned"
"""
IS_FREE, TURN = "free = true", "steps_per_turn = [90]"


def written(folder: Path, name: str, text: str) -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def asked_for(**options: Any) -> Study:
    return asked(SweepRequest(Path("x"), **options))


def study_of(*variants: Variant, scene: str = "fourbar-lecture-1", **more: Any) -> Study:
    return Study(**{"scenes": [scene], "variants": variants, "steps_per_turn": [90.0]} | more)


TUNED = Variant(engine="pymunk", profile="tuned")


def test_toml_and_yaml_say_the_same(tmp_path: Path) -> None:
    left = load_study(written(tmp_path, "study.toml", TOML))
    assert left == load_study(written(tmp_path, "study.yaml", yaml.safe_dump(tomllib.loads(TOML))))
    assert left.turns == 3
    stiff = [f"stiff, solref_timeconst_steps={n}" for n in (2, 4)]
    assert [v.name for one in left.variants for v in one.each()] == [*stiff, "tuned"]


def test_the_shipped_study_is_large_and_its_lines_hold_cells_that_differ_in_step_only() -> None:
    laid = grid(load_study(None))
    cells = [task.cell for task in laid.tasks]
    assert len({cell.scene.name for cell in cells}) >= 6
    for engine in ("mujoco", "pymunk"):
        assert len({task.variant for task in laid.tasks if task.cell.engine == engine}) >= 4
    assert len({cell.steps_per_turn for cell in cells if cell.scene.name == "shaper"}) >= 6
    assert len({task.key for task in laid.tasks}) == len(laid.tasks)
    assert set(laid.texts) == {cell.scene.name for cell in cells}
    lines = {(t.line, t.cell.scene.name, t.cell.engine, t.variant) for t in laid.tasks}
    assert len({line for line, *_ in lines}) * 7 == len(lines) * 7 == len(laid.tasks)


def test_the_same_settings_under_two_names_are_one_cell() -> None:
    same = TUNED.model_copy(update={"settings": {"iterations": 150}, "name": "same"})
    assert [task.variant for task in grid(study_of(TUNED, same)).tasks] == ["tuned"]


def test_options_take_the_place_of_what_the_study_says() -> None:
    study = asked_for(scenes=["shaper"], engines=["pymunk"], steps_per_turn="90,99")
    assert (study.scenes, study.steps_per_turn) == (["shaper"], [90.0, 99.0])
    assert [variant.engine for variant in study.variants] == ["pymunk"] * 4
    assert asked_for() == load_study(None)
    profiles = asked_for(profiles=["tuned"]).variants
    assert [(v.engine, v.profile) for v in profiles] == [("mujoco", "tuned"), ("pymunk", "tuned")]
    extra = asked_for(engines=["pymunk", "exudyn"]).variants
    assert [v.profile for v in extra if v.engine == "exudyn"] == ["as-shipped", "tuned"]
    # --set makes one variant for each value.


def test_a_study_of_ones_own_names_the_engines_that_it_has() -> None:
    study = study_of(Variant(engine="exudyn", profile="tuned"), TUNED, scene="shaper")
    assert chosen_study(study, StudyChoice(), is_shipped=False).variants == study.variants
    with pytest.raises(CrankcheckError, match="--engine mujoco: the study has no variant of it"):
        chosen_study(study, StudyChoice(engines=["mujoco", "exudyn"]), is_shipped=False)
    study = asked_for(settings=["mujoco.iterations=1,2", "mujoco.solver=CG"])
    names = [one.name for variant in study.variants for one in variant.each()]
    assert names == [*(f"tuned, iterations={n}, solver=CG" for n in (1, 2)), "tuned"]
    tasks = grid(study.model_copy(update={"scenes": ["fourbar-lecture-1"]})).tasks
    assert {task.settings["iterations"] for task in tasks if task.cell.engine == "mujoco"} == {1, 2}


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"settings": ["iterations=2"]}, "write it like --set mujoco.iterations"),
        ({"settings": ["bullet.iterations=2"]}, "'bullet' is no engine of this"),
        ({"settings": ["mujoco.iteratoins=2"]}, "did you mean iterations"),
        ({"settings": ["mujoco.iterations=some"]}, "it takes a whole number"),
        ({"steps_per_turn": "90;180"}, "numbers with commas"),
        ({"steps_per_turn": "4"}, "a turn needs at least 8"),
        ({"steps_per_turn": "nan"}, "--steps-per-turn nan"),
        ({"turns": 0.0}, "--turns 0"),
        ({"profiles": ["tunde"]}, "none of that name"),
    ],
)
def test_what_can_not_be_run_is_said_before(options: dict[str, Any], words: str) -> None:
    with pytest.raises(CrankcheckError, match=words):
        grid(asked_for(**options))


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("s.json", "{}", r"use \.toml, \.yaml or \.yml"),
        ("s.yaml", "a: [", "not valid YAML"),
        ("s.yaml", "- 1", "a table of scenes, variants and steps_per_turn is needed"),
        ("s.toml", TOML.replace("turns", "truns"), r"truns: unknown key; did you mean turns\?"),
        ("s.toml", TOML.replace('"pymunk"', "3"), r"variants\.2\.engine"),
        ("s.toml", "scenes = []\nvariants = []\nsteps_per_turn = [1]", "variants"),
        ("s.toml", TOML.replace("solref_timeconst_steps = [2, 4]", "dt = []"), r"settings\.dt"),
        ("s.toml", TOML.replace("[2, 4]", "[1, false]"), r"settings\.solref_timeconst_steps"),
        ("f.toml", FREE.replace("dt_s = [2e-3, 1e-3]", ""), "dt_s: missing; add it"),
        ("f.toml", FREE.replace(IS_FREE, ""), "steps_per_turn: missing; add it"),
        ("f.toml", FREE.replace(IS_FREE, TURN), "dt_s: found it with free = false"),
        ("f.toml", f"{TURN}\n{FREE}", "steps_per_turn: found it with free = true"),
        ("f.toml", f'drive = "servo"\n{FREE}', "drive: found 'servo' with free = true"),
    ],
)
def test_faults_of_study_files_are_named(tmp_path: Path, name: str, text: str, words: str) -> None:
    path = written(tmp_path, name, text)
    with pytest.raises(CrankcheckError, match=words):
        load_study(path)
    path.unlink()
    with pytest.raises(CrankcheckError, match="not there; name a plain text file"):
        load_study(path.with_suffix(".toml"))


def test_turns_that_the_steps_do_not_divide_leave_one_line() -> None:
    study = study_of(TUNED, steps_per_turn=[90.0, 185.0, 365.0], turns=1.23)
    tasks = grid(study).tasks
    assert len({task.cell.turns for task in tasks}) == 3
    assert len({task.line for task in tasks}) == 1
    longer = grid(study.model_copy(update={"turns": 1.24})).tasks
    assert {task.line for task in longer} != {task.line for task in tasks}


@pytest.mark.parametrize(
    ("each", "words"),
    [
        ([{"name": "x"}, {"name": "x", "profile": "as-shipped"}], "two of pymunk have that name"),
        ([{"name": "tuned", "profile": "as-shipped"}], "that is the name of a profile"),
        ([{"name": "x", "settings": {"iterations": -1}}], "it takes 1 to 1e"),
    ],
)
def test_variants_that_would_mislead_are_refused(each: list[dict[str, Any]], words: str) -> None:
    with pytest.raises(CrankcheckError, match=words):
        grid(study_of(*(TUNED.model_copy(update=one) for one in each)))


def test_comments_make_no_other_scene_and_the_order_of_links_does() -> None:
    assert digest("a = 1.0 # one") == digest("# so\na   = 1.0")
    assert digest("a = 1.0") != digest("a = 1.1")
    assert digest("[a]\nx = 1\n[b]\nx = 2") != digest("[b]\nx = 2\n[a]\nx = 1")


def test_only_loads_and_friction_make_other_names_than_before_engines_took_them() -> None:
    """The name of the plain line is written out: stores hold it."""

    def named(scene: Scene) -> str:
        cell = Cell(scene, "mujoco", "tuned", dt_s=0.001, steps=9)
        return line_key(cell, 1.0, "text", "1.0", {"iterations": 100})

    plain = load_scene("slider-crank-central")
    assert named(plain) == "3826cae1ddfc672e0c9b4a5b4ef9995233b742dc"
    push = Load("push", "crank", None, Constant(1.0), "time")
    loaded = replace(plain, loads={"push": push})
    rubbing = replace(plain, friction={"A": ConstantFriction("A", 0.25)})
    both = replace(loaded, friction=rubbing.friction)
    assert len({named(each) for each in (plain, loaded, rubbing, both)}) == 4


def test_settings_of_beams_name_cells_of_beams_alone(tmp_path: Path) -> None:
    text = """
scenes = ["fourbar-lecture-1", "fourbar-elastic"]
steps_per_turn = [720]
segments = [4]
springs = ["plain", "beam"]
[[variants]]
engine = "exudyn"
profile = "tuned"
"""
    tasks = grid(load_study(written(tmp_path, "beams.toml", text))).tasks
    told = {(t.cell.scene.name, t.cell.springs, "beam_rounding" in t.settings) for t in tasks}
    plain = {(name, "plain", False) for name in ("fourbar-lecture-1", "fourbar-elastic")}
    assert told == plain | {("fourbar-elastic", "beam", True)}


def test_a_study_of_free_motion_lays_out_steps_in_seconds(tmp_path: Path) -> None:
    tasks = grid(load_study(written(tmp_path, "free.toml", FREE))).tasks
    laid = [(task.cell.drive, task.cell.dt_s, task.cell.steps) for task in tasks]
    assert laid == [("free", 2e-3, 250), ("free", 1e-3, 500)]
    assert len({task.line for task in tasks}) == 1
    longer = grid(load_study(written(tmp_path, "free.toml", FREE.replace("0.5", "0.6")))).tasks
    assert longer[0].line != tasks[0].line


def test_elastic_links_are_swept_over_steps_that_their_segments_hold() -> None:
    choice = StudyChoice(["fourbar-elastic"], ["mujoco"], ["tuned"], segments=[4, 6])
    for chosen, steps in (
        ([], {4: [720, 1440, 2880], 6: [1080, 2160, 4320]}),
        ([720.0, 1440.0], {4: [720, 1440], 6: [720, 1440]}),
    ):
        one = replace(choice, steps_per_turn=chosen)
        found: dict[int, list[int]] = {4: [], 6: []}
        for task in grid(chosen_study(load_study(None), one, is_shipped=True)).tasks:
            found[task.cell.segments].append(round(task.cell.steps_per_turn))
        assert found == steps


def test_what_a_kind_has_for_the_reference_alone_is_left_out_with_a_note() -> None:
    note = left_out_note(["forces", "shaper"])
    assert note.startswith("slider-crank-self-locking: left out, as no engine here has friction")
    assert left_out_note(["forces", "slider-crank-self-locking"]) == ""
    assert left_out_note(["kinematics", "shaper"]) == left_out_note(()) == ""
    note = left_out_note(["elastic"])
    assert "fourbar-elastic-controlled and fourbar-elastic-pulse: left out" in note
    assert "name them to run them" in note


LEAST, MOST = 40, 50_000


def look(
    error: Callable[[int], float], target: float, start: int = 160, most: int = MOST
) -> tuple[int | None, dict[int, float]]:
    """The search, which has to call for each step once only, and all its errors."""
    errors: dict[int, float] = {}

    def kept(steps: int) -> float:
        assert steps not in errors
        errors[steps] = error(steps)
        return errors[steps]

    steps = coarsest(kept, target, start, LEAST, most)
    assert min(errors) >= LEAST
    assert max(errors) <= math.ceil(FINER[-1] * most)
    return steps, errors


@pytest.mark.parametrize("order", [1.0, 2.0, 4.0])
@pytest.mark.parametrize("start", [40, 160, 20_000])
@pytest.mark.parametrize("exact", [97, 1000, 9000])
def test_finds_the_step_of_a_power_law_in_few_runs(order: float, start: int, exact: int) -> None:
    steps, errors = look(lambda n: (exact / n) ** order, 1.0, start)
    assert exact <= steps <= max(exact + 1, RESOLUTION * exact)
    assert len(errors) <= (8 if start < 20_000 else 13)


def test_gives_up_at_a_floor_long_before_the_finest_step_and_where_that_is_too_coarse() -> None:
    steps, errors = look(lambda n: 1e-3 + 1.0 / n**2, 1e-6)
    assert steps is None
    assert max(errors) < MOST
    assert min(errors.values()) == pytest.approx(1e-3, rel=1e-3)
    steps, errors = look(lambda n: (9000 / n) ** 2, 1.0, most=5000)
    assert steps is None
    assert errors[5000] == min(errors.values()) == pytest.approx(3.24)


def test_takes_no_step_by_accident() -> None:
    """The fewest that are allowed, none where errors cancel, and no coarser where runs came apart,
    at finer steps too."""
    assert look(lambda n: 1e-9, 1.0)[0] == LEAST
    steps, _ = look(lambda n: (2000 / n) ** 2 * (1e-3 if 150 <= n <= 170 else 1.0), 1.0)
    assert 2000 <= steps <= 2000 * RESOLUTION
    assert look(lambda n: math.nan if n > 300 else (200 / n) ** 2, 1.0)[0] is None
    steps, _ = look(lambda n: math.nan if n < 700 else (500 / n) ** 2, 1.0)
    assert 700 <= steps <= 701 * RESOLUTION
