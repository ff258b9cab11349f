"""Whether the curvature of a surface is real: whether it bows a chord by more than the surface may lie off the part.

A fit swings about the part in waves of a few spans, and the curvature of a wave grows as its length shrinks: however
true the surface is, its curvature at a point says little.  What is real shows along a longer chord.  Over a length L a
normal curvature k bows the surface by k L^2 / 8; the surface itself is followed along such chords, since a wave that is
shorter than a chord does not bow it.
"""

import numpy as np

from meshwind.core.cast import Bools, Floats
from meshwind.core.vectors import TINY
from meshwind.surface.evaluate import SU, SV, S
from meshwind.surface.forms import fundamental_forms
from meshwind.surface.surface import Surface

STEP, STEPS = 2.0**0.5, 12
"""Ratio of the lengths of successive chords, and their largest number."""
SHORTEST = 1.2
"""Of the length over which the curvature at the point would just be real: that of the shortest chord."""
LONGEST = 0.5
"""Of the part's size: the longest chord; beyond it the line in (u, v) is no straight course any more."""
APART = 1.5**0.5
"""Uncertainty of a bow over that of the surface: that of the middle, and half of that of each of two ends."""
ELSEWHERE = 0.6
"""A half of a chord that bows so much of the whole has the bend: a half of an arc bows 0.25 of it, an edge in it 1."""


def are_real(surface: Surface, uv: Floats, direction: Floats, curvature: Floats) -> Bools:
    """Whether the normal curvatures (k,) in unit tangents `direction` (k, 3) at points uv (k, 2) are real.

    All are on a surface without uncertainty.  The shortest chord that is bowed counts, unless one of its halves is
    bowed as well: the bend is not at its middle then.
    """
    limit = surface.threshold_at(uv) * (APART if surface.threshold is None else 1.0)
    real = limit <= 0.0
    shortest = SHORTEST * np.sqrt(8.0 * limit / np.maximum(np.abs(curvature), TINY))
    course = _course(surface.frames(uv), direction)
    open_ = ~real
    for k in range(STEPS):
        length = shortest * STEP**k
        left = np.flatnonzero(open_ & (length <= LONGEST * surface.size))
        if not len(left):
            break
        middle, half = _within(uv[left], 0.5 * length[left, None] * course[left])
        bow = _bow(surface, middle, half) * np.sign(curvature[left])
        bowed = bow > limit[left]
        left, middle, half, bow = left[bowed], middle[bowed], half[bowed], bow[bowed]
        sides = [_bow(surface, middle + side * half, half / 2) * np.sign(curvature[left]) for side in (-0.5, 0.5)]
        real[left] = np.maximum(*sides) < ELSEWHERE * bow
        open_[left] = False
    return real


def _course(frames: Floats, direction: Floats) -> Floats:
    """Components (k, 2) by s_u and s_v of unit tangents (k, 3)."""
    e, f, g = fundamental_forms(frames).first
    p, q = ((direction * frames[:, row]).sum(axis=1) for row in (SU, SV))
    return np.stack([g * p - f * q, e * q - f * p], axis=1) / np.maximum(e * g - f * f, TINY)[:, None]


def _within(middle: Floats, half: Floats) -> tuple[Floats, Floats]:
    """Middles and halves (k, 2) of chords in (u, v), moved along their own lines and cut to lie within the ends."""
    half = half * np.minimum(1.0, 0.5 / np.maximum(np.abs(half[:, 1]), TINY))[:, None]
    reach = np.abs(half[:, 1])
    inward = np.clip(middle[:, 1], reach, 1.0 - reach) - middle[:, 1]
    along = np.divide(inward, half[:, 1], out=np.zeros_like(inward), where=reach > TINY)
    return middle + along[:, None] * half, half


def _bow(surface: Surface, middle: Floats, half: Floats) -> Floats:
    """How far the surface stands out of the middle of chords from middle - half to middle + half (k, 2)."""
    here = surface.frames(middle)
    chord = 0.5 * (surface.points(middle - half) + surface.points(middle + half))
    return np.asarray(((here[:, S] - chord) * fundamental_forms(here).normal).sum(axis=1))
