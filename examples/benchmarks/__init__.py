"""Counts of what the main jobs work out, kept as a history: they do not depend on how fast the machine is."""
