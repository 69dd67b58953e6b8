"""The command line. What a command needs is imported inside it: `--help` loads no engine."""

from reports.cli import checking

# isort: split
from reports.cli import changes, measuring

# isort: split
from reports.cli import judging, showing  # --help lists commands in the order of these lines

# isort: split
from reports.cli import (
    drawing_polygons,
    drawing_sheets,
    graph_sheets,
    regulating,
    structures,
    synthesising,
    vibrating,
)

# isort: split
from reports.cli import recipes, schemes
from reports.cli.application import app, guarded, main

__all__ = [
    "app",
    "changes",
    "checking",
    "drawing_polygons",
    "drawing_sheets",
    "graph_sheets",
    "guarded",
    "judging",
    "main",
    "measuring",
    "recipes",
    "regulating",
    "schemes",
    "showing",
    "structures",
    "synthesising",
    "vibrating",
]
