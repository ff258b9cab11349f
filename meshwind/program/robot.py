"""The program as poses of the eye for a robot, past a mandrel that an external axis turns."""

from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Floats
from meshwind.core.vectors import unit
from meshwind.program.blocks import TRAVEL, Blocks
from meshwind.program.mandrel import Mandrel

HEADER = "index,role,layer,circuit,pass,path,kind,time,speed,mandrel_deg,x,y,z,qw,qx,qy,qz,free_length"
LEGEND = {
    "frame": "x along the mandrel's axis, y from it to the eye, z = x cross y; lengths in mm",
    "pose": "z from the eye along the free span to the part, y = normal cross tangent, x = y cross z",
    "role": "0 approach, 1 wind, 2 retract, 3 travel: cut the fibre before the first of them, tie it on after the last",
    "kind": "0 laid on the part, 1 bridge, 2 turnaround, 3 dwell, 4 join, 5 travel",
    "speed": "of the fibre through the eye, in mm a second, on the way to the pose",
    "mandrel_deg": "of the external axis, in degrees, unwrapped",
}
"""What the columns are."""
APPROACH = 100.0
"""Distance in mm from which the eye comes to its first pose, and to which it goes from its last."""


@dataclass(frozen=True)
class RobotPoses:
    """Positions (n, 3) of the eye and quaternions (n, 4), w first, in the frame that stands still."""

    position: Floats
    quaternion: Floats

    @property
    def axes(self) -> Floats:
        """The axes (n, 3, 3) of the eye as columns: z along the span to the part."""
        from scipy.spatial.transform import Rotation

        return np.asarray(Rotation.from_quat(self.quaternion[:, [1, 2, 3, 0]]).as_matrix())


def robot_poses(blocks: Blocks, mandrel: Mandrel) -> RobotPoses:
    """The poses of the eye in blocks, in the mesh's units."""
    turn = np.radians(blocks.mandrel)
    cosine, sine = np.cos(turn), np.sin(turn)

    def standing(vectors: Floats) -> Floats:
        a, b, c = mandrel.turned(vectors).T
        return np.stack([a, cosine * b - sine * c, sine * b + cosine * c], axis=1)

    tangent, normal = standing(blocks.tangent), standing(blocks.normal)
    position = np.stack([blocks.eye_x, blocks.eye_r, np.zeros(len(blocks))], axis=1)
    z = -tangent
    y = unit(np.cross(normal, tangent))
    return RobotPoses(position, _quaternions(np.stack([np.cross(y, z), y, z], axis=2)))


def _quaternions(frames: Floats) -> Floats:
    """Unit quaternions (n, 4), w first, of rotations (n, 3, 3), each nearer to the one before than its opposite."""
    from scipy.spatial.transform import Rotation

    found = Rotation.from_matrix(frames).as_quat()[:, [3, 0, 1, 2]]
    sign = np.where((found[1:] * found[:-1]).sum(axis=1) < 0.0, -1.0, 1.0)
    return np.asarray(found * np.cumprod(np.append(1.0, sign))[:, None])


def rows(blocks: Blocks, mandrel: Mandrel, scale: float) -> Floats:
    """The rows (n + 2, 18) of the file, approach and retreat included; scale: mm in the mesh's unit."""
    found = robot_poses(blocks, mandrel)
    position = scale * found.position
    step = np.diff(blocks.time, prepend=blocks.time[0])
    paid = scale * np.append(0.0, blocks.drawn)
    speed = np.divide(paid, step, out=np.zeros_like(paid), where=step > 0.0)
    role = np.where(blocks.kind == TRAVEL, 3.0, 1.0)
    table = np.column_stack(
        [role, blocks.layer, blocks.circuit, blocks.passed, blocks.path, blocks.kind, blocks.time, speed]
        + [blocks.mandrel, position, found.quaternion, scale * blocks.free_length]
    )
    first, last = table[0].copy(), table[-1].copy()
    first[0], last[0] = 0.0, 2.0
    for row in (first, last):
        row[10] += APPROACH  # away from the axis
        row[7] = 0.0
    whole = np.concatenate([first[None], table, last[None]])
    return np.column_stack([np.arange(len(whole)), whole])
