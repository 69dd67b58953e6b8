"""What engines reach at a program's own frame time, and the sub-steps that reach a target."""
