"""Gmsh's files (MSH)."""
