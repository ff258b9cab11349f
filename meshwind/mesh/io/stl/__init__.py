"""STL files."""
