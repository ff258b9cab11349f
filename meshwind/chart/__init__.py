"""The annulus on the periodic rectangle."""
