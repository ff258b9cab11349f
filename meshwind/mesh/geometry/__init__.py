"""The triangle mesh and its annulus, their edges, measures and search tree."""
