"""Automatic surface editing: move the control points as little as possible until no fibre bridges."""
