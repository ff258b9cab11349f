"""How figures and maps are shown, the same in every picture and page.

Loads nothing heavy: the process that draws must start quickly.
"""
