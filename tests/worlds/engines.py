"""Engines that the tests run: those that are installed here, and those among them that also write
snippets and recipes, whose tests go deep."""

from sim.registry import available, offering

HERE = [one.name for one in available() if one.version]
FULL = [name for name in HERE if name in offering("snippet")]
SIMPLE = [name for name in HERE if name not in FULL]
