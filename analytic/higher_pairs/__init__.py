"""Higher pairs among the steps of a mechanism: gear trains, followers of cams."""
