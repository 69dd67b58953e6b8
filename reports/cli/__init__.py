"""The command line; a command is imported when it is called, and `--help` loads no engine."""

from reports.cli.application import app, guarded, main

__all__ = ["app", "guarded", "main"]
