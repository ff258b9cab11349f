"""A mesh to an annulus: choose its two ends, open them, fill what is no end."""
