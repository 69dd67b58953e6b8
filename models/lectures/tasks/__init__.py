"""Task files: shipped ones of each kind, and a user's own."""

from collections.abc import Mapping
from pathlib import Path

from models.errors import CrankcheckError, suggestion
from models.files.faults import read_table
from models.lectures.shipped_tables import TaskTable, find_table, shipped_in
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
"""Kinds of synthesis, and the tables of their files."""


def shipped_tasks() -> dict[str, list[str]]:
    """Return the names of the tasks that come with crankcheck, by kind."""
    return {kind: list(shipped_in(TASKS / kind)) for kind in KINDS}


def refuse_unknown(kind: str) -> None:
    """Refuse an unknown kind; the message suggests the near ones. Raises CrankcheckError."""
    if kind not in KINDS:
        hint = suggestion(kind, KINDS, "there are", 2)
        raise CrankcheckError(f"kind of synthesis: no {kind!r}; {hint}")


def find_task(kind: str, name_or_path: str) -> Path:
    """Find the file of a task. Raises CrankcheckError for another kind, or where there is none."""
    refuse_unknown(kind)
    return find_table(name_or_path, TASKS / kind, f"{kind} task", "crankcheck synth")


def load_task(kind: str, name_or_path: str) -> TaskTable:
    """Load a shipped task by name, or a task of a file. Raises CrankcheckError for an unknown kind
    or task, and SceneError for a file with faults, all in one message."""
    return read_table(find_task(kind, name_or_path), KINDS[kind])
