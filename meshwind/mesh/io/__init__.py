"""Reading of mesh files: vertices and triangles from all formats, and scalars."""
