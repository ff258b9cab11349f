"""Blocks of programs that no part was wound for, with a fibre that leads to their eye."""

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.program.blocks import Blocks
from meshwind.program.mandrel import Mandrel
from meshwind.program.readback.compare import Part

MANDREL = Mandrel(np.array([3.0, -2.0, 5.0]), np.array([0.6, 0.0, 0.8]), np.array([0.8, 0.0, -0.6]))
"""An axis in no special place."""
PART = Part(MANDREL, 1.0, 400.0)


def blocks_of(columns: Floats, time: Floats, circuit: Ints, part: Part = PART, tension: float = 0.0) -> Blocks:
    """Blocks whose columns (n, 5) are mandrel, x, r, roll and yaw; the fibre is 0.2 of the part's diagonal long."""
    n = len(columns)
    mandrel, x, r, roll, yaw = columns.T
    on, angle = part.mandrel, -np.radians(mandrel)
    eye = on.origin + x[:, None] * on.direction + r[:, None] * (
        np.cos(angle)[:, None] * on.zero + np.sin(angle)[:, None] * on.third
    )  # fmt: skip
    turn = np.linspace(0.1, 2.0, n)
    tangent = np.stack([np.cos(turn), np.sin(turn) * 0.6, np.sin(turn) * 0.8], axis=1)
    span = np.full(n, 0.2 * part.diagonal)
    zero = np.zeros(n, dtype=np.int64)
    return Blocks(
        layer=zero, circuit=circuit, passed=zero, path=zero, kind=zero,
        arc_length=np.linspace(0.0, 5.0 * n, n), point=eye - span[:, None] * tangent, tangent=tangent,
        normal=np.roll(tangent, 1, axis=1), free_length=span, eye_x=x, eye_r=r, mandrel=mandrel, roll=roll, yaw=yaw,
        time=time, tension=np.full(n, tension), slip=np.zeros(n),
    )  # fmt: skip


def wound(turns: float = 3.0, count: int = 60, circuits: int = 3, start: float = 20.0, part: Part = PART) -> Blocks:
    """A plain program: to and fro, as often as there are circuits."""
    s = np.linspace(0.0, 1.0, count)
    swing = circuits * 2.0 * np.pi * s
    columns = np.stack([
        start + 360.0 * turns * s, 100.0 - 80.0 * np.cos(swing), 60.0 + 10.0 * np.sin(2.0 * swing),
        40.0 * np.sin(swing), 5.0 * np.cos(swing),
    ], axis=1)  # fmt: skip
    circuit = np.minimum((s * circuits).astype(np.int64), circuits - 1)
    return blocks_of(columns, 20.0 * s + np.sin(7.0 * s) ** 2, circuit, part)
