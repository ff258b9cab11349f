"""How a path ended: the statuses that the solver sets, with advice for the user."""

from __future__ import annotations

from enum import IntEnum

from meshwind.core.spoken import argument


class Status(IntEnum):
    """How a path ended.

    0 is a taut equilibrium; every other value has advice on what to do about it.

    Attributes
    ----------
    CONVERGED : int
        0: the path is in equilibrium.
    SLID_OFF_START : int
        1: the fibre slides off the start rim, v=0.
    SLID_OFF_END : int
        2: the fibre slides off the end rim, v=1.
    UNSTABLE : int
        3: there is no stable path; the fibre is balanced on a ridge and leaves it to either side.
    STALLED : int
        4: the solver stopped before the fibre was in equilibrium.
    LEFT_CHART : int
        5: the fibre slides off an open edge of a surface that does not close in u.
    TOO_COARSE : int
        6: in equilibrium, but the surface stands out of the fibre between two of its particles.

    Examples
    --------
    >>> import meshwind as mw
    >>> mw.Status(0).name, mw.Status.CONVERGED.advice
    ('CONVERGED', 'taut equilibrium')
    """

    CONVERGED = 0
    SLID_OFF_START = 1
    SLID_OFF_END = 2
    UNSTABLE = 3
    STALLED = 4
    LEFT_CHART = 5
    TOO_COARSE = 6

    @property
    def meaning(self) -> str:
        """What the status means, in one line."""
        return _MEANING[self]

    @property
    def advice(self) -> str:
        """What the status means and what may help, in one line; `Paths.advice` names what was tried."""
        if self not in _MAY_HELP:
            return _MEANING[self]
        may_help = _MAY_HELP[self].format(particles=argument("particles"), tolerance=argument("tolerance", "1e-3"))
        return f"{_MEANING[self]}: {may_help}"


_MEANING = {
    Status.CONVERGED: "taut equilibrium",
    Status.SLID_OFF_START: "the fibre slides off the start rim (v=0)",
    Status.SLID_OFF_END: "the fibre slides off the end rim (v=1)",
    Status.UNSTABLE: "no stable path: the fibre is balanced on a ridge and falls off it (a conjugate point, or "
    "windings too long for the bulge)",
    Status.LEFT_CHART: "the fibre slides off an open edge of the surface (u=0 or u=1)",
    Status.TOO_COARSE: "the particles are too far apart for the surface, which stands out of the fibre between two "
    "of them (an edge, a rib, or a fold)",
    Status.STALLED: "the solver stopped before the fibre was at rest",
}
_MAY_HELP = {
    Status.SLID_OFF_START: "fewer revolutions, more friction, or a wider opening there may hold it",
    Status.SLID_OFF_END: "fewer revolutions, more friction, or a wider opening there may hold it",
    Status.UNSTABLE: "fewer revolutions or more friction may hold it",
    Status.LEFT_CHART: "ends further away from it, or more friction, may hold it",
    Status.TOO_COARSE: "more particles ({particles}) may resolve it, or a smoother surface ({tolerance})",
    Status.STALLED: "fewer revolutions, more particles, or a smoother surface ({tolerance}) may bring it to rest",
}
