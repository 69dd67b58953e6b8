"""The hard cases, in groups.

Another case is another `Case` in the tuple of its group; another group is another tuple and its
line in the part ``cases`` of a way.
"""
