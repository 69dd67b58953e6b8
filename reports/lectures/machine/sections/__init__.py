"""The sections of the page of a steady cycle, and of a flywheel."""
