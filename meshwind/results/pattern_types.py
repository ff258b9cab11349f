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


class DwellFigures(TypedDict):
    """Turns between the end of a path and the start of the next, at both ends."""

    start: MeanSpread
    end: MeanSpread


class MovedFigures(TypedDict):
    """Revolutions that were asked for, and those with which the layer closes."""

    asked: float
    wound: float


class TurnaroundFigures(TypedDict):
    """A turnaround: its kind, the slip that it needs, its reach beyond the rim, and the rule that it is proved by."""

    end: str
    kind: str
    slip: float
    reach: float
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
    """A layer that is closed: N circuits in M turns, each K places ahead of the one before."""

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
    fibre_length: float
    left_out: int
    alternatives: list[AlternativeFigures]
