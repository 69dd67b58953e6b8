"""`import crankcheck`: a light face, of which every name is there."""

from __future__ import annotations

import ast
import inspect
import json
import re
import subprocess
from pathlib import Path

import pytest

import crankcheck
from crankcheck import testing as crankcheck_testing
from tests.worlds.command import COMMAND, PYTHON, script

STAGES = """
import json, sys
before, calls = set(sys.modules), 0
def count(frame, event, argument):
    global calls
    calls += event == "call"
sys.setprofile(count)
import crankcheck
sys.setprofile(None)
first = sorted(set(sys.modules) - before)
from reports.requests import verify
request = [name for name in sys.modules if name == "scipy" or ".lectures" in name]
from crankcheck import *
assert set(crankcheck.__all__) <= set(globals())
assert dir(crankcheck) == sorted(crankcheck.__all__)
from crankcheck.testing import assert_within
every = [name for name in ("mujoco", "pymunk", "pandas") if name in sys.modules]
print(json.dumps([first, calls, request, every]))
"""
"""What is loaded after each of three imports, in one process: the package, a request, and all
names."""


def printed(*command: str) -> str:
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


def test_importing_it_or_one_request_loads_hardly_anything() -> None:
    first, calls, request, every = json.loads(printed(PYTHON, "-P", "-c", script(STAGES)))
    assert first == ["crankcheck"]
    assert calls < 1000  # 193; what numpy or typer take is a hundred thousand
    assert request == []  # verifying loads no lectures and nothing of scipy
    assert every == []  # every name is there, and loads no engine and no table


def test_every_function_says_what_its_arguments_are() -> None:
    functions = [getattr(crankcheck, name) for name in crankcheck.__all__ if name.islower()]
    for function in [*filter(inspect.isfunction, functions), crankcheck_testing.assert_within]:
        text = inspect.getdoc(function) or ""
        for name in inspect.signature(function).parameters:
            assert re.search(rf"\b{name}\b", text), f"{function.__name__}: {name}"
        assert "Raises" in text


def test_a_type_checker_sees_what_is_there_and_a_name_that_is_not_is_no_attribute() -> None:
    tree = ast.parse(Path(crankcheck.__file__).read_text(encoding="utf-8"))
    blocks = (node for node in tree.body if isinstance(node, ast.If))
    (shown,) = (node for node in blocks if ast.unparse(node.test) == "TYPE_CHECKING")
    names = {node.name for node in ast.walk(shown) if isinstance(node, ast.alias)}
    assert names | {"__version__"} == set(crankcheck.__all__)
    with pytest.raises(AttributeError, match="'crankcheck' has no attribute 'solv'"):
        crankcheck.solv  # noqa: B018 - that is what is tested


def test_the_version_is_that_of_the_command() -> None:
    assert printed(COMMAND, "--version") == f"crankcheck {crankcheck.__version__}\n"
