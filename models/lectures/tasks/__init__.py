"""Task files: the shipped ones of each kind, and a user's own."""

from collections.abc import Mapping
from pathlib import Path

from models.errors import CrankcheckError, suggestion
from models.lectures.shipped_tables import TaskTable, find_table, read_table, shipped_in
from models.lectures.tasks.curves import FunctionTable, PathTable, StraightLineTable
from models.lectures.tasks.positions import CouplerTask, QuickReturnTask, RockerTask, StrokeTask

TASKS = Path(__file__).parents[2] / "task_files"
KINDS: Mapping[str, type[TaskTable]] = {
    "coupler": CouplerTask,
    "rocker": RockerTask,
    "stroke": StrokeTask,
    "quick-return": QuickReturnTask,
    "function": FunctionTable,
    "path": PathTable,
    "straight-line": StraightLineTable,
}
"""What can be asked for, and the table of its file."""


def shipped_tasks() -> dict[str, list[str]]:
    """The names of the tasks that come with crankcheck, by kind."""
    return {kind: list(shipped_in(TASKS / kind)) for kind in KINDS}


def refuse_unknown(kind: str) -> None:
    """Raise CrankcheckError for what is no kind; the message suggests the near ones."""
    if kind not in KINDS:
        hint = suggestion(kind, KINDS, "there are", 2)
        raise CrankcheckError(f"kind of synthesis: no {kind!r}; {hint}")


def find_task(kind: str, name_or_path: str) -> Path:
    """The file of a task. Raises CrankcheckError for another kind, or where there is none."""
    refuse_unknown(kind)
    return find_table(name_or_path, TASKS / kind, f"{kind} task", "crankcheck synth")


def load_task(kind: str, name_or_path: str) -> TaskTable:
    """A shipped task by name, or one of a file.

    Raises
    ------
    CrankcheckError
        An unknown kind, or nothing there.
    SceneError
        A file with faults, all that were found in one message.
    """
    return read_table(find_task(kind, name_or_path), KINDS[kind])
