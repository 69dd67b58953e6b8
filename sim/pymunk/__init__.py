"""pymunk."""

from sim.registry import Declaration

DECLARATION = Declaration("pymunk", "pymunk", ("snippet", "knobs", "spoiler"))
