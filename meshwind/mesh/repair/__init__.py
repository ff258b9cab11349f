"""Repair of a triangle mesh: weld, drop degenerate faces, close cracks, make manifold, orient."""
