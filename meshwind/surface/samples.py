"""The mesh's vertices as data for a fit: where they lie in space and, corrected round by round, in the plane."""

from dataclasses import dataclass, replace

import numpy as np

from meshwind.cast import Bools, Floats
from meshwind.chart.chart import Chart
from meshwind.surface.foot import feet
from meshwind.surface.infill import infill
from meshwind.surface.surface import Surface
from meshwind.threads import spread

LOOSE = 0.1
"""Weight of a vertex that trimming made, against one of the part's own."""


@dataclass(frozen=True)
class Samples:
    """Vertices about the part's middle (n, 3), their place in the plane (n, 2), and how far they count (n,)."""

    points: Floats
    uv: Floats
    weight: Floats
    rim: Bools
    trusted: Bools
    middle: Floats
    chart: Chart

    @staticmethod
    def of(chart: Chart) -> "Samples":
        """All vertices of a chart's annulus, at their places on the chart."""
        annulus = chart.annulus
        middle = annulus.vertices.mean(axis=0)
        rim = np.zeros(len(annulus.vertices), dtype=bool)
        rim[np.concatenate(annulus.rims)] = True
        weight = np.where(annulus.trusted, 1.0, LOOSE)
        return Samples(annulus.vertices - middle, np.array(chart.uv), weight, rim, annulus.trusted, middle, chart)

    def between(self, spans: tuple[int, int]) -> tuple[Floats, Floats]:
        """Points between vertices for a net of so many spans: (k, 2) in the plane, (k, 3) about the middle."""
        faces = self.chart.annulus.faces
        turns = np.round(self.chart.corner_uv[..., 0] - self.chart.uv[faces][..., 0])
        corners = self.uv[faces]
        corners[..., 0] += turns
        uv, points = infill(self.chart.annulus, corners, spans)
        return uv, points - self.middle

    def corrected(self, surface: Surface) -> tuple["Samples", Floats]:
        """Every vertex moved to its foot in the plane, on a rim along the rim; and the distances (n,)."""
        moved = self.uv.copy()
        frames = np.empty((len(moved), 6, 3))
        spread(feet, len(moved), 500, surface.net, surface.periodic, self.points, moved, frames)
        rim = self.rim
        moved[rim, 1] = self.uv[rim, 1]
        at = surface.frames(self.uv[rim])
        miss = self.points[rim] - at[:, 0]
        moved[rim, 0] = self.uv[rim, 0] + (miss * at[:, 1]).sum(axis=1) / (at[:, 1] ** 2).sum(axis=1)
        frames[rim] = surface.frames(moved[rim])
        return replace(self, uv=moved), np.asarray(np.linalg.norm(self.points - frames[:, 0], axis=1))
