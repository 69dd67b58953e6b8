"""Friction: what a scene file says of it, and what is refused."""

from __future__ import annotations

import pytest

from models.errors import SceneError
from models.files import parse_scene
from models.friction import ConstantFriction, CoulombFriction
from models.scene_text import scene_text

RUBBING = """
name = "rubbing"
source = "a test"
[ground]
points = { A = [0.0, 0.0] }
[links]
crank = { bar = ["A", "B"], length_m = 0.1 }
rod = { bar = ["B", "C"], length_m = 0.3 }
[sliders.piston]
point = "C"
on = "ground"
mass_kg = 0.5
[driver]
link = "crank"
speed_rad_s = 10.0
[friction.A]
torque_n_m = 0.2
[friction.B]
mu = 0.1
radius_m = 0.01
[friction.C]
mu = 0.0
radius_m = 0.02
[friction.piston]
force_n = 3.0
"""


def test_every_kind_of_friction_is_read() -> None:
    """The pin C and the slider on it have names of their own."""
    friction = parse_scene(RUBBING, "rubbing").friction
    assert dict(friction) == {
        "A": ConstantFriction("A", 0.2),
        "B": CoulombFriction("B", 0.1, 0.01),
        "C": CoulombFriction("C", 0.0, 0.02),
        "piston": ConstantFriction("piston", 3.0),
    }
    slides = parse_scene(RUBBING.replace("force_n = 3.0", "mu = 0.3"), "rubbing").friction
    assert slides["piston"] == CoulombFriction("piston", 0.3)


@pytest.mark.parametrize("of_slider", ["force_n = 3.0", "mu = 0.3"])
def test_friction_reads_back_as_itself(of_slider: str) -> None:
    scene = parse_scene(RUBBING.replace("force_n = 3.0", of_slider), "rubbing")
    again = parse_scene(scene_text(scene), "again")
    assert again == scene
    assert list(again.friction) == list(scene.friction)


FAULTS = {
    "negative": ("mu = 0.1", "mu = -0.1", "friction.B.mu: found -0.1; use a number of at least 0"),
    "not a number": ("mu = 0.1", "mu = nan", "friction.B.mu: found nan"),
    "endless": ("mu = 0.1", "mu = inf", "friction.B.mu: found inf"),
    "text": ("mu = 0.1", 'mu = "0.1"', "friction.B.mu: found '0.1'"),
    "no radius": ("radius_m = 0.01", "", "friction.B.radius_m: missing; mu of a pin acts at its"),
    "radius of 0": ("radius_m = 0.01", "radius_m = 0.0", "friction.B.radius_m: found 0.0"),
    "radius alone": ("mu = 0.1\n", "", "friction.B: radius_m is that of a pin with mu, which is"),
    "two kinds": ("mu = 0.1", "mu = 0.1\ntorque_n_m = 1.0", "friction.B: found mu and torque_n_m"),
    "no kind": ("torque_n_m = 0.2", "", "friction.A: found none of them; give one of mu"),
    "negative torque": ("torque_n_m = 0.2", "torque_n_m = -1.0", "friction.A.torque_n_m: found -1"),
    "no joint": ("friction.B", "friction.Q", "friction.Q: no joint of two bodies has that name; "
                 "use one of A, B, C, piston"),
    "force in a pin": ("torque_n_m = 0.2", "force_n = 0.2", "friction.A.force_n: belongs to a sl"),
    "torque in a slider": (
        "force_n = 3.0", "torque_n_m = 3.0", "friction.piston.torque_n_m: belongs to a pin",
    ),
    "radius in a slider": (
        "force_n = 3.0", "mu = 0.1\nradius_m = 0.01", "friction.piston.radius_m: belongs to a pin",
    ),
    "unknown key": ("radius_m", "radus_m", "friction.B.radus_m: unknown key; did you mean r"),
    "no table": ("[friction.A]\ntorque_n_m = 0.2", "[friction]\nA = 0.2", "friction.A: found 0.2"),
    "a pin of three": (
        "[sliders", 'door = { bar = ["B", "E"], length_m = 0.3 }\n[sliders',
        "friction.B: 3 bodies meet at B",
    ),
}  # fmt: skip


@pytest.mark.parametrize("fault", FAULTS)
def test_friction_that_can_not_be_is_refused(fault: str) -> None:
    old, new, words = FAULTS[fault]
    text = RUBBING.replace(old, new, 1)
    with pytest.raises(SceneError) as error:
        parse_scene(text, "rubbing.toml")
    assert words in str(error.value)


def test_all_faults_of_friction_are_told_at_once() -> None:
    text = RUBBING.replace("friction.A", "friction.Q").replace("mu = 0.1", "mu = nan")
    text = text.replace("force_n = 3.0", "torque_n_m = 3.0").replace("mu = 0.0\n", "")
    with pytest.raises(SceneError) as error:
        parse_scene(text, "rubbing.toml")
    told = "\n".join(error.value.faults)
    for key in ("friction.Q: no joint", "friction.B.mu: found nan", "friction.piston.torque_n_m",
                "friction.C: radius_m"):  # fmt: skip
        assert key in told
