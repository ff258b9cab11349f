"""Small cases that together run every compiled kernel; as a script it prints what came out of each, as JSON.

Run with NUMBA_DISABLE_JIT=1 the kernels are ordinary Python, and with NUMBA_BOUNDSCHECK=1 they mind their arrays' ends.
"""

import json
import sys
import warnings
from collections.abc import Callable

import numpy as np
from mesh_shapes import tube
from walled_shapes import Grid, blob, pipe, tunnelled

import meshwind as mw
from meshwind.layup.layup import assess
from meshwind.mesh import mesh_from
from meshwind.path import Paths
from meshwind.results.maps import maps
from meshwind.results.schema import COVERAGE, LAYERS, WINDABILITY
from meshwind.surface import Surface, shapes
from meshwind.surface.fitting.deviation import Triangles
from meshwind.surface.grid import grid

Figures = list[float]


def waist() -> Surface:
    """Bridged all round."""
    return shapes.hyperboloid(1.0, 1.0, 1.5, (16, 8))


def barrel() -> Surface:
    return shapes.revolution(lambda z: 1 - 0.3 * (z - 1) ** 2, 0.0, 2.0, (16, 8))


def figures(paths: Paths) -> Figures:
    """Of converged paths what is unique, of all how they ended."""
    rest = paths.status == mw.Status.CONVERGED
    return [float(x) for x in (*paths.status, *paths.points[rest].ravel(), *paths.gap[rest].ravel())]


def laid(surface: Surface, friction: float = 0.0, turns: tuple[float, ...] = (0.2, 0.3)) -> Paths:
    start = [(0.1 * k, 0.0) for k in range(len(turns))]
    end = [(0.1 * k + turn, 1.0) for k, turn in enumerate(turns)]
    return mw.solve(surface, start, end, particles=17, friction=friction)


def fitted() -> Figures:
    vertices, faces = tube(lambda z: 1.0 + 0.2 * np.sin(z), around=10, along=8)
    surface = mw.fit(mw.flatten(mw.annulus(mesh_from(vertices, faces))))
    off = Triangles(vertices, faces).distances(surface.points([(0.1, 0.5), (0.7, 0.2)]))
    assert surface.error is not None
    return [surface.error.relative_max, *off.tolist()]


def walled() -> Figures:
    """A part with a wall, and one with a handle."""
    part, ring = pipe(grid=Grid(12, 30.0)), tunnelled(blob(Grid(16, 10.0)), 60.0, 2.0)
    found = mw.annulus(mesh_from(part.vertices, part.faces))
    assert found.wall is not None
    closed = mesh_from(ring.vertices, ring.faces)
    return [found.wall.thickness, float(len(found.faces)), float(len(closed.faces)), *closed.vertices[-1].tolist()]


def crossed() -> Figures:
    surface = barrel()
    ends = mw.families(surface, 3, 0.3)
    layup = assess(mw.solve(surface, ends.start, ends.end, family=ends.family, particles=17))
    on = grid(surface, 1, 16)
    found = maps(on, layup)
    sums = [float(np.nansum(found[name])) for name in (COVERAGE, LAYERS, WINDABILITY)]
    return [float(len(layup.crossings)), *sums]


def marched() -> Figures:
    trace = mw.trace(barrel(), (0.1, 0.2), 0.4, 1.0, slip=0.1)
    return [*trace.points[-1].tolist(), trace.arc_length[-1]]


CASES: dict[str, Callable[[], Figures]] = {
    "pressed": lambda: figures(laid(barrel())),
    "bridged": lambda: figures(laid(waist(), turns=(0.1, 0.6))),
    "held": lambda: figures(laid(shapes.cylinder(1.0, 2.0, (16, 8)), 0.2)),
    "held and bridged": lambda: figures(laid(waist(), 0.1, (0.2,))),
    "slides off": lambda: figures(laid(barrel(), turns=(3.0, -2.5))),
    "fitted": fitted,
    "crossed": crossed,
    "walled": walled,
    "marched": marched,
}


def results() -> dict[str, Figures]:
    return {name: case() for name, case in CASES.items()}


if __name__ == "__main__":
    warnings.simplefilter("error")
    json.dump(results(), sys.stdout)
