"""Work for other processes. It imports next to nothing, as each of them does so anew."""

import os
import sys
import time
from types import ModuleType

from models.errors import CrankcheckError, SceneError
from sim.compiling import compiling

_held: list[bytearray] = []


def unlucky(number: int) -> str:
    """The number as a text; 2 ends its process."""
    if number == 2:
        os._exit(3)
    return str(number)


def sleepy(seconds: int) -> str:
    """The number of seconds, after that time."""
    time.sleep(seconds)
    return str(seconds)


def where(_: int) -> str:
    return str(os.getpid())


def refuse(number: int) -> str:
    """Nothing; 3 is refused."""
    if number == 3:
        raise CrankcheckError("no 3")
    return ""


def hold(size: int) -> int:
    """Keep some memory, and tell in which process."""
    _held.append(bytearray(size))
    return os.getpid()


def fail() -> float:
    return 1 / 0


def refuse_scene(place: str, faults: list[str]) -> None:
    raise SceneError(place, faults)


class OddError(Exception):
    """One that cannot be made anew from what it holds."""

    def __init__(self, one: int, two: int) -> None:
        super().__init__(f"{one} and {two}")


def be_odd() -> None:
    raise OddError(1, 2)


def be_strange() -> None:
    """Raise what only its own process knows."""
    module = ModuleType("there_alone")
    exec("class StrangeError(Exception):\n    pass", vars(module))
    sys.modules[module.__name__] = module
    raise module.StrangeError("of a module that is there alone")


def compile_long(seconds: float, then: float) -> str:
    """Say that an engine compiles for so long; work for ``then`` seconds after it."""
    with compiling():
        time.sleep(seconds)
    time.sleep(then)
    return "compiled"
