"""Scenes of a redesign: what moved, how the rounds went, and a cut through a bridge."""

from dataclasses import dataclass

from meshwind.appearance.looks import Scale
from meshwind.core.cast import Bools, Floats, Ints
from meshwind.pictures.contents import Frame


@dataclass(frozen=True)
class RedesignScene:
    """Vertices (n, 3) before and after, with faces (m, 3), and positions of the displacement on the scale (n,).

    arrows (k,): vertices that have one; longer: by what the arrows are longer than the displacements; outward (k,):
    whether they begin on the part, rather than end there.
    """

    frame: Frame
    scale: Scale
    shares: Floats
    before: Floats
    after: Floats
    faces: Ints
    arrows: Ints
    longer: float
    outward: Bools


@dataclass(frozen=True)
class RoundsScene:
    """The rounds of a redesign: before all and after each, largest gap, bridged share and largest move (r,).

    stages (r,): numbers of the stage; names (r,): of the rounds; threshold: a gap that counts as none.
    """

    frame: Frame
    gaps: Floats
    bridged: Floats
    moves: Floats
    stages: Ints
    names: tuple[str, ...]
    threshold: float


@dataclass(frozen=True)
class SliceScene:
    """A plane that cuts a part along a bridge, its first coordinate along the fibre's span and its second upwards.

    before, after (k, 2, 2): segments of the part; fibre, fibre_after (n, 2): the fibre near the plane; gap (2, 2): foot
    and fibre where the gap is largest; low, high (2,): corners of what is shown.
    """

    frame: Frame
    before: Floats
    after: Floats
    fibre: Floats
    fibre_after: Floats
    gap: Floats
    low: Floats
    high: Floats
