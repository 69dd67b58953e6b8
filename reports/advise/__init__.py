"""Errors of engines at a program's own frame time, and the sub-steps that reach a target."""
