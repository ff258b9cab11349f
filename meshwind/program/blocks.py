"""The blocks of a program: where the fibre leaves the part, where the eye is, the axes and the time."""

from dataclasses import dataclass, fields

import numpy as np

from meshwind.core.brief import brief
from meshwind.core.cast import Floats, Ints
from meshwind.core.geometry import Data

TRAVEL = 5
"""Kind of a block in which the fibre is cut, and the eye goes to where the next filament is tied on."""


@dataclass(frozen=True)
class Blocks:
    """The n blocks of a program in order of winding; lengths in the mesh's units.

    Attributes
    ----------
    layer, circuit, passed, path, kind : ndarray of int, shape (n,)
        As in a filament: what the fibre is doing at the point, with `Kind`; or `TRAVEL`.
    arc_length : ndarray of float, shape (n,)
        Length laid since the program's start.
    point, tangent, normal : ndarray of float, shape (n, 3)
        Where the fibre leaves the part, its unit tangent in the direction of laying, and the outward unit normal.
    free_length : ndarray of float, shape (n,)
        Length of the free span: the eye is at point + free_length * tangent.  While the eye travels there is none.
    eye_x, eye_r : ndarray of float, shape (n,)
        The eye along the mandrel's axis, and its distance from it.
    mandrel, roll, yaw : ndarray of float, shape (n,)
        Angles of mandrel, roll and yaw in degrees, unwrapped; the mandrel's falls at most while the eye swings over
        an edge or where it goes round what is tilted to the axis.
    time : ndarray of float, shape (n,)
        Seconds since the start.
    tension : ndarray of float, shape (n,)
        Tension of the fibre in N, 0 where none is set.
    slip : ndarray of float, shape (n,)
        Friction that the fibre needs at the point; NaN in the air.
    """

    layer: Ints
    circuit: Ints
    passed: Ints
    path: Ints
    kind: Ints
    arc_length: Floats
    point: Floats
    tangent: Floats
    normal: Floats
    free_length: Floats
    eye_x: Floats
    eye_r: Floats
    mandrel: Floats
    roll: Floats
    yaw: Floats
    time: Floats
    tension: Floats
    slip: Floats

    __repr__ = brief

    def __len__(self) -> int:
        return len(self.time)

    @property
    def eye(self) -> Floats:
        """The eye (n, 3) in the mesh's coordinates, as it stands to the part."""
        return self.point + self.free_length[:, None] * self.tangent

    @property
    def travels(self) -> Ints:
        """Blocks (k, 2) after which the fibre is cut, and at which the next filament is tied on."""
        change = np.flatnonzero(np.diff(self.kind == TRAVEL))
        return np.stack([change[::2], change[1::2] + 1], axis=1)

    @property
    def drawn(self) -> Floats:
        """Length (n - 1,) of fibre that the eye gives on the way to each block but the first; none where it is cut."""
        cut = self.kind == TRAVEL
        return np.where(cut[1:] | cut[:-1], 0.0, np.diff(self.arc_length + self.free_length))

    def chosen(self, which: slice | Ints) -> "Blocks":
        """Some of the blocks."""
        return Blocks(*(getattr(self, each.name)[which] for each in fields(Blocks)))


LEGEND = {
    "index": ("", "number of the block, from 0"),
    "layer": ("", "number of the layer, from 0"),
    "circuit": ("", "number of the circuit, from 0"),
    "pass": ("", "number of the pass, from 0"),
    "path": ("", "path in paths.vtp, -1 where it is none"),
    "kind": ("", "0 laid on the part, 1 bridge, 2 turnaround, 3 dwell, 4 join, 5 travel with the fibre cut"),
    "arc_length": ("{u}", "length laid since the start"),
    **dict.fromkeys("xyz", ("{u}", "where the fibre leaves part, collar, pin or shaft")),
    **{f"t{axis}": ("", "unit tangent of the fibre there, in the direction of laying") for axis in "xyz"},
    **{f"n{axis}": ("", "outward unit normal there") for axis in "xyz"},
    "free_length": ("{u}", "length of the free span: the eye is at (x, y, z) + free_length (tx, ty, tz)"),
    "eye_x": ("{u}", "the eye along the mandrel's axis, from the axis' origin in program.json"),
    "eye_r": ("{u}", "distance of the eye from the mandrel's axis"),
    "mandrel_deg": ("degrees", "angle of the mandrel, unwrapped"),
    "roll_deg": ("degrees", "roll of the eye: atan2 of the tangent along and around the axis"),
    "time": ("s", "time since the start"),
    "tension": ("N", "tension of the fibre, 0 where none is set"),
    "slip": ("", "friction that the fibre needs there; nan in the air"),
}
"""What the columns of program.csv are."""


def columns(blocks: Blocks) -> Data:
    """The columns of program.csv, in their order."""
    vectors = zip(("x", "t", "n"), (blocks.point, blocks.tangent, blocks.normal), strict=True)
    apart = {
        axis if name == "x" else f"{name}{axis}": values[:, k]
        for name, values in vectors
        for k, axis in enumerate("xyz")
    }
    return {
        "index": np.arange(len(blocks)), "layer": blocks.layer, "circuit": blocks.circuit, "pass": blocks.passed,
        "path": blocks.path, "kind": blocks.kind, "arc_length": blocks.arc_length, **apart,
        "free_length": blocks.free_length, "eye_x": blocks.eye_x, "eye_r": blocks.eye_r, "mandrel_deg": blocks.mandrel,
        "roll_deg": blocks.roll, "time": blocks.time, "tension": blocks.tension, "slip": blocks.slip,
    }  # fmt: skip
