"""Marched fibres as paths: points evenly by arc length, on curves as exact as the march itself.

Between two rows of a march lies one polynomial piece of the surface, so that u and v there are smooth: they are
interpolated by polynomials of degree 5 from their values, first and second derivatives at both rows.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.core.vectors import unit
from meshwind.filament.polar_legs import Half
from meshwind.march.traced import Trace
from meshwind.surface.evaluate import SU, SUU, SUV, SV, SVV
from meshwind.surface.forms import components
from meshwind.surface.surface import Surface


@dataclass(frozen=True)
class Stretch:
    """A marched fibre on a half of the surface, to be run through as it was marched or `backwards`."""

    trace: Trace
    half: Half
    backwards: bool

    def rows(self) -> tuple[Floats, Floats, Floats]:
        """Arc length (m,) from its first point, and u, v and their rates on the whole surface (m, 2), in order."""
        scale = np.array([1.0, self.half.last - self.half.first])
        s, uv = self.trace.arc_length, self.half.out_of(self.trace.uv)
        rate = self.trace.uv_rate * scale
        return (s[-1] - s[::-1], uv[::-1], -rate[::-1]) if self.backwards else (s, uv, rate)

    @property
    def slip(self) -> float:
        """Slip of the fibre, positive to its left as it is run through."""
        return -self.trace.slip if self.backwards else self.trace.slip


@dataclass(frozen=True)
class Rows:
    """Paths of n points: uv (p, n, 2), which stretch each point lies on (p, n), and length (p,)."""

    uv: Floats
    stretch: Ints
    length: Floats


def evenly(surface: Surface, fibres: Sequence[Sequence[Stretch]], points: int) -> Rows:
    """Points along fibres, each of as many stretches in a row, evenly by arc length."""
    parts = [[stretch.rows() for stretch in fibre] for fibre in fibres]
    many = len(fibres[0])
    lengths = np.array([[rows[0][-1] for rows in fibre] for fibre in parts])
    before = np.cumsum(lengths, axis=1) - lengths
    total = lengths.sum(axis=1)
    count = np.array([[len(rows[0]) for rows in fibre] for fibre in parts])
    s = np.concatenate([rows[0] for fibre in parts for rows in fibre]) + np.repeat(before.ravel(), count.ravel())
    uv, rate = (np.concatenate([rows[k] for fibre in parts for rows in fibre]) for k in (1, 2))
    slip = np.repeat([stretch.slip for fibre in fibres for stretch in fibre], count.ravel())
    bend = _second(surface, uv, rate, slip)
    wanted = total[:, None] * np.linspace(0.0, 1.0, points)
    # one search for all fibres: each begins a length after the one before has ended
    base = np.cumsum(2.0 * total) - 2.0 * total
    first = np.concatenate([[0], np.cumsum(count.sum(axis=1))])
    key = s + np.repeat(base, count.sum(axis=1))
    row = np.searchsorted(key, (wanted + base[:, None]).ravel(), side="right").reshape(wanted.shape) - 1
    row = np.clip(row, first[:-1, None], first[1:, None] - 2)
    k = row.ravel()
    span = np.diff(s, append=s[-1])
    at = np.clip((wanted.ravel() - s[k]) / np.where(span > 0.0, span, 1.0)[k], 0.0, 1.0)
    found = _quintic(np.maximum(span, 0.0), (uv, rate, bend), k, at)
    on = np.repeat(np.tile(np.arange(many), len(fibres)), count.ravel())[k]
    found = found.reshape(len(fibres), points, 2)
    found[:, 0], found[:, -1] = uv[first[:-1]], uv[first[1:] - 1]
    return Rows(found, on.reshape(wanted.shape), total)


def _second(surface: Surface, uv: Floats, rate: Floats, slip: Floats) -> Floats:
    """Second derivatives (m, 2) of u and v by arc length of fibres with slips (m,)."""
    frames = surface.frames(uv)
    su, sv = frames[:, SU], frames[:, SV]
    p, q = rate[:, :1], rate[:, 1:]
    normal = unit(np.cross(su, sv))
    bend = p * p * frames[:, SUU] + 2.0 * p * q * frames[:, SUV] + q * q * frames[:, SVV]
    press = np.maximum(-(bend * normal).sum(axis=1), 0.0)
    left = np.cross(normal, p * su + q * sv)
    return components(frames, (slip * press)[:, None] * left - bend)


def _quintic(span: Floats, rows: tuple[Floats, Floats, Floats], k: Ints, share: Floats) -> Floats:
    """Values (n, 2) at shares (n,) of the ways of lengths `span` (m,) from rows k (n,) to the next.

    rows: values (m, 2) with two derivatives.  The polynomials are those of the m ways, of which there are fewer.
    """
    h = span[:, None]
    a, da, dda = rows[0], h * rows[1], h * h * rows[2]
    b, db, ddb = (np.roll(each, -1, axis=0) for each in (rows[0], rows[1], rows[2]))
    db, ddb = h * db, h * h * ddb
    rise = b - a - da - 0.5 * dda
    slope, bend = db - da - dda, ddb - dda
    terms = (
        6.0 * rise - 3.0 * slope + 0.5 * bend, -15.0 * rise + 7.0 * slope - bend,
        10.0 * rise - 4.0 * slope + 0.5 * bend, 0.5 * dda, da, a,
    )  # fmt: skip
    found, x = terms[0][k], share[:, None]
    for term in terms[1:]:
        found *= x
        found += term[k]
    return found
