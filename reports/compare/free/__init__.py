"""A run of free motion beside the motion that masses and forces give."""
