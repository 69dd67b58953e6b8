"""The sections of the page of a judged log: its verdict, its channels, the mechanism beside the
truth, and how all of it was read."""
