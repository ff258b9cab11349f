"""Types of the laminate's figures in report.json."""

from typing import TypedDict

from meshwind.results.pattern_types import CoverFigures, Spread


class HoldFigures(TypedDict):
    """A hoop's hold: friction that it needs, and shares of its length that slip off, or do not press at all."""

    friction_needed: float
    slips: float
    lifts: float


class RaisedFigures(TypedDict):
    """The surface above a layer: distances from the offset that it stands for, and what smoothing changed.

    evened: root mean square of that over the mean thickness; hollow: largest height over the radius of a hollow.
    """

    off_rms: float
    off_max: float
    evened: float
    hollow: float


class JoinFigures(TypedDict):
    """The way to a layer from the one before: its length, and the friction that it needs, None where it would lift."""

    length: float
    slip: float | None


class LayerFigures(TypedDict):
    """A layer: lengths in the mesh's units, angles in degrees, masses in g.

    circuits: paths of a family, or passes of a hoop; over_rim: share of the volume that hangs over a rim and counts as
    laid inside of it; off_below: largest distance of the fibre from the surface below where it lies on that; masses are
    None where tex is not known; hold is that of a hoop, None for others; turnarounds at the start and at the
    end, and the join from the layer before, where the layers are one filament.
    """

    layer: int
    kind: str
    circuits: int
    left_out: int
    friction: float
    band_width: float
    band_thickness: float
    bridges: str
    angle: Spread
    cover: CoverFigures
    thickness: Spread
    fibre_length: float
    volume: float
    over_rim: float
    filler_volume: float
    fibre_mass: float | None
    resin_mass: float | None
    off_below: float
    hold: HoldFigures | None
    raised: RaisedFigures
    turnarounds: list[str] | None
    join: JoinFigures | None
