"""Path generation: four-bars whose coupler point goes through given points.

``search.generate`` finds the mechanisms, ``atlas.similar`` looks coupler curves up by their shape.
"""
