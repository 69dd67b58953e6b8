"""Loads that a scene can not have, or not for so long: one message and exit code 2, whatever the
command, and nothing written."""

from __future__ import annotations

import pytest

from models.files import shipped
from tests.worlds.fuzzing import attempt

TEXT = shipped("forces")["toggle-press"].read_text(encoding="utf-8")
RUNS = (
    "verify FILE --engine mujoco -o OUT",
    "sweep FILE --engine mujoco -o OUT",
    "tune FILE --engine mujoco --target 1e-4 --budget 1",
)
COMMANDS = (*RUNS, "solve FILE", "run FILE --engine mujoco", "export FILE", "view FILE -o OUT.png",
            "cycle FILE -o OUT.csv", "flywheel FILE --delta 0.02 --write OUT.toml",
            "advise FILE --dt 1e-3 --speed 6.0 --target 1e-4")  # fmt: skip
FAULTS = {
    "no such point": (
        'block = "E"\n', 'link = "lower"\npoint = "Z"\n', "loads.work.point: lower has no point Z",
    ),
    "falling places": ("0.0469, 0.0499", "0.0499, 0.0469", "found 0.0469 after 0.0499"),
    "a row too few": ("0.0469, 0.0499", "0.0469", "found 4 places and 5 values"),
    "the ground": ('block = "E"\n', 'link = "ground"\npoint = "D"\n', "loads.work.link: found gro"),
}  # fmt: skip


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_of_a_load_is_one_message(fault: str, command: str) -> None:
    old, new, words = FAULTS[fault]
    assert old in TEXT
    _refused(TEXT.replace(old, new, 1), command, words)


@pytest.mark.parametrize("command", RUNS)
def test_a_table_shorter_than_the_motion_is_refused_before_anything_runs(command: str) -> None:
    over = r"loads.work: over the displacement [m] the table goes from -0.05 to 0.0499, and 0.04993"
    short = TEXT.replace("0.0499, 0.055]", "0.0499]", 1).replace("1e5, 1e5]", "1e5]", 1)
    _refused(short, command, over)
    timed = TEXT[: TEXT.index("[loads.work]")] + TIMED
    _refused(timed, command, "loads.pull: over the time [s] the table goes from 0 to 0.1, and ")


TIMED = """[loads.pull]
link = "crank"
law = "table"
over = "time"
interpolation = "linear"
at_s = [0.0, 0.1]
torque_n_m = [1.0, 2.0]
"""


def _refused(text: str, command: str, words: str) -> None:
    ended = attempt(text.encode(), *command.split())
    assert ended.faults == []
    assert (ended.code, ended.output, ended.files) == (2, "", ())
    assert words in " ".join(ended.errors.split())
