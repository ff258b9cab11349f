"""Types of the figures of closed layers in report.json, in the units of `report_types`."""

from typing import TypedDict


class Spread(TypedDict):
    """Minimum, median and maximum; None if there are no values."""

    min: float | None
    median: float | None
    max: float | None


class MeanSpread(TypedDict):
    """Minimum, mean and maximum."""

    min: float
    mean: float
    max: float


class CoverFigures(TypedDict):
    """Least and largest cover factor of one family along the part: 1 where its bands lie edge to edge on average."""

    min: float
    max: float


class DwellFigures(TypedDict):
    """Turns between the end of a path and the start of the next, at both ends."""

    start: MeanSpread
    end: MeanSpread


class MovedFigures(TypedDict):
    """Revolutions that were asked for, and those with which the layer closes."""

    asked: float
    wound: float


class TurnaroundFigures(TypedDict):
    """A turnaround: its kind, the slip that it needs, its reach beyond the rim, and the rule that it is proved by.

    radius: of the pins or of the shaft, None on a collar or a cap.
    """

    end: str
    kind: str
    slip: float
    reach: float
    radius: float | None
    rule: str


class AlternativeFigures(TypedDict):
    """Another pattern: about its median winding angle, its cover over that of the layer, and turns of dwell more."""

    circuits: int
    turns: int
    pattern_number: int
    leading: bool
    revolutions: float
    angle: float
    cover: float
    dwell: float | None


class PatternFigures(TypedDict):
    """A layer that is closed: N circuits in M turns, each K places ahead of the one before.

    angle, cover, thickness are those on the part, by station and cell; lengths and masses, in g, have the turnarounds.
    """

    circuits: int
    shift: int
    turns: int
    pattern_number: int
    leading: bool
    filaments: int
    words: str
    revolutions: MovedFigures
    dwell: DwellFigures
    angle: Spread
    turnarounds: list[TurnaroundFigures]
    cover: CoverFigures
    thickness: Spread | None
    fibre_length: float
    fibre_mass: float | None
    resin_mass: float | None
    left_out: int
    alternatives: list[AlternativeFigures]
