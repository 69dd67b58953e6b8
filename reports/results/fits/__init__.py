"""Reading a line of cells that differ only in their step: order, floor, and where it breaks."""
