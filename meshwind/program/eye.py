"""The eye: at the end of the free span, and what the axes say there."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.core.vectors import TINY, sizes, unit
from meshwind.program.body import Body, to_radius
from meshwind.program.mandrel import Mandrel
from meshwind.program.track import AIR, Track

LONGEST = 4.0
"""Longest span of an eye at a fixed distance from the axis, over the size of the body: near the axis it has no end."""
_GROWS = 1.0
"""Length by which a span that had to be short grows for each length that is laid, until it is as long as wanted."""
_ROUNDS = 4
"""Rounds in which the eye moves off the part: what is nearest may change, and no span may be slack."""
_SWING = 0.05
"""Most that the span swings, in radians, as the eye keeps off the part past the point where a bridge lands."""


@dataclass(frozen=True)
class Spans:
    """How long free spans are.

    find: from points along tangents (n, 3), both in the mandrel's frame, to their lengths (n,) as wanted, and the most
    that may be.
    lift: how far from the part the eye keeps where it runs out along a bridge past the point where that lands.
    off: from eyes (n, 3) to how they are still to move (n, 3) off the part where spans are shorter than wanted; None if
    nothing is in the way of any.
    """

    find: Callable[[Floats, Floats], tuple[Floats, Floats]]
    lift: float = 0.0
    off: Callable[[Floats], Floats] | None = None


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
    return Spans(lambda points, rays: (body.spans(points, rays), np.full(len(points), np.inf)))


def at_radius(radius: float, longest: float) -> Spans:
    """Spans that end at a distance from the axis, at most `longest` long."""
    return Spans(
        lambda points, rays: (np.minimum(to_radius(points, rays, radius), longest), np.full(len(points), np.inf))
    )


@dataclass(frozen=True)
class _Found:
    """What is found at a place (n,) of a track whatever the others are.

    index, share: the piece, and how much of it is done; laid, point, tangent: see `Poses`; wanted, most: see `Spans`.
    """

    at: Floats
    index: Ints
    share: Floats
    laid: Floats
    point: Floats
    tangent: Floats
    wanted: Floats
    most: Floats

    def chosen(self, which: Ints) -> "_Found":
        """Some of the places."""
        return _Found(*(values[which] for values in vars(self).values()))

    def among(self, other: "_Found") -> "_Found":
        """These places and others, in order."""
        both = zip(vars(self).values(), vars(other).values(), strict=True)
        joined = _Found(*(np.concatenate(values) for values in both))
        return joined.chosen(np.argsort(joined.at, kind="stable"))


class Solver:
    """Solves for the eye on a track; what it found at a place it keeps, to be asked again among other places."""

    def __init__(self, track: Track, mandrel: Mandrel, spans: Spans) -> None:
        self._track, self._mandrel, self._spans = track, mandrel, spans
        self._known: _Found | None = None

    def __call__(self, at: Floats) -> Poses:
        """The eye at places (n,), growing; the fibre is never slack between them."""
        found, mandrel = self._at(at), self._mandrel
        tangent = found.tangent
        if not np.isfinite(found.most).any():
            span = taut(found.wanted, found.laid)
        else:
            span = _limited(found, self._track)
            tangent, span = _lifted(found, span, self._track, mandrel, self._spans.lift)
            if self._spans.off is not None:
                tangent, span = _off(found, tangent, span, self._spans.off)
        return Poses(at, found.laid, found.point, tangent, span, *axes(found.point, tangent, span))

    def _at(self, at: Floats) -> _Found:
        """What is found at places (n,)."""
        if self._known is None:
            self._known = self._look(at)
            return self._known
        old = self._known.at
        new = old[np.minimum(np.searchsorted(old, at), len(old) - 1)] != at
        if new.any():
            self._known = self._known.among(self._look(at[new]))
        known = self._known
        return known if len(known.at) == len(at) else known.chosen(np.searchsorted(known.at, at))

    def _look(self, at: Floats) -> _Found:
        """The same, looked for."""
        contact, ahead = self._track.contact(at)
        point, tangent = self._mandrel.inside(contact), self._mandrel.turned(ahead)
        piece, length = self._track.piece(at), self._spans.find(point, tangent)
        return _Found(at, *piece, self._track.laid(at), point, tangent, *length)


def taut(span: Floats, laid: Floats) -> Floats:
    """The least spans (n,), none shorter than wanted, of which none is slack: span and laid length never fall together.

    l[i+1] = max(l[i+1], l[i] - laid), so that the sum of both is its own greatest value so far.
    """
    return np.asarray(np.maximum.accumulate(span + laid) - laid)


def _limited(found: _Found, track: Track) -> Floats:
    """Spans (n,) at places of a track, none slack, and none longer than it may be where the fibre lies.

    The sum of span and laid length is nowhere above the least that is ahead, so that the eye draws near while fibre is
    laid.  Behind, the span grows as fibre is laid.  A bridge lands at once: where the eye is not yet beyond where it
    lands, it runs out along it, evenly over the places in the air.
    """
    air = track.motion[found.index] == AIR
    lies = np.flatnonzero(~air | (found.share == 0.0))
    on, wanted = found.laid[lies], found.wanted[lies]
    total = np.maximum.accumulate(wanted + on)
    ahead = np.minimum.accumulate((found.most[lies] + on)[::-1])[::-1]
    leap = float(total[-1] - total[0]) + float(wanted.max())  # over a bridge the sum may grow to what it will be
    clock = np.concatenate([[0.0], np.cumsum(np.where(air[lies][:-1], leap, (1.0 + _GROWS) * np.diff(on)))])
    total = np.minimum(total, np.minimum.accumulate(ahead - clock) + clock)
    return np.asarray(np.interp(found.at, found.at[lies], total) - found.laid)


def _lifted(found: _Found, span: Floats, track: Track, mandrel: Mandrel, lift: float) -> tuple[Floats, Floats]:
    """Tangents (n, 3) and spans (n,) of which those that run out along a bridge keep off the part where it lands.

    The lift is along the normal there; it grows evenly from where the eye begins to run out, and falls as evenly.
    """
    air = np.flatnonzero((track.motion[found.index] == AIR) & (found.share > 0.0))
    bridge = found.index[air]
    begin, end = np.searchsorted(found.at, bridge), np.searchsorted(found.at, bridge + 1.0)
    length = sizes(track.points[bridge, 1] - track.points[bridge, 0])
    first, past = length - span[begin], span[end]  # how far it is to where the bridge lands, and on from there
    on = length - span[air]
    part = np.where(on > 0.0, 1.0 - on / np.maximum(first, TINY), 1.0 + on / np.maximum(past, TINY))
    height = np.minimum(lift, _SWING * length) * np.where(first > 0.0, np.clip(part, 0.0, 1.0), 0.0)
    moved = span[air, None] * found.tangent[air] + height[:, None] * mandrel.turned(track.normals[bridge, 1])
    tangent, span = found.tangent.copy(), span.copy()
    tangent[air], span[air] = unit(moved), sizes(moved)
    return tangent, span


def _off(found: _Found, tangent: Floats, span: Floats, off: Callable[[Floats], Floats]) -> tuple[Floats, Floats]:
    """Tangents (n, 3) and spans (n,) of which the short ones end far enough off the part, none slack.

    Where fibre lands on a rim, its line beyond goes below the part: there the eye moves off.
    """
    short = np.flatnonzero(span < found.wanted)
    tangent = tangent.copy()
    for _ in range(_ROUNDS):
        reach = span[short, None] * tangent[short]
        move = off(found.point[short] + reach)
        if not move.any():
            break
        moved = reach + move
        tangent[short], span[short] = unit(moved), sizes(moved)
        span = taut(span, found.laid)
    return tangent, span


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
