"""Cells of every kind, and the triangles of their surface."""
