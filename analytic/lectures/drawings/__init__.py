"""What the lecture draws: vector polygons, images of links, graphs, centres, each to a scale."""
