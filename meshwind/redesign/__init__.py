"""Automatic surface editing: move the control points as little as possible until no fibre bridges."""

from meshwind.redesign.edit import Edit, edit
from meshwind.redesign.redesign import Redesign, redesign
from meshwind.redesign.result import Outcome, Round

__all__ = ["Edit", "Outcome", "Redesign", "Round", "edit", "redesign"]
