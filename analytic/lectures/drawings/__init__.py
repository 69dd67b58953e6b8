"""Drawings of the lecture to scale: vector polygons, images of links, graphs, centres."""
