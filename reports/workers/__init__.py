"""Other processes: isolated children, their scheduler, signals, programs.

The matrices here are small. Where all processors are busy, as those of a verification are, OpenBLAS
with a thread for each has its products wait for a processor, and burns it meanwhile.
"""

from collections.abc import MutableMapping

THREADS = "OPENBLAS_NUM_THREADS"
CHOICES = (THREADS, "GOTO_NUM_THREADS", "OMP_NUM_THREADS")
"""The variables that OpenBLAS asks, in its order: what a user says in any of them stays."""


def one_thread(variables: MutableMapping[str, str]) -> None:
    """Ask for one thread in the variables of a process that has not imported numpy, unless they say
    how many."""
    if not any(variables.get(name) for name in CHOICES):
        variables[THREADS] = "1"
