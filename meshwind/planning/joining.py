"""Batches of paths taken apart and put together."""

from dataclasses import fields, replace
from typing import Any

import numpy as np

from meshwind.core.cast import Ints, frozen
from meshwind.path.paths import Counters, Paths

_COMMON = ("surface", "friction", "counters")


def chosen(paths: Paths, index: Ints) -> Paths:
    """Some of the paths, in the order of `index`; the counters stay those of the batch they were solved in."""
    part: dict[str, Any] = {name: frozen(getattr(paths, name)[index]) for name in _each(paths)}
    return replace(paths, **part)


def joined(first: Paths, second: Paths) -> Paths:
    """Both batches, of one surface and as many particles a path, as one."""
    both: dict[str, Any] = {
        name: frozen(np.concatenate([getattr(first, name), getattr(second, name)])) for name in _each(first)
    }
    a, b = first.counters, second.counters
    total = Counters(*(getattr(a, field.name) + getattr(b, field.name) for field in fields(Counters)))
    return replace(first, friction=max(first.friction, second.friction), counters=total, **both)


def _each(paths: Paths) -> list[str]:
    """Names of the fields that have a row for each path."""
    return [field.name for field in fields(paths) if field.name not in _COMMON]
