"""The curvature of a surface as far as it is real: hollows that bow a chord by more than the surface is uncertain.

A fit swings about the part in waves of a few spans, and the curvature of a wave grows as its length shrinks: however
true the surface is, its curvature at a point says little.  What is real shows along chords.  Over a length L a normal
curvature k bows the surface by k L^2 / 8, whereas a wave that is shorter than a chord hardly does.
"""

from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Bools, Floats
from meshwind.core.vectors import TINY, unit
from meshwind.surface.evaluate import SU, SV, S
from meshwind.surface.forms import Form, Forms, fundamental_forms
from meshwind.surface.surface import Surface

LENGTHS = 0.5 * 2.0 ** np.arange(-8.5, 0.5, 0.5)
"""Of the part's size: lengths of the chords, from below a span's to where a line in (u, v) is no straight course."""
APART = 2.0
"""Uncertainty of a bow over that of the surface: a fit that swings about the part, or rounds an edge, is off one way at
the middle of a chord and the other way at its ends."""
ELSEWHERE = 0.45
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


class _Places(NamedTuple):
    """Points uv (k, 2) with their positions, normals and tangents: `across` is square to s_u, towards s_v.

    Tangents are in (u, v), per length on the surface.
    """

    uv: Floats
    points: Floats
    normals: Floats
    along: Floats
    across: Floats

    @classmethod
    def of(cls, uv: Floats, frames: Floats) -> "_Places":
        a, p, q = _legs(frames)
        along = np.stack([1.0 / a, np.zeros_like(a)], axis=1)
        across = np.stack([-p / (a * q), 1.0 / q], axis=1)
        return cls(uv, frames[:, S], unit(np.cross(frames[:, SU], frames[:, SV])), along, across)

    def where(self, chosen: Bools) -> "_Places":
        return _Places(*(each[chosen] for each in self))

    def chords(self, surface: Surface, angle: Floats | float, length: float) -> tuple["_Places", Floats]:
        """Places at the middle of chords, and halves of these (k, 2) in (u, v).

        A chord that would pass an end of the surface is moved along its own line.
        """
        cosine, sine = (np.reshape(each, (-1, 1)) for each in (np.cos(angle), np.sin(angle)))
        half = 0.5 * length * (cosine * self.along + sine * self.across)
        half *= np.minimum(1.0, 0.5 / np.maximum(np.abs(half[:, 1]), TINY))[:, None]
        reach = np.abs(half[:, 1])
        inward = np.clip(self.uv[:, 1], reach, 1.0 - reach) - self.uv[:, 1]
        passing = np.flatnonzero(inward)
        if not len(passing):
            return self, half
        uv, points, normals = np.array(self.uv), np.array(self.points), np.array(self.normals)
        uv[passing] += (inward / np.where(reach > TINY, half[:, 1], np.inf))[passing, None] * half[passing]
        frames = surface.frames(uv[passing])
        points[passing], normals[passing] = frames[:, S], unit(np.cross(frames[:, SU], frames[:, SV]))
        return self._replace(uv=uv, points=points, normals=normals), half

    def bow(self, surface: Surface, half: Floats) -> Floats:
        """How far the surface stands out (k,) of the middle of chords of these halves (k, 2)."""
        ends = surface.points(np.concatenate([self.uv - half, self.uv + half])).reshape(2, -1, 3)
        return np.asarray(((self.points - 0.5 * (ends[0] + ends[1])) * self.normals).sum(axis=1))


def _chords(surface: Surface, uv: Floats, frames: Floats, limit: Floats) -> tuple[Bools, _Bends]:
    """Where (k,) a chord shows a hollow deeper than limit (k,), and the curvature of the shortest such chords.

    A hollow within one half of its chord is not at the point.
    """
    count = len(uv)
    hollow, left = np.zeros(count, dtype=bool), np.arange(count)
    bends = _Bends(*(np.zeros(count) for _ in range(3)))
    places = _Places.of(uv, frames)
    for length in LENGTHS * surface.size:
        bow = []
        for angle in _ANGLES:
            middle, half = places.chords(surface, angle, length)
            bow.append(middle.bow(surface, half))
        here = _Bends(0.25 * (bow[0] + bow[1] + bow[2] + bow[3]), 0.5 * (bow[0] - bow[2]), 0.5 * (bow[1] - bow[3]))
        deep = -here.smallest > limit[left]
        found, here = left[deep], _Bends(*(each[deep] for each in here))
        angle = 0.5 * np.arctan2(-here.sine, -here.cosine)
        middle, half = places.where(deep).chords(surface, angle, length)
        sides = [_Places.of(at, surface.frames(at)).bow(surface, 0.5 * half)
                 for at in (middle.uv - 0.5 * half, middle.uv + 0.5 * half)]  # fmt: skip
        hollow[found] = np.minimum(*sides) > ELSEWHERE * here.smallest
        for mine, values in zip(bends, here, strict=True):
            mine[found] = 8.0 / length**2 * values
        left, places = left[~deep], places.where(~deep)
    return hollow, bends


_ANGLES = 0.25 * np.pi * np.arange(4)
"""Directions of the chords, from s_u towards s_v."""
