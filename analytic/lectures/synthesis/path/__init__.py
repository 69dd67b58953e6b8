"""Path generation: four-bars of which a point of the coupler goes through given points.

``search.generate`` finds the mechanisms, ``atlas.similar`` looks coupler curves up by their shape.
"""
