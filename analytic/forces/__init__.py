"""Reactions of the joints and driving torque of a motion."""
