"""The triangle mesh and the annulus: topology, areas and volumes, axis, subdivision, search tree."""
