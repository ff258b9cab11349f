"""The way of the eye from one filament to the next: the fibre is cut, and tied on again where the next one starts.

The eye goes out from the axis until nothing is in its way, along and round with the part turning on, and in again.
"""

from collections.abc import Sequence
from dataclasses import fields, replace

import numpy as np

from meshwind.core.cast import Floats, frozen
from meshwind.program.blocks import TRAVEL, Blocks
from meshwind.program.body import Body
from meshwind.program.head import frames_at
from meshwind.program.mandrel import Mandrel
from meshwind.program.stepping import Steps
from meshwind.program.track import swung

_AXES = "eye_x", "eye_r", "mandrel", "roll", "yaw"
"""What moves."""


def in_a_row(parts: Sequence[Blocks], mandrel: Mandrel, body: Body | None, steps: Steps) -> Blocks:
    """The blocks of filaments one after another, with the travels between them.

    body: what the eye keeps out of, None if it cannot: it then stays where it is from the axis.
    """
    rows = [parts[0]]
    for part in parts[1:]:
        side = _side(rows[0], 0, mandrel)
        turns = 180.0 * (side != _side(part, 0, mandrel))
        turns += 360.0 * np.round((rows[-1].roll[-1] - part.roll[0] - turns) / 360.0)
        after = replace(part, roll=frozen(part.roll + turns))
        rows += [_travel((rows[-1], after), mandrel, body, steps, side), after]
    return Blocks(*(frozen(np.concatenate([getattr(each, field.name) for each in rows])) for field in fields(Blocks)))


def _side(blocks: Blocks, k: int, mandrel: Mandrel) -> float:
    """1 where the fibre of a block goes as the roll says, and -1 where it is half a turn off, as the roll may be."""
    one = slice(k, k + 1)
    flat = _ahead(mandrel, blocks.mandrel[one], blocks.roll[one], 0.0 * blocks.yaw[one], 1.0)[0]
    return 1.0 if float(flat @ blocks.tangent[k]) >= 0.0 else -1.0


def _ahead(mandrel: Mandrel, turned: Floats, roll: Floats, yaw: Floats, side: float) -> Floats:
    """The fibre's directions (n, 3) at angles (n,) in degrees of mandrel, roll and yaw."""
    return np.asarray(frames_at(mandrel, turned, roll + 90.0 * (1.0 - side), yaw)[:, :, 0])


def _travel(ends: tuple[Blocks, Blocks], mandrel: Mandrel, body: Body | None, steps: Steps, side: float) -> Blocks:
    """The blocks of a travel; the last one is where the next filament starts."""
    before, after = ends
    start, end = (np.array([getattr(each, name)[k] for name in _AXES]) for each, k in ((before, -1), (after, 0)))
    out, along = start.copy(), end.copy()
    out[1] = along[1] = max(start[1], end[1], 0.0 if body is None else _widest(body, start[0], end[0]))
    longest = np.array([steps.x, steps.r, *np.degrees([steps.mandrel, steps.roll, steps.yaw])])
    legs = [(start, out), (out, along), (along, end)]
    counts = [int(np.ceil((np.abs(there - here) / longest).max())) for here, there in legs]
    counts[-1] = max(counts[-1], 1)
    shares = [np.arange(1, count + 1)[:, None] / max(count, 1) for count in counts]
    places = [here + share * (there - here) for share, (here, there) in zip(shares, legs, strict=True)]
    axes = dict(zip(_AXES, np.concatenate(places).T, strict=True))
    done = np.concatenate([0.0 * shares[0], shares[1], 0.0 * shares[2] + 1.0])[:, 0]
    count = len(done)
    # the normal matters to a robot only: it swings over on the second leg
    one, other = (
        np.repeat(_about(mandrel, each.normal[k], each.mandrel[k]), count, axis=0)
        for each, k in ((before, -1), (after, 0))
    )
    return Blocks(
        **{name: np.repeat(getattr(after, name)[:1], count) for name in ("layer", "circuit", "passed", "arc_length")},
        **axes, path=np.full(count, -1), kind=np.full(count, TRAVEL),
        point=mandrel.eye(axes["eye_x"], axes["eye_r"], axes["mandrel"]),
        tangent=_ahead(mandrel, axes["mandrel"], axes["roll"], axes["yaw"], side),
        normal=_about(mandrel, swung(one, other, done), -axes["mandrel"]),
        free_length=np.zeros(count), time=np.zeros(count), tension=np.zeros(count), slip=np.full(count, np.nan),
    )  # fmt: skip


def _widest(body: Body, one: float, other: float) -> float:
    """The largest radius of a body between two places along the axis."""
    low, high = min(one, other), max(one, other)
    inside = body.r[(body.x >= low) & (body.x <= high)]
    return float(np.concatenate([inside, np.interp([low, high], body.x, body.r)]).max())


def _about(mandrel: Mandrel, vectors: Floats, turned: Floats) -> Floats:
    """Vectors (n, 3) turned about the axis by angles (n,) in degrees, as the mandrel turns the part."""
    a, b, c = mandrel.turned(np.atleast_2d(vectors)).T
    cosine, sine = np.cos(np.radians(turned)), np.sin(np.radians(turned))
    return np.asarray(np.stack([a, cosine * b - sine * c, sine * b + cosine * c], axis=1) @ mandrel.frame)
