"""Figures of the theory's pages: a module for each page, a function for each figure, and what they drew."""
