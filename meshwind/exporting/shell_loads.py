"""The load step of a shell deck: pressure, axial force and torque, and what holds the part."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
import scipy.linalg

from meshwind.core.cast import Floats, Ints
from meshwind.core.checks import check_word, is_number, text
from meshwind.core.errors import BadInputError
from meshwind.core.units import millimetres
from meshwind.core.vectors import TINY
from meshwind.exporting.shell_nodes import Nodes, Rim

FORCE = 1000.0
"""Axial force, in N, of a deck that is asked for no load: something to begin with."""
START, END, BOTH, NONE = HELD = "start", "end", "both", "none"
"""What holds the part: a clamped rim, both, or nothing, where six displacements are 0 to keep the part in place."""
EVERY_NODE, EVERY_ELEMENT = "NALL", "SHELL"
"""Sets of all nodes and of all elements."""
_NOTHING = 1e-12
"""Share of a load along an axis below which it is left out."""


@dataclass(frozen=True)
class Loads:
    """Loads of a deck, and the rims that are held; None of all three is a pull to begin with, 0 is no load.

    pressure: inside, in MPa, below 0 for pressure outside.  axial: force in N along the line between the middles of
    the rims, which pulls them apart above 0.  torque: in N m about that line, on the end rim counterclockwise seen from
    outside, on the start rim against it.  Raises BadInputError if one is not a number, or held rims take them all.
    """

    pressure: float | None = None
    axial: float | None = None
    torque: float | None = None
    held: str = START

    def __post_init__(self) -> None:
        for name, value in (("pressure", self.pressure), ("axial", self.axial), ("torque", self.torque)):
            if value is not None and not is_number(value):
                raise BadInputError(f"{name} is {text(value)}; give a number")
        check_word(self.held, "held", tuple(HELD))
        if self.held == BOTH and (self.axial or self.torque):
            raise BadInputError("axial force and torque act on rims that are not held; hold one of them")

    @property
    def given(self) -> bool:
        """Whether any load is given, be it 0."""
        return (self.pressure, self.axial, self.torque) != (None, None, None)

    def scaled(self, units: str) -> "Loads":
        """The loads in N and the unit of length; a pull to begin with if none is given."""
        mm = millimetres(units)
        axial = self.axial or 0.0
        if not self.given and self.held != BOTH:
            axial = FORCE
        pressure, torque = self.pressure or 0.0, self.torque or 0.0
        return replace(self, pressure=pressure * mm * mm, axial=axial, torque=torque * 1000.0 / mm)


def step(nodes: Nodes, asked: Loads, units: str, shares: Floats, calculix: bool) -> Iterator[str]:
    """Lines of the load step.

    shares (k,): area of each element's inside over that which the solver presses on; calculix: whether the deck is for
    CalculiX, which has output of its own kinds.
    """
    loads = asked.scaled(units)
    pressure, axial, torque = loads.pressure or 0.0, loads.axial or 0.0, loads.torque or 0.0
    start, end = nodes.rims
    free = [rim for rim, other in ((start, END), (end, START)) if loads.held in (other, NONE)]
    axis = _axis(nodes)
    yield from _about(nodes, loads, asked.given)
    yield "*STEP"
    yield "*STATIC"
    yield "*BOUNDARY"
    yield from _held(nodes, loads.held)
    on_rims: list[str] = []
    for rim in free:
        sign = 1.0 if rim is end else -1.0
        each = pressure * rim.shares[:, None] * rim.area + sign * axial * rim.shares[:, None] * axis
        each += sign * torque * _around(nodes.points[rim.nodes], rim, axis)
        on_rims += _forces(rim.nodes, each)
    if on_rims:
        yield "*CLOAD"
        yield from on_rims
    if pressure:
        yield from _inside(shares, pressure)
    yield from _output_of_calculix() if calculix else _output_of_abaqus()
    yield "*END STEP"


def _output_of_calculix() -> Iterator[str]:
    """Tables of displacements, and of stresses and strains at all points of all layers, and a file for viewers."""
    yield "** shell.dat: displacements of all nodes; stresses and strains in the axes of each layer's fibres, which are"
    yield "** components 11, 22, 33, 12, 13, 23, at the integration points, layer by layer from the inside out; shear"
    yield "** strains are half the engineering ones. shell.frd: the same at nodes, in global axes. CalculiX has neither"
    yield "** forces of sections of shells nor failure indices; meshwind solve computes these."
    yield f"*NODE PRINT, NSET={EVERY_NODE}"
    yield "U"
    yield f"*EL PRINT, ELSET={EVERY_ELEMENT}"
    yield "S, E"
    yield "*NODE FILE"
    yield "U, RF"
    yield "*EL FILE"
    yield "S, E"


def _output_of_abaqus() -> Iterator[str]:
    """Fields for Abaqus's viewer; stresses and strains of layers are in the axes of their fibres there."""
    yield "*OUTPUT, FIELD"
    yield "*NODE OUTPUT"
    yield "U, RF"
    yield "*ELEMENT OUTPUT, DIRECTIONS=YES"
    yield "S, E, SF, CFAILURE"


def _about(nodes: Nodes, loads: Loads, given: bool) -> Iterator[str]:
    """Comments on what acts on what."""
    pressure, axial, torque = loads.pressure or 0.0, loads.axial or 0.0, loads.torque or 0.0
    free = {START: "END", END: "START", NONE: "START and END", BOTH: ""}[loads.held]
    if loads.held == NONE:
        yield "** held: neither rim; six displacements of START and END are 0, to keep the part in place; they bear"
        yield "** no more than what pressure on the mesh's faces leaves out of balance"
    else:
        yield f"** held: {'START and END are' if loads.held == BOTH else loads.held.upper() + ' is'} clamped"
    if not given and axial:
        yield "** load to begin with, replace it by your own:"
    if pressure:
        pulls = " and ".join(
            f"{np.linalg.norm(pressure * rim.area):.6g} N on {name}"
            for name, rim in zip(("START", "END"), nodes.rims, strict=True)
            if name in free
        )
        ends = f"with what it has on a closed end, {pulls}" if pulls else "and none on the ends, which are clamped"
        yield f"** load: pressure of {pressure:.9g} N per unit of area on all elements, outwards from the inside,"
        yield f"** {ends}"
    if axial:
        yield f"** load: axial force of {axial:.9g} N in all on {free}, along the line between the middles of the rims"
    if torque:
        yield f"** load: torque of {torque:.9g} N times the unit of length on {free}, about that line"
    if not (pressure or axial or torque):
        yield "** load: none"


def _axis(nodes: Nodes) -> Floats:
    """Unit vector from the middle of the start rim to that of the end rim."""
    start, end = (rim.shares @ nodes.points[rim.nodes] for rim in nodes.rims)
    along = end - start
    if np.linalg.norm(along) < _NOTHING * np.ptp(nodes.points, axis=0).max():
        along = nodes.rims[1].area
    return np.asarray(along / max(float(np.linalg.norm(along)), TINY))


def _held(nodes: Nodes, held: str) -> Iterator[str]:
    if held == NONE:
        yield from (f"{node}, {direction}, {direction}" for node, direction in _fixing(nodes))
    else:
        yield from (f"{name.upper()}, 1, 6" for name in (START, END) if held in (name, BOTH))


def _fixing(nodes: Nodes) -> list[tuple[int, int]]:
    """Six displacements of nodes of both rims, by node and direction, that no motion as a rigid body leaves 0.

    The best conditioned ones, by a QR decomposition with pivoting of what the motions do: they are far apart, so that
    what a rim deforms by turns the part but little.
    """
    rim = np.concatenate([each.nodes for each in nodes.rims])
    away = nodes.points[rim] - nodes.points[rim].mean(axis=0)
    away = away / max(float(np.abs(away).max()), TINY)
    turns = np.stack([np.cross(axis, away) for axis in np.eye(3)])
    shifts = np.broadcast_to(np.eye(3)[:, None], turns.shape)
    motions = np.concatenate([shifts, turns]).reshape(6, -1)
    chosen = scipy.linalg.qr(motions, mode="r", pivoting=True)[1][:6]
    return sorted((int(rim[at // 3]) + 1, int(at % 3) + 1) for at in chosen)


def _around(points: Floats, rim: Rim, axis: Floats) -> Floats:
    """Forces (r, 3) on a rim with a torque of 1 about the axis and no sum: each square to its arm, and as large."""
    turned = np.cross(axis, points - rim.shares @ points) * rim.shares[:, None]
    return np.asarray(turned / max(float((np.cross(axis, points - rim.shares @ points) * turned).sum()), TINY))


def _inside(shares: Floats, pressure: float) -> Iterator[str]:
    """Pressure along the outward normals, as large on each element as its inside has it."""
    yield "*DLOAD"
    if (shares == 1.0).all():
        yield f"{EVERY_ELEMENT}, P, {pressure:.9g}"
        return
    for e, share in enumerate(shares, 1):
        yield f"{e}, P, {pressure * share:.9g}"


def _forces(nodes: Ints, forces: Floats) -> Iterator[str]:
    """Forces (r, 3) on nodes."""
    whole = float(np.abs(forces).max())
    for node, force in zip(nodes + 1, forces, strict=True):
        for direction, part in enumerate(force, start=1):
            if abs(part) > _NOTHING * whole:
                yield f"{node}, {direction}, {part:.9g}"
