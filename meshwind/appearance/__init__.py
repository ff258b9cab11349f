"""Titles, colours, scales and views, the same in every picture and in the viewer.

Importing the package loads nothing heavy: the process that draws must start quickly.
"""
