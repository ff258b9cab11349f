"""How a path ended: the statuses that the solver sets, with advice for the user."""

from enum import IntEnum


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
        6: in equilibrium, but the fibre turns over an edge that is sharper than its particles can follow.

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
    def advice(self) -> str:
        """What the status means and what to do about it, in one line."""
        return _ADVICE[self]


_ADVICE = {
    Status.CONVERGED: "taut equilibrium",
    Status.SLID_OFF_START: "the fibre slides off the start rim (v=0): use fewer revolutions, or a wider opening there",
    Status.SLID_OFF_END: "the fibre slides off the end rim (v=1): use fewer revolutions, or a wider opening there",
    Status.UNSTABLE: "no stable path: the fibre is balanced on a ridge and falls off it (a conjugate point, or "
    "windings too long for the bulge): use fewer revolutions",
    Status.LEFT_CHART: "the fibre slides off an open edge of the surface (u=0 or u=1): move the ends away from it",
    Status.TOO_COARSE: "the fibre turns over an edge that is too sharp for the distance of its particles: "
    "use more particles (--particles)",
    Status.STALLED: "the solver stopped before the fibre was at rest: use fewer revolutions, or a smoother surface "
    "(--tolerance 1e-3)",
}
