"""Scene files: what ships loads; all faults of a file at once, and files that are none."""

import cProfile
import math
import os
import pickle
import re
from pathlib import Path
from unittest import mock

import pytest

from models.errors import CrankcheckError, SceneError
from models.files.inputs import MOST_TEXT
from models.files.reading import (
    find_scenes,
    kinds,
    load_scene,
    names_of_scenes,
    parse_scene,
    read_scene,
    reference_alone,
    run_where_named,
    scene_texts,
    shipped,
)
from models.scene.laws import Oscillating

GOOD = """
name = "good"
source = "a test"
[ground]
points = { A = [0.0, 0.0], D = [0.3, 0.0] }
[links]
crank = { bar = ["A", "B"], length_m = 0.1 }
coupler = { bar = ["B", "C"], length_m = 0.25 }
rocker = { bar = ["D", "C"], length_m = 0.2 }
[driver]
link = "crank"
speed_rad_s = 10.0
start_deg = 90.0
"""


def test_kinds_have_names_of_their_own_and_mean_their_scenes_but_those_run_where_named() -> None:
    names = [name for kind in kinds() for name in shipped(kind)]
    assert len(set(names)) == len(names)
    assert not set(kinds()) & set(names)
    assert kinds()[0] == "kinematics"
    assert len(shipped()) >= 18
    several = ["shaper", "forces", "toggle-press", "shaper"]
    engines_are_given = [n for n in shipped("forces") if n not in run_where_named("forces")]
    assert names_of_scenes(several) == ["shaper", *engines_are_given]
    assert names_of_scenes("kinematics") == list(shipped())
    assert scene_texts(()).keys() == scene_texts("kinematics").keys() == shipped().keys()
    assert list(scene_texts("forces")) == engines_are_given
    assert [path.stem for path in find_scenes("forces")] == engines_are_given
    assert run_where_named("kinematics") == []
    assert run_where_named("forces") == reference_alone("forces") == ["slider-crank-self-locking"]
    assert run_where_named("elastic") == ["fourbar-elastic-controlled", "fourbar-elastic-pulse"]
    assert reference_alone("elastic") == []
    named = names_of_scenes(["forces", "slider-crank-self-locking"])
    assert named[-1] == "slider-crank-self-locking"


def test_what_is_short_or_left_out_is_filled_in() -> None:
    """A bar lies on the x-axis, and is a slender rod of one kilogram per metre; angles of the file
    are degrees."""
    scene = parse_scene(GOOD, "good")
    link = scene.links["coupler"]
    assert link.points == {"B": (0.0, 0.0), "C": (0.25, 0.0)}
    assert (link.mass_kg, link.centre_m) == (0.25, (0.125, 0.0))
    assert link.inertia_kg_m2 == pytest.approx(0.25 * 0.25**2 / 12, rel=1e-15)
    theta, omega, _ = scene.driver.law.at(0.0)
    assert (theta, omega) == (math.pi / 2, 10.0)


def test_all_faults_of_a_file_are_reported_at_once_and_very_many_counted() -> None:
    text = GOOD.replace("length_m = 0.25", "length_m = -1").replace("start_deg", "start")
    text = text.replace('link = "crank"', 'link = "krank"') + "[branch]\nZ = 1\n"
    with pytest.raises(SceneError) as error:
        parse_scene(text, "file.toml")
    assert len(error.value.faults) == 4
    for part in (
        "driver.link: found krank; use one of crank", "branch.Z", "links.coupler.length_m",
        "driver.start: unknown key; did you mean start_deg",
    ):  # fmt: skip
        assert part in str(error.value)
    text = GOOD + "".join(f"x{i} = 1\n" for i in range(1000))
    with pytest.raises(SceneError) as error:
        parse_scene(text, "file.toml")
    assert len(error.value.faults) == 1000
    assert str(error.value).endswith("driver.x19: unknown key; known: link, pin, links, law, "
                                     "speed_rad_s, start_deg\n  and 980 more")  # fmt: skip


@pytest.mark.parametrize("table", [
    '[sliders.C]\non = ["ground"]\npoint = ["C"]',
    "[branch]\n" + "x" * 10_000 + " = 1",
    '[sliders.C]\non = "' + "x" * 10_000 + '"',
])  # fmt: skip
def test_names_of_any_shape_are_faults_with_short_messages(table: str) -> None:
    with pytest.raises(SceneError) as error:
        parse_scene(f"{GOOD}\n{table}\n", "file.toml")
    assert max(len(fault) for fault in error.value.faults) < 400


@pytest.mark.parametrize("part", ["a.", '"a".', "'a' . ", r'"a\".b".', "a\t.", "-."])
@pytest.mark.parametrize("head", ["", " ", "[", "[[ ", "x = { "])
def test_key_of_very_many_parts_is_a_fault_before_it_fills_memory(head: str, part: str) -> None:
    with pytest.raises(SceneError, match="line 2: a key of more than 10 parts"):
        parse_scene("# deep\n" + head + 1000 * part, "file.toml")


@pytest.mark.parametrize("text", ['"\\' * 90_000, "x." * 9 + "\n", "a" + " " * 190_000], ids=len)
def test_a_file_without_a_deep_key_is_looked_through_at_once(text: str) -> None:
    """A search that went back over them would be at it for minutes or for ever."""
    with pytest.raises(SceneError, match="not valid TOML"):
        parse_scene(text, "file.toml")


@pytest.mark.parametrize(
    ("head", "most"), [("[links.many.points]", 100), ("[ground.points]", 1000)]
)
def test_more_points_than_can_be_compared_are_a_fault(head: str, most: int) -> None:
    """In calls that grow as the points do, and not as their pairs."""
    text = GOOD.replace("[ground]\npoints =", "#") if "ground" in head else GOOD
    calls = []
    for count in (1100, 2200):
        points = "".join(f"P{i} = [{i}.0, 0.0]\n" for i in range(count))
        refused = pytest.raises(SceneError, match=rf"points: found .* at most {most} items")
        with cProfile.Profile() as counter, refused:
            parse_scene(f"{text}\n{head}\n{points}", "file.toml")
        calls.append(sum(entry.callcount for entry in counter.getstats()))
    assert calls[1] < 2.5 * calls[0]


@pytest.mark.parametrize("acting", ["\u202e", "\x1b[2J", "\ufeff", "\x9b", "\u2028", "\ud800"])
def test_what_acts_on_a_terminal_is_shown_as_an_escape(acting: str) -> None:
    assert str(CrankcheckError(f"a{acting}b")) == f"a{ascii(acting)[1:-1]}b"
    error = SceneError(f"a{acting}\nb", ["c"])
    assert str(error) == f"a{ascii(acting)[1:-1]}\\nb: c"
    copied = pickle.loads(pickle.dumps(error))
    assert (str(copied), copied.faults) == (str(error), error.faults)


@pytest.mark.parametrize("key", ["links", "ground", "driver", "branch", "sliders"])
def test_table_that_is_none_is_a_fault(key: str) -> None:
    text = re.sub(rf"\[{key}\].*?(?=\n\[|$)", "", GOOD, flags=re.DOTALL)
    with pytest.raises(SceneError) as error:
        parse_scene(f"{key} = 3\n{text}", "file.toml")
    assert f"{key}: found 3" in str(error.value)


@pytest.mark.parametrize(("name", "words"), [
    ("fourbar-lectur-1", "Did you mean fourbar-lecture-"),
    ("qqqqqqqq", "crankcheck scenes"),
    ("forces", "'forces': a kind of scenes; name one: compressor"),
    *((name, "scene") for name in ("x" * 10_000, "a\0b", "", "\u202egnp.exe")),
])  # fmt: skip
def test_a_name_of_no_scene_suggests_the_near_ones_or_the_list(name: str, words: str) -> None:
    with pytest.raises(CrankcheckError, match=words) as error:
        load_scene(name)
    assert len(str(error.value)) < 300


def test_a_file_that_can_not_be_read_says_why(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "scene.toml"
    for raw, words in (
        (b"\xff\xfe\x00", "not UTF-8"),
        (b"#" * (MOST_TEXT + 1), "200001 bytes; at most 200000 are read"),
    ):
        path.write_bytes(raw)
        with pytest.raises(SceneError, match=words):
            read_scene(path)
    path.write_text(GOOD, encoding="utf-8-sig")
    assert read_scene(path).name == "good"
    with pytest.raises(SceneError, match="a folder; name a plain text file"):
        load_scene(str(tmp_path))
    refuse = mock.Mock(side_effect=PermissionError(13, "Permission denied"))
    monkeypatch.setattr(os, "open", refuse)
    with pytest.raises(SceneError, match="can not be read: Permission denied"):
        read_scene(path)


def test_whole_turns_in_a_file_take_no_digits_off_its_angles() -> None:
    """Of lines, of links on them and of phases; a driver starts where it is told, turns and all."""
    text = """
name = "turns"
source = "test"
ground.points = {{ A = [0.0, 0.0] }}
sliders.C = {{ on = "ground", link = "ram", direction_deg = {line}, angle_deg = {lean} }}
[links]
crank = {{ bar = ["A", "B"], length_m = 0.1 }}
rod = {{ bar = ["B", "C"], length_m = 0.3 }}
ram = {{ bar = ["C", "E"], length_m = 0.1 }}
[driver]
link = "crank"
law = "oscillating"
centre_deg = {centre}
amplitude_deg = 500.0
frequency_rad_s = 2.0
phase_deg = {phase}
"""
    one, other = (
        parse_scene(text.format(line=line, lean=lean, phase=phase, centre=720.0), "test")
        for line, lean, phase in (
            (30.25 + 360 * 2777, -45.5 - 360 * 2776, 7.0 + 360 * 1000),
            (30.25, -45.5, 7.0),
        )
    )
    assert one == other
    law = one.driver.law
    assert isinstance(law, Oscillating)
    assert law.centre_rad == 2.0 * math.tau
