"""What a mesh costs until it is a surface: time against one sparse factorisation of the same mesh, and memory.

    python examples/fit_cost.py --largest 1000000

For irregular meshes of a vase with 10k, 100k and 1M faces: reading, opening, flattening and fitting, each in units
of one SuperLU factorisation of the mesh's cotangent Laplacian, the fit's true error, and the peak memory of the
process that ran it.  Small meshes take several runs, and the shortest time counts, of each stage as of the
factorisation.  And how the true error falls from 1k to 64k vertices where the tolerance does not stop it.
"""

import argparse
import resource
import subprocess
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter

import igl
import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu
from scipy.spatial import Delaunay

import meshwind as mw
from meshwind.core.cast import Floats, Ints
from meshwind.mesh import mesh_from

SIZES = (10_000, 100_000, 1_000_000)
STAGES = ("read", "open", "flatten", "fit")
VERTICES = (1_000, 4_000, 16_000, 64_000)
RUNS, WORTH = 9, 200_000
"""Most runs, and the faces that all runs of a mesh are worth: on a shared machine one alone says little."""
JITTER = 1 / 3
"""Of the points, over their pitch."""


@dataclass(frozen=True)
class Turned:
    """A part of revolution about z, from z = 0 to its height."""

    radius: Callable[[Floats], Floats]
    height: float

    def points(self, u: Floats, v: Floats) -> Floats:
        """Points (n, 3) at turns u and shares v of the height."""
        z = self.height * v
        r = self.radius(z)
        return np.stack([r * np.cos(2 * np.pi * u), r * np.sin(2 * np.pi * u), z], axis=-1)

    def error(self, surface: mw.Surface) -> float:
        """Rms radial distance of a fitted surface to the part itself, over its diagonal."""
        P = surface.points(np.random.default_rng(5).random((20_000, 2)))
        off = np.hypot(P[:, 0], P[:, 1]) - self.radius(P[:, 2])
        return float(np.sqrt(np.mean(off**2))) / surface.size


VASE = Turned(lambda z: 1 + 0.35 * np.cos(0.75 * np.pi * z + 0.3) + 0.1 * np.sin(2.25 * z), 4.0)
PARTS = {
    "barrel": Turned(lambda z: 1 - 0.3 * (z - 1) ** 2, 2.0),
    "vase": VASE,
    "hyperboloid": Turned(lambda z: np.hypot(1.0, z - 1.5), 3.0),
}


def irregular(part: Turned, faces: int, seed: int = 0) -> tuple[Floats, Ints]:
    """Vertices on the part and about so many faces: jittered points of a periodic rectangle and their Delaunay mesh."""
    rng = np.random.default_rng(seed)
    turn = part.height / (2 * np.pi)
    around = round(np.sqrt(faces / 2 / turn))
    along = round(faces / 2 / around)
    i, j = np.meshgrid(np.arange(around), np.arange(along + 1), indexing="ij")
    jitter = rng.uniform(-JITTER, JITTER, (2, around, along + 1))
    jitter[1, :, [0, -1]] = 0.0
    # every other row is off by half a pitch, so that triangles are near equilateral
    u, v = (i + 0.5 * (j % 2) + jitter[0]).ravel() / around % 1.0, (j + jitter[1]).ravel() / along
    # a few pitches on either side are repeated beyond the other, and a face is taken by where its middle lies
    wrap = 4.0 / around
    left, right = np.flatnonzero(u > 1 - wrap), np.flatnonzero(u < wrap)
    place = np.concatenate([np.arange(len(u)), left, right])
    plane = np.stack([np.concatenate([u, u[left] - 1, u[right] + 1]), v[place] * turn], axis=1)
    found = Delaunay(plane).simplices
    a, b = (plane[found[:, k]] - plane[found[:, 0]] for k in (1, 2))
    area = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    middle = plane[found, 0].mean(axis=1)
    kept = (middle >= 0) & (middle < 1) & (np.abs(area) > 1e-6 / len(u))
    found = np.where(area[:, None] < 0, found[:, ::-1], found)[kept]
    return part.points(u, v), place[found].astype(np.int64)


def runs(faces: int) -> int:
    """How often a mesh of so many faces is measured."""
    return min(RUNS, max(1, WORTH // faces))


def factorisation(vertices: Floats, faces: Ints) -> float:
    """Seconds of one SuperLU factorisation of the cotangent Laplacian, one vertex held."""
    laplacian = sparse.csc_matrix(-igl.cotmatrix(vertices, faces))[1:, 1:]
    seconds = []
    for _ in range(runs(len(faces))):
        start = perf_counter()
        splu(laplacian)
        seconds.append(perf_counter() - start)
    return min(seconds)


def measure(path: Path, tolerance: float) -> dict[str, float]:
    """Seconds of each stage from the file to the surface, the net's size and the true error."""
    marks = [perf_counter()]
    mesh = mw.read(path)
    marks.append(perf_counter())
    annulus = mw.annulus(mesh)
    marks.append(perf_counter())
    chart = mw.flatten(annulus)
    marks.append(perf_counter())
    surface = mw.fit(chart, tolerance)
    marks.append(perf_counter())
    seconds: dict[str, float] = dict(zip(STAGES, np.diff(marks).tolist(), strict=True))
    net = surface.control_points
    return seconds | {"nu": net.shape[0], "nv": net.shape[1], "error": VASE.error(surface), "faces": len(mesh.faces)}


def child(path: Path, tolerance: float) -> None:
    """Measure in a process of its own, whose peak memory is the job's; compile first on a small mesh."""
    small = path.parent / "small.ply"
    write(small, *irregular(VASE, 2000))
    measure(small, tolerance)
    found = measure(path, tolerance)
    for _ in range(runs(int(found["faces"])) - 1):
        again = measure(path, tolerance)
        found |= {stage: min(found[stage], again[stage]) for stage in STAGES}
    found["memory"] = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024.0
    print(" ".join(f"{key}={value!r}" for key, value in found.items()))


def write(path: Path, vertices: Floats, faces: Ints) -> None:
    """Write a mesh as binary PLY in double precision."""
    face = np.zeros(len(faces), dtype=[("count", "u1"), ("corners", "<i4", 3)])
    face["count"], face["corners"] = 3, faces
    head = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices)}\n"
    head += "".join(f"property double {x}\n" for x in "xyz")
    head += f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    path.write_bytes(head.encode() + vertices.astype("<f8").tobytes() + face.tobytes())


def row(folder: Path, faces: int, tolerance: float) -> str:
    """One line of the table."""
    vertices, corners = irregular(VASE, faces)
    path = folder / f"vase-{faces}.ply"
    write(path, vertices, corners)
    lu = factorisation(vertices, corners)
    command = [sys.executable, __file__, "--measure", str(path), "--tolerance", repr(tolerance)]
    words = subprocess.run(command, check=True, capture_output=True, text=True).stdout.split()
    found = {key: float(value) for key, value in (word.split("=") for word in words)}
    total = sum(found[stage] for stage in STAGES)
    parts = "".join(f"{found[stage] / lu:9.2f}" for stage in STAGES)
    net = f"{found['nu']:.0f}x{found['nv']:.0f}"
    return (
        f"{len(corners):9d}{lu:9.3f} s{parts}{total / lu:9.2f}{total:11.2f} s{found['memory'] / 2**30:8.2f} GB"
        f"{net:>10}{found['error']:10.1e}"
    )


def order(part: Turned) -> str:
    """True errors of fits to ever finer meshes, and the order between neighbours."""
    errors, sizes = [], []
    for count in VERTICES:
        vertices, faces = irregular(part, 2 * count)
        surface = mw.fit(mw.flatten(mw.annulus(mesh_from(vertices, faces))), 1e-12)
        errors.append(part.error(surface))
        sizes.append(len(vertices))
    steps = -2 * np.diff(np.log(errors)) / np.diff(np.log(sizes))
    orders = [f"({step:.1f})" for step in steps]
    return "".join(f"{error:10.1e} {step:5}" for error, step in zip(errors, [" ", *orders], strict=True))


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])  # type: ignore[union-attr]
    parser.add_argument("--largest", type=int, default=SIZES[-1], help="most faces of a mesh")
    parser.add_argument("--tolerance", type=float, default=1e-5, help="the fit's, over the diagonal")
    parser.add_argument("--measure", type=Path, help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.measure is not None:
        child(given.measure, given.tolerance)
        return
    heads = "".join(f"{stage:>9}" for stage in (*STAGES, "total"))
    print(f"{'faces':>9}{'one LU':>11}{heads}  (of one LU){'memory':>11}{'net':>10}{'error':>10}")
    with tempfile.TemporaryDirectory() as folder:
        for faces in (size for size in SIZES if size <= given.largest):
            print(row(Path(folder), faces, given.tolerance), flush=True)
    print("\nrms error over the diagonal, and its order in the vertices' spacing; tolerance 1e-12")
    print(f"{'vertices':12}", "".join(f"{count:10d}      " for count in VERTICES))
    for name, part in PARTS.items():
        print(f"{name:12}", order(part), flush=True)


if __name__ == "__main__":
    main()
