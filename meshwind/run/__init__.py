"""Whole runs, from a mesh to a folder of results with pictures: what the command line and a study call."""
