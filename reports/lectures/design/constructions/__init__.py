"""Constructions of a synthesis, step by step as one draws them: sheets and pages."""
