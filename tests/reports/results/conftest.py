"""Runs that were really made, and cells made up."""

from tests.worlds.stored_runs import made_cell, made_run, store, stored, swept, verified

__all__ = ["made_cell", "made_run", "store", "stored", "swept", "verified"]
