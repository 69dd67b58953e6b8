"""Newton, by its package newton: four of its solvers."""

from sim.registry import Declaration, Fewer

DECLARATION = Declaration(
    "newton",
    ("gradient",),
    formulation="by solver",
    precision="single",
    tried="1.8.",
    fewer=Fewer(steps_per_turn=90.0, batch_steps=20),
    needs=("warp",),
)
