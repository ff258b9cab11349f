"""Abaqus and CalculiX decks (INP)."""
