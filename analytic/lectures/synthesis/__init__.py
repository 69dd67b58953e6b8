"""Dimensional synthesis: from the task of a mechanism to its lengths, pivots and assembly;
begin at `solutions`.

Every kind of task becomes `Proposal`s: a scene, the precision positions that it is to meet, and the
steps of its construction. `examine` then runs the scene by the reference and names its defects.
Planar vectors are complex numbers here, as in the field's own texts.
"""
