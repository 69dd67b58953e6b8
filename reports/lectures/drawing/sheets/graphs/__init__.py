"""Sheets of graphs: differentiated and integrated with ruler and pole."""
