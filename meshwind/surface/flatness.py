"""The curvature of a surface as far as it is real: hollows that bow a chord by more than the surface is uncertain.

A fit swings about the part in waves of a few spans, and the curvature of a wave grows as its length shrinks: however
true the surface is, its curvature at a point says little.  What is real shows along chords.  Over a length L a normal
curvature k bows the surface by k L^2 / 8, whereas a wave that is shorter than a chord hardly does.
"""

from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Bools, Floats
from meshwind.core.vectors import TINY
from meshwind.surface.evaluate import SU, SV, S
from meshwind.surface.forms import Form, Forms, fundamental_forms
from meshwind.surface.surface import Surface

LENGTHS = 0.5 * 2.0 ** np.arange(-8.5, 0.5, 0.5)
"""Of the part's size: lengths of the chords, from below a span's to where a line in (u, v) is no straight course."""
APART = 2.0
"""Uncertainty of a bow over that of the surface: about an edge that a fit rounds, the middle of a chord is off one way
and its ends the other."""
ELSEWHERE = 0.5
"""A half of a chord that bows so much of the whole has the bend: a half of an arc bows 0.25 of it, an edge in it 1."""


def real_forms(surface: Surface, uv: Floats, frames: Floats) -> Forms:
    """The forms at points uv (k, 2), whose frames (k, 6, 3) are given, with a second form without hollows of the fit.

    Where a chord through a point lies in a hollow deeper than the surface is uncertain, the second form is that of the
    shortest such chords; elsewhere it is that of the surface with its hollows flattened.  On a surface without
    uncertainty it is that of the surface.
    """
    forms = fundamental_forms(frames)
    limit = surface.threshold_at(uv) * (APART if surface.threshold is None else 1.0)
    unsure = np.flatnonzero(limit > 0.0)
    if not len(unsure):
        return forms
    bends = _Bends.of(forms, frames).flattened()
    hollow, chords = _chords(surface, uv[unsure], frames[unsure], limit[unsure])
    found = unsure[hollow]
    for mine, deeper in zip(bends, chords, strict=True):
        mine[found] = deeper[hollow]
    pairs = zip(bends.form(frames), forms.second, strict=True)
    return forms._replace(second=Form(*(np.where(limit > 0.0, new, old) for new, old in pairs)))


class _Bends(NamedTuple):
    """Normal curvature mean + cosine cos 2t + sine sin 2t (k,) in the tangent at an angle t from s_u towards s_v."""

    mean: Floats
    cosine: Floats
    sine: Floats

    @classmethod
    def of(cls, forms: Forms, frames: Floats) -> "_Bends":
        """That of a second form."""
        a, p, q = _legs(frames)
        first = forms.second.uu / a**2
        mixed = (forms.second.uv / a - p * first) / q
        last = (forms.second.vv - p**2 * first - 2.0 * p * q * mixed) / q**2
        return cls(0.5 * (first + last), 0.5 * (first - last), mixed)

    @property
    def smallest(self) -> Floats:
        """Smaller principal curvature (k,)."""
        return np.asarray(self.mean - np.hypot(self.cosine, self.sine))

    def flattened(self) -> "_Bends":
        """Without what bends inwards."""
        swing = np.hypot(self.cosine, self.sine)
        half = 0.5 * np.maximum(self.mean + swing, 0.0)
        hollow = self.mean < swing
        share = np.where(hollow, half / np.maximum(swing, TINY), 1.0)
        return _Bends(np.where(hollow, half, self.mean), share * self.cosine, share * self.sine)

    def form(self, frames: Floats) -> Form:
        """The second form."""
        a, p, q = _legs(frames)
        first, last = self.mean + self.cosine, self.mean - self.cosine
        return Form(a**2 * first, a * (p * first + q * self.sine), p**2 * first + 2.0 * p * q * self.sine + q**2 * last)


def _legs(frames: Floats) -> tuple[Floats, Floats, Floats]:
    """Length (k,) of s_u, and components of s_v along it and square to it (k,)."""
    su, sv = frames[:, SU], frames[:, SV]
    a = np.maximum(np.linalg.norm(su, axis=1), TINY)
    p = (su * sv).sum(axis=1) / a
    return a, p, np.maximum(np.linalg.norm(np.cross(su, sv), axis=1) / a, TINY)


def _chords(surface: Surface, uv: Floats, frames: Floats, limit: Floats) -> tuple[Bools, _Bends]:
    """Where (k,) a chord shows a hollow deeper than limit (k,), and the curvature of the shortest such chords.

    A hollow within one half of its chord is not at the point.
    """
    count = len(uv)
    hollow, left = np.zeros(count, dtype=bool), np.arange(count)
    bends = _Bends(*(np.zeros(count) for _ in range(3)))
    for length in LENGTHS * surface.size:
        bow = [_bow(surface, *_chord(uv[left], frames[left], angle, length)) for angle in _ANGLES]
        here = _Bends(0.25 * (bow[0] + bow[1] + bow[2] + bow[3]), 0.5 * (bow[0] - bow[2]), 0.5 * (bow[1] - bow[3]))
        deep = -here.smallest > limit[left]
        found, here = left[deep], _Bends(*(each[deep] for each in here))
        angle = 0.5 * np.arctan2(-here.sine, -here.cosine)
        middle, half = _chord(uv[found], frames[found], angle, length)
        sides = [_bow(surface, middle + side * half, 0.5 * half) for side in (-0.5, 0.5)]
        hollow[found] = np.minimum(*sides) > ELSEWHERE * here.smallest
        for mine, values in zip(bends, here, strict=True):
            mine[found] = 8.0 / length**2 * values
        left = left[~deep]
    return hollow, bends


_ANGLES = 0.25 * np.pi * np.arange(4)
"""Directions of the chords, from s_u towards s_v."""


def _chord(uv: Floats, frames: Floats, angle: Floats | float, length: float) -> tuple[Floats, Floats]:
    """Middles and halves (k, 2) in (u, v) of chords through points, moved along their lines to lie within the ends."""
    a, p, q = _legs(frames)
    v = np.sin(angle) / q
    half = 0.5 * length * np.stack([(np.cos(angle) - p * v) / a, v], axis=1)
    half *= np.minimum(1.0, 0.5 / np.maximum(np.abs(half[:, 1]), TINY))[:, None]
    reach = np.abs(half[:, 1])
    inward = np.clip(uv[:, 1], reach, 1.0 - reach) - uv[:, 1]
    along = np.divide(inward, half[:, 1], out=np.zeros_like(inward), where=reach > TINY)
    return uv + along[:, None] * half, half


def _bow(surface: Surface, middle: Floats, half: Floats) -> Floats:
    """How far the surface stands out of the middle of chords from middle - half to middle + half (k, 2)."""
    here = surface.frames(middle)
    chord = 0.5 * (surface.points(middle - half) + surface.points(middle + half))
    return np.asarray(((here[:, S] - chord) * fundamental_forms(here).normal).sum(axis=1))
