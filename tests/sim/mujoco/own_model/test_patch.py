"""The recommended settings as a diff: applied to the very file it gives the recommended model."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import mujoco  # type: ignore[import-untyped]  # ships no stubs
import numpy as np
import pytest

from models.errors import EngineError
from sim.mujoco.own_model.patch import RecommendedAttributes, advice, patched
from sim.mujoco.own_model.read import ReadModel, read_model
from sim.mujoco.own_model.variants import RECOMMENDED, applied, profiles
from sim.own_models import Advised
from tests.worlds.own_four_bar import CLOSED, planted

PLAIN = planted(
    ' integrator="RK4"', "", ' tolerance="1e-16"', "",
    '<equality solref="0.005 0.6" solimp="0.9999 0.9999 0.001 0.5 2"/>', "",
)  # fmt: skip
"""As most models are: MuJoCo's own settings."""
BOUND = '<equality><connect body1="coupler" body2="rocker" anchor="0 0 0"/></equality>'
FORMS = {
    "plain": PLAIN,
    "windows": PLAIN.replace("\n", "\r\n"),
    "mark": "\ufeff" + PLAIN,
    "no final newline": PLAIN.rstrip("\n"),
    "one line": PLAIN.replace("\n", " "),
    "single quotes": PLAIN.replace('"', "'"),
    "no option": PLAIN.replace('<option timestep="0.001" gravity="0 0 0"/>', ""),
    "comments": PLAIN.replace("<worldbody>", f"<!-- {BOUND}<option/> --><worldbody>"),
    "larger than": PLAIN.replace('name="C"', 'name="C > > />"'),
    "two options": PLAIN.replace("<worldbody>", '<option integrator="Euler"/><worldbody>'),
    "a flag": PLAIN.replace(
        'gravity="0 0 0"/>', 'gravity="0 0 0"><flag energy="enable"/></option>'
    ),
    "two equalities": PLAIN.replace(
        "<equality>", '<equality><connect body1="crank" anchor="0 0 0"/></equality><equality>'
    ),
    "settings": PLAIN.replace('name="C"', 'name="C" solref = "0.03 1" solimp=\'0.9 0.95 0.001\''),
    "a class": PLAIN.replace(
        "</default>",
        '<default class="soft"><equality solref="0.1 1"></equality></default></default>',
    ).replace('name="C"', 'name="C" class="soft"'),
    "broken tag": PLAIN.replace('body1="coupler"', '\n   body1="coupler"\n'),
    "letters": PLAIN.replace('model="four-bar"', 'model="vierg\u00e9lenk \u2028 \x85"'),
    "recommended already": planted(),
}


def read(path: Path, text: str) -> ReadModel:
    path.write_bytes(text.encode())
    return read_model(path, "A")


def wanted(own: ReadModel, dt_s: float, advised: Advised) -> mujoco.MjModel:
    """The model with what the line `recommended` sets."""
    line = profiles((), advised)[RECOMMENDED]
    settings = {name: setting.value for name, setting in line.settings.items()}
    model = mujoco.MjModel.from_xml_path(str(own.path))
    applied(model, own.planar.loops, settings, dt_s)
    return model


def assert_alike(found: mujoco.MjModel, model: mujoco.MjModel) -> None:
    for name in ("timestep", "integrator", "tolerance", "disableflags", "enableflags", "solver"):
        assert getattr(found.opt, name) == getattr(model.opt, name), name
    np.testing.assert_array_equal(found.eq_solref, model.eq_solref)
    np.testing.assert_array_equal(found.eq_solimp, model.eq_solimp)
    np.testing.assert_array_equal(found.body_pos, model.body_pos)


@pytest.mark.skipif(shutil.which("patch") is None, reason="the program patch is not there")
@pytest.mark.parametrize("off", [False, True])
@pytest.mark.parametrize("form", FORMS)
def test_the_program_patch_takes_it(form: str, off: bool, tmp_path: Path) -> None:
    own = read(tmp_path / "model.xml", FORMS[form])
    text = own.patch(0.001, Advised(contacts_off=off))
    expected = wanted(own, 0.001, Advised(contacts_off=off))
    assert text.startswith("--- model.xml\n+++ model.xml\n@@ ")
    done = subprocess.run(
        ["patch", "--binary", "model.xml"],
        input=text.encode(),
        cwd=tmp_path,
        capture_output=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout
    assert b"fuzz" not in done.stdout
    assert_alike(mujoco.MjModel.from_xml_path(str(own.path)), expected)
    assert ("\r\n" in FORMS[form]) == (b"\r\n" in own.path.read_bytes())


@pytest.mark.skipif(shutil.which("git") is None, reason="git is not there")
def test_git_takes_it_and_another_file_is_refused(tmp_path: Path) -> None:
    own = read(tmp_path / "model.xml", PLAIN)
    text = own.patch(0.001, Advised())
    expected = wanted(own, 0.001, Advised())
    apply = ["git", "apply", "-"]
    subprocess.run(apply, input=text.encode(), cwd=tmp_path, check=True, capture_output=True)
    assert_alike(mujoco.MjModel.from_xml_path(str(own.path)), expected)
    again = subprocess.run(
        apply, input=text.encode(), cwd=tmp_path, check=False, capture_output=True
    )
    assert again.returncode != 0


def test_nothing_else_of_the_file_changes(tmp_path: Path) -> None:
    own = read(tmp_path / "model.xml", PLAIN)
    lines = own.patch(0.001, Advised()).splitlines()
    removed = [line for line in lines if line.startswith("-") and not line.startswith("---")]
    assert [line[1:].strip() for line in removed] == [
        '<option timestep="0.001" gravity="0 0 0"/>',
        CLOSED,
    ]


def test_only_a_step_that_was_asked_for_is_written(tmp_path: Path) -> None:
    own = read(tmp_path / "model.xml", PLAIN)
    assert "timestep" not in advice(own.planar.model, 0.001, Advised()).option
    assert advice(own.planar.model, 0.0005, Advised()).option["timestep"] == "0.0005"


def test_a_finer_tolerance_of_the_user_stays(tmp_path: Path) -> None:
    fine = PLAIN.replace('timestep="0.001"', 'timestep="0.001" tolerance="1e-20"')
    own = read(tmp_path / "model.xml", fine)
    assert "tolerance" not in advice(own.planar.model, 0.001, Advised()).option
    assert float(wanted(own, 0.001, Advised()).opt.tolerance) == 1e-20


@pytest.mark.parametrize("place", ["before", "after"])
def test_what_an_include_overrides_is_said_in_words(place: str, tmp_path: Path) -> None:
    (tmp_path / "more.xml").write_text('<mujoco><option integrator="Euler"/></mujoco>')
    mark = "<default>" if place == "before" else "<worldbody>"
    text = PLAIN.replace(mark, '<include file="more.xml"/>' + mark)
    said = read(tmp_path / "model.xml", text).patch(0.001, Advised())
    assert said.startswith("what it includes overrides the file itself: set in <option>: integr")


def test_equalities_of_another_file_are_said_in_words(tmp_path: Path) -> None:
    (tmp_path / "more.xml").write_text(f"<mujoco><equality>{CLOSED}</equality></mujoco>")
    text = PLAIN.replace(CLOSED, "").replace("</mujoco>", '<include file="more.xml"/></mujoco>')
    said = read(tmp_path / "model.xml", text).patch(0.001, Advised(contacts_off=True))
    assert said.startswith("0 of its 1 equalities stand in the file itself: set in <option>:")
    assert 'in its <flag>: contact="disable"' in said
    assert 'solref="0.005 0.6"' in said


def test_a_file_in_another_encoding_is_said_in_words(tmp_path: Path) -> None:
    path = tmp_path / "model.xml"
    head = '<?xml version="1.0" encoding="ISO-8859-1"?>'
    path.write_bytes((head + PLAIN.replace('"four-bar"', '"viergl\u00e9"')).encode("latin-1"))
    said = read_model(path, "A").patch(0.001, Advised())
    assert said.startswith("the file is not UTF-8: set in <option>")


def test_more_equalities_than_the_text_has_are_an_error() -> None:
    with pytest.raises(EngineError, match="1 of its 2 equalities"):
        patched(PLAIN.encode(), [0], 2, RecommendedAttributes({}, {}, {}))


def test_the_numbers_to_paste_are_those_that_are_run(tmp_path: Path) -> None:
    own, dt_s = read(tmp_path / "model.xml", PLAIN), 1.0 / 3000.0
    text = own.patch(dt_s, Advised())
    assert 'solref="0.00166667 0.6"' in text
    assert f'timestep="{dt_s!r}"' in text
    assert tuple(wanted(own, dt_s, Advised()).eq_solref[0]) == (0.00166667, 0.6)
