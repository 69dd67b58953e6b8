"""Other processes: isolated children, their scheduler, signals, programs.

The matrices here are small. If all processors are busy, as in a verification, the threads of
OpenBLAS, one for each, wait for a processor, and burn it meanwhile.
"""

from collections.abc import MutableMapping

THREADS = "OPENBLAS_NUM_THREADS"
CHOICES = (THREADS, "GOTO_NUM_THREADS", "OMP_NUM_THREADS")
"""Variables that OpenBLAS reads, in its order: a user's value in any of them stays."""


def one_thread(variables: MutableMapping[str, str]) -> None:
    """Set one thread in the variables of a process without numpy, unless they give a number."""
    if not any(variables.get(name) for name in CHOICES):
        variables[THREADS] = "1"
