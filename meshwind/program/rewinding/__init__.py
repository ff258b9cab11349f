"""A program wound again: the fibre that its moving eye lays, by physics and not by plan."""
