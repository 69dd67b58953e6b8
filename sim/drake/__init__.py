"""Drake, by its own package, with its solver of convex problems (SAP) in steps of fixed size."""

from sim.registry import Declaration

DECLARATION = Declaration(
    "pydrake",
    pip_name="drake",
    formulation="soft constraints",
    apart=True,
    tried="1.51.",
    wheels="Linux, macOS",
)
