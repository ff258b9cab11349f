"""Make a triangle mesh clean: weld, close cracks, make manifold, drop what says nothing."""
