"""Automatic surface editing: move the control points as little as possible until no fibre bridges."""

from meshwind.editing.edit import Edit, edit
from meshwind.editing.redesign import Redesign, redesign
from meshwind.editing.result import Outcome, Round

__all__ = ["Edit", "Outcome", "Redesign", "Round", "edit", "redesign"]
