"""The hard cases; each file is one group of the catalogue.

Another case is another `Case` in the tuple ``CASES`` of its group's file; another group is another
file and its line in the part ``cases`` of a way.
"""
