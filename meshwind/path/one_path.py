"""One path of a batch."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from meshwind.core.cast import Bools, Floats
from meshwind.core.geometry import Block, Geometric
from meshwind.path.blocks import paths_block
from meshwind.path.kernels.status import Status

if TYPE_CHECKING:
    from meshwind.path.paths import Paths


@dataclass(frozen=True)
class OnePath(Geometric):
    """One path of a batch, as iteration over `Paths` gives it.

    Attributes
    ----------
    paths : Paths
        The batch.
    number : int
        Its number there, from 0.

    Examples
    --------
    >>> import meshwind as mw
    >>> tube = mw.shapes.cylinder(radius=1.0, length=3.0)
    >>> for path in mw.solve(tube, start=[(0.0, 0.0)], end=[(0.5, 1.0)], particles=101):
    ...     print(path, path.points.shape, path.status.name)
    <meshwind OnePath 0: 101 particles, converged> (101, 3) CONVERGED
    """

    paths: Paths
    number: int

    def __repr__(self) -> str:
        return f"<meshwind OnePath {self.number}: {len(self)} particles, {self.status.name.lower()}>"

    def __len__(self) -> int:
        return self.paths.gap.shape[1]

    @property
    def block(self) -> Block:
        """The polyline, with the fields of paths.vtp."""
        block = paths_block(self.paths.subset(np.array([self.number])))
        return replace(block, line_data={**block.line_data, "path": np.array([self.number])})

    @property
    def points(self) -> Floats:
        """Positions (n, 3) of the particles, in the surface's units."""
        return self.paths.points[self.number]

    @property
    def uv(self) -> Floats:
        """Parametric positions (n, 2), u in turns and unwrapped."""
        return self.paths.uv[self.number]

    @property
    def on_surface(self) -> Bools:
        """Whether each particle (n,) touches the surface."""
        return self.paths.on_surface[self.number]

    @property
    def gap(self) -> Floats:
        """Distance (n,) from the surface, 0 where the particle touches it."""
        return self.paths.gap[self.number]

    @property
    def normal(self) -> Floats:
        """Outward unit normal (n, 3) at the particle or its foot."""
        return self.paths.normal[self.number]

    @property
    def slip(self) -> Floats:
        """Required friction (n,); NaN off the surface and at the two ends."""
        return self.paths.slip[self.number]

    @property
    def family(self) -> int:
        """Sense of turning, +1 or -1."""
        return int(self.paths.family[self.number])

    @property
    def status(self) -> Status:
        """How it ended."""
        return Status(int(self.paths.status[self.number]))

    @property
    def length(self) -> float:
        """Length of the fibre, in the surface's units: the field `fibre_length` of paths.vtp, not the polyline's."""
        return float(self.paths.length[self.number])

    @property
    def advice(self) -> str:
        """What became of it, in one line; see `Paths.advice`."""
        return self.paths.advice(self.number)
