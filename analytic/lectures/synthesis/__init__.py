"""Dimensional synthesis: from what a mechanism must do to its lengths, pivots and assembly.

Every kind of task becomes `Design`s: a scene, the precision positions that it is to meet, and the
steps of the construction that found it. `examine` then runs the scene by the reference and says
which defects it has. Planar vectors are complex numbers here, as in the field's own texts.
"""
