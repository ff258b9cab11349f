"""The eye: at the end of the free span, and what the axes say there."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from meshwind.core.cast import Floats
from meshwind.program.body import Body, to_radius
from meshwind.program.mandrel import Mandrel
from meshwind.program.track import Track

Spans: TypeAlias = Callable[[Floats, Floats], Floats]
"""Lengths (n,) of free spans from points (n, 3) along tangents (n, 3), both in the mandrel's frame."""
LONGEST = 4.0
"""Longest span of an eye at a fixed distance from the axis, over the size of the body: near the axis it has no end."""


@dataclass(frozen=True)
class Poses:
    """Where fibre and eye are at places (n,) of a track, in the mandrel's frame.

    Attributes
    ----------
    at, laid : ndarray of float, shape (n,)
        Places on the track, and the length that is laid.
    point, tangent : ndarray of float, shape (n, 3)
        Where the fibre leaves what it lies on, and its unit tangent.
    span : ndarray of float, shape (n,)
        Length of the free span.
    x, r, mandrel, roll, yaw : ndarray of float, shape (n,)
        The eye along the axis and from it; angles in radians, unwrapped.
    """

    at: Floats
    laid: Floats
    point: Floats
    tangent: Floats
    span: Floats
    x: Floats
    r: Floats
    mandrel: Floats
    roll: Floats
    yaw: Floats

    def __len__(self) -> int:
        return len(self.at)


def on_body(body: Body) -> Spans:
    """Spans that end on a body."""
    return body.spans


def at_radius(radius: float, longest: float) -> Spans:
    """Spans that end at a distance from the axis, at most `longest` long."""
    return lambda points, rays: np.minimum(to_radius(points, rays, radius), longest)


def poses(track: Track, mandrel: Mandrel, spans: Spans, at: Floats) -> Poses:
    """The eye at places (n,) of a track, growing; the fibre is never slack between them."""
    contact, ahead = track.contact(at)
    point, tangent, laid = mandrel.inside(contact), mandrel.turned(ahead), track.laid(at)
    span = taut(spans(point, tangent), laid)
    return Poses(at, laid, point, tangent, span, *axes(point, tangent, span))


def taut(span: Floats, laid: Floats) -> Floats:
    """The least spans (n,), none shorter than wanted, of which none is slack: span and laid length never fall together.

    l[i+1] = max(l[i+1], l[i] - laid), so that the sum of both is its own greatest value so far.
    """
    return np.asarray(np.maximum.accumulate(span + laid) - laid)


def axes(point: Floats, tangent: Floats, span: Floats) -> tuple[Floats, Floats, Floats, Floats, Floats]:
    """Eye along and from the axis, and mandrel, roll and yaw in radians, unwrapped: (n,) each.

    point, tangent (n, 3) and span (n,) are in the mandrel's frame.  With e_r from the axis to the eye and
    e_t = axis x e_r, roll = atan2(t.axis, t.e_t), of period half a turn, and yaw = atan2(t.e_r, |t - (t.e_r) e_r|).
    """
    eye = point + span[:, None] * tangent
    r = np.hypot(eye[:, 1], eye[:, 2])
    phi = np.arctan2(eye[:, 2], eye[:, 1])
    cosine, sine = np.cos(phi), np.sin(phi)
    out = cosine * tangent[:, 1] + sine * tangent[:, 2]
    round_ = cosine * tangent[:, 2] - sine * tangent[:, 1]
    roll = np.unwrap(np.arctan2(tangent[:, 0], round_), period=np.pi)
    yaw = np.arctan2(out, np.hypot(tangent[:, 0], round_))
    return eye[:, 0], r, -np.unwrap(phi), roll, yaw
