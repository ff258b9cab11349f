"""Notes for the user on a redesign."""

import numpy as np

from meshwind.appearance.words import quantity
from meshwind.core.spoken import argument
from meshwind.editing.redesign import Redesign
from meshwind.editing.wall_left import wall_left
from meshwind.mesh.opening.choose_ends import position_text
from meshwind.workflow.notes import Note

_THIN = 0.5
"""What is left of the wall's thickness at a place, over what was there, below which there is a warning."""


def about_wall(edited: Redesign, units: str = "") -> tuple[Note, ...]:
    """Notes on the wall of a redesigned part: what has become of it, with a warning where it has become thin."""
    wall = edited.before.chart.annulus.wall
    if wall is None:
        return ()
    left = wall_left(edited.part, wall, edited.displacement)
    if len(left.after) == 0:
        return (Note(f"only the {wall.side} skin is moved, so the wall becomes thicker or thinner"),)
    low, high = (quantity(float(value), units, 3) for value in (left.after.min(), left.after.max()))
    text = f"only the {wall.side} skin is moved; the wall is {low} to {high} thick below it afterwards"
    k = int(np.argmin(left.after / np.maximum(left.before, 1e-300)))
    if left.after[k] >= _THIN * left.before[k]:
        return (Note(text),)
    place = position_text(left.points[k], edited.part.diagonal)
    was, now = quantity(float(left.before[k]), units, 3), quantity(float(left.after[k]), units, 3)
    thin = (
        f"leaves {now} of the wall near {place}, where it was {was} thick"
        if left.after[k] > 0.0
        else f"moves the {wall.side} skin through the other one near {place}, where the wall was {was} thick"
    )
    return Note(text), Note(f"the edit {thin}; give a {argument('bound')}", True)
