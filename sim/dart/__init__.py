"""DART, by the package dartpy."""

from sim.registry import Declaration

DECLARATION = Declaration(
    "dartpy",
    formulation="constraint impulses",
    apart=True,
    tried="6.20.",
    wheels="Linux; others from Python 3.12 on",
)
