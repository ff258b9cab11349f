"""Layers on layers: what each lies on, how thick it is, and the surface that it leaves to the next."""

from dataclasses import dataclass

import numpy as np

from meshwind.core.brief import brief
from meshwind.filament.band import Roving
from meshwind.filament.closing import ClosedLayer
from meshwind.filament.hoop import Hoop
from meshwind.filament.joins import Strand
from meshwind.filament.levels import Levels
from meshwind.filament.offset import Raised, raised
from meshwind.filament.part_turn import Bend
from meshwind.filament.stations import Stations, helix_stations, hoop_stations
from meshwind.filament.thickness import Laying, Thickness, Tracks, deposit, tracks
from meshwind.path.paths import Paths
from meshwind.surface.surface import Surface


@dataclass(frozen=True)
class LaidLayer:
    """A layer of a laminate.

    Attributes
    ----------
    surface : Surface
        What it lies on: the part, or the layers below.
    paths : Paths or None
        Its paths, if it is helical.
    hoop : Hoop or None
        Its fibre, if it is a hoop.
    laying : Laying
        Its band.
    thickness : Thickness
        Its thickness over the surface.
    raised : Raised
        The surface that it leaves to the next layer.
    stations : Stations
        Its angle and cover along the part.
    friction : float
        Coefficient of friction between the fibre and what it lies on.
    left_out : int
        Paths that are not at rest: they are in no figure and not in the thickness.
    roving : Roving or None
        What its band is made of, where that is known.
    strand : Strand or None
        Its fibre in the laminate's filament, and the join that leads to it, where the layers are one.
    shortfall : str
        What was wound instead of an angle that is out of reach, and why; "" where it is met.
    """

    surface: Surface
    paths: Paths | None
    hoop: Hoop | None
    laying: Laying
    thickness: Thickness
    raised: Raised
    stations: Stations
    friction: float
    left_out: int = 0
    roving: Roving | None = None
    strand: Strand | None = None
    shortfall: str = ""

    __repr__ = brief

    @property
    def closed(self) -> ClosedLayer | None:
        """The layer as a closed pattern, if it is helical and of one filament."""
        return None if self.strand is None else self.strand.tail.layer

    @property
    def kind(self) -> str:
        """ "helical" or "hoop"."""
        return "helical" if self.hoop is None else "hoop"

    @property
    def tracks(self) -> Tracks:
        """Where its fibres lie."""
        if self.hoop is not None:
            return self.hoop.tracks
        assert self.paths is not None
        return tracks(self.paths)

    @property
    def fibre_length(self) -> float:
        """Length of its band where it lies on the part or bridges it, in the surface's units."""
        return self.tracks.length + sum(each.length for each in _bends(self.strand))

    @property
    def circuits(self) -> int:
        """Paths of a family, or passes of a hoop."""
        if self.hoop is not None:
            return int(self.hoop.course.passed[-1]) + 1
        assert self.paths is not None
        return int(max((self.paths.family == family).sum() for family in (1, -1)))

    @property
    def off_below(self) -> float:
        """Largest distance of the fibre from the surface below where it lies on that, in the surface's units."""
        if self.hoop is not None:
            points, uv = self.hoop.course.points, self.hoop.tracks.uv[0]
        else:
            assert self.paths is not None
            touching = self.paths.on_surface
            points, uv = self.paths.points[touching], self.paths.uv[touching]
        return float(np.linalg.norm(points - self.surface.points(uv), axis=1).max(initial=0.0))


@dataclass(frozen=True)
class Laminate:
    """Layers in order of winding, each on the surface that those below it leave.

    Attributes
    ----------
    layers : tuple of LaidLayer
        The layers, the first on the part.
    """

    layers: tuple[LaidLayer, ...]

    __repr__ = brief

    @property
    def surfaces(self) -> tuple[Surface, ...]:
        """The surfaces below each layer and above the last: one more than layers."""
        return (*(layer.surface for layer in self.layers), self.layers[-1].raised.surface)


@dataclass(frozen=True)
class Ply:
    """What a layer is beside its fibres: band, friction and material; see `LaidLayer`."""

    laying: Laying
    friction: float = 0.0
    roving: Roving | None = None


def helical_layer(paths: Paths, ply: Ply, lines: Levels, left_out: int = 0, strand: Strand | None = None) -> LaidLayer:
    """The layer of taut paths, deposited on their surface with these level lines, and the surface above it."""
    thickness, above = _deposited(paths.surface, [tracks(paths), *_bends(strand)], ply)
    stations = helix_stations(paths, lines, ply.laying.width)
    return LaidLayer(
        paths.surface, paths, None, ply.laying, thickness, above, stations, ply.friction, left_out, ply.roving, strand
    )


def hoop_layer(surface: Surface, laid: Hoop, ply: Ply, lines: Levels, strand: Strand | None = None) -> LaidLayer:
    """The layer of a hoop, deposited on its surface with these level lines, and the surface above it."""
    thickness, above = _deposited(surface, [laid.tracks], ply)
    stations = hoop_stations(laid, lines, ply.laying.width)
    return LaidLayer(surface, None, laid, ply.laying, thickness, above, stations, ply.friction, 0, ply.roving, strand)


def _bends(strand: Strand | None) -> list[Tracks]:
    """The turnarounds of a layer that lie on the part."""
    closed = None if strand is None else strand.tail.layer
    bends = [] if closed is None else [each for each in closed.turnarounds if isinstance(each, Bend)]
    return [each.tracks for each in bends if each.tracks is not None]


def _deposited(surface: Surface, laid: list[Tracks], ply: Ply) -> tuple[Thickness, Raised]:
    """The thickness of fibres that lie there, and the surface above them."""
    thickness, *others = (deposit(surface, each, ply.laying) for each in laid)
    for other in others:
        thickness = thickness.and_(other)
    return thickness, raised(surface, thickness, ply.laying.width)
