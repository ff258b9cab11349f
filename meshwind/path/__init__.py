"""Taut paths on a surface."""
