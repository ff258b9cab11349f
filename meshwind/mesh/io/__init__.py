"""Mesh files to vertices and triangles, whatever their format."""
