"""Solving a shell deck with CalculiX, and what its stresses mean for the plies."""
