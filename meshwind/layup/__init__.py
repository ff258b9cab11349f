"""What a set of paths amounts to: families, crossings, coverage, quads."""
