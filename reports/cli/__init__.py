"""The command line. What a command needs is imported inside it: `--help` loads no engine."""

from reports.cli import checking, measuring, own_log, showing
from reports.cli.application import app, guarded, main

__all__ = ["app", "checking", "guarded", "main", "measuring", "own_log", "showing"]
