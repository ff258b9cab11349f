"""Coordinates in decks: cylindrical and spherical ones, local systems, and rotations about an axis."""

from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Floats
from meshwind.core.vectors import rotation
from meshwind.mesh.io.deck.blocks import Block
from meshwind.mesh.io.deck.numbers import floats_of


@dataclass(frozen=True)
class Place:
    """A rigid motion: rotation (3, 3), then shift (3,)."""

    rotation: Floats
    shift: Floats

    def moved(self, points: Floats) -> Floats:
        """Points (n, 3) after the motion."""
        return points @ self.rotation.T + self.shift


STILL = Place(np.eye(3), np.zeros(3))


def cartesian(given: Floats, system: str, block: Block) -> Floats:
    """Positions from rectangular (R), cylindrical (C: r, theta, z) or spherical (S: r, theta, phi) coordinates.

    Angles are in degrees: theta from x towards y, phi from the plane of x and y towards z (*NODE in the Abaqus
    documentation, figure of the coordinate systems, and *NMAP, where phi is 0 in the plane square to the polar axis).
    """
    kind = system.strip().upper()
    if kind in ("", "R", "RC", "RECTANGULAR"):
        return given
    r, theta = given[:, 0], np.radians(given[:, 1])
    if kind in ("C", "CYLINDRICAL"):
        return np.column_stack([r * np.cos(theta), r * np.sin(theta), given[:, 2]])
    if kind not in ("S", "SPHERICAL"):
        raise block.refusal(f"has coordinates of SYSTEM={system[:20]}, which is not known; give R, C or S")
    phi = np.radians(given[:, 2])
    return np.column_stack([r * np.cos(theta) * np.cos(phi), r * np.sin(theta) * np.cos(phi), r * np.sin(phi)])


def local_system(block: Block) -> Place:
    """The system of *SYSTEM: origin a and point b on the x axis, and in the second line c in the plane of x and y.

    Without c the z axis stays, and the x axis is projected onto the plane of x and y; with a alone the axes stay, and
    without data the global system is back.
    """
    rows = floats_of(block).rows()
    if not rows:
        return STILL
    a, b = np.array((rows[0] + [0.0] * 6)[:6]).reshape(2, 3)
    if len(rows[0]) < 4 and len(rows) == 1:
        return Place(np.eye(3), a)
    x = b - a
    if len(rows) == 1:
        x[2], z = 0.0, np.array([0.0, 0.0, 1.0])
    else:
        z = np.cross(x, np.array((rows[1] + [0.0] * 3)[:3]) - a)
    if not (_size(x) > 0.0 and _size(z) > 1e-12 * _size(x) ** 2):
        raise block.refusal("gives no axes, as its points coincide or lie in a line; mend it")
    x, z = x / _size(x), z / _size(z)
    return Place(np.column_stack([x, np.cross(z, x), z]), a)


def instance_place(block: Block) -> Place:
    """Place of *INSTANCE: a translation, then a rotation about the axis from a to b by an angle in degrees.

    A first line that is blank, or of commas only, is a translation of zero.
    """
    rows = floats_of(block).rows()
    if len(rows) == 1 and len(rows[0]) > 3 and _begins_empty(block):
        rows = [[], *rows]
    shift = np.array((rows[0] + [0.0] * 3)[:3]) if rows else np.zeros(3)
    if len(rows) > 2 or (rows and len(rows[0]) > 3) or (len(rows) == 2 and len(rows[1]) > 7):
        raise block.refusal("has more numbers than a translation and a rotation; mend it")
    if len(rows) < 2:
        return Place(np.eye(3), shift)
    a, b = np.array((rows[1] + [0.0] * 6)[:6]).reshape(2, 3)
    if not _size(b - a) > 0.0:
        raise block.refusal("has a rotation about an axis of no length; mend it")
    turn = about(b - a, (rows[1] + [0.0] * 7)[6])
    return Place(turn, turn @ (shift - a) + a)


def _begins_empty(block: Block) -> bool:
    """Whether the first line of data has no numbers; remarks do not count."""
    lines = (line.strip() for line in block.data.split(b"\n"))
    return not next((line for line in lines if not line.startswith(b"**")), b"").strip(b", \t")


def about(axis: Floats, degrees: float) -> Floats:
    """Rotation (3, 3) about an axis through the origin."""
    return rotation(axis / _size(axis), float(np.radians(degrees)))


def _size(vector: Floats) -> float:
    return float(np.linalg.norm(vector))
