"""A run of another library as a user would write it: read a mesh, and find paths from end to end, or draw it.

    python examples/comparison/peer_run.py flipout data/vase.stl 12

As many paths as in two families of the number given; each from the mesh's lowest to its highest vertices.
"""

import sys
from pathlib import Path
from tempfile import TemporaryDirectory


def geodesics(name: str, file: str, paths: int) -> None:
    """Polyhedral geodesics between vertices of the two ends."""
    import numpy as np
    import trimesh

    mesh = trimesh.load_mesh(file)
    vertices, faces = np.asarray(mesh.vertices), np.asarray(mesh.faces)
    order = np.argsort(vertices[:, 2])
    pairs = list(zip(order[: 2 * paths].tolist(), order[::-1][: 2 * paths].tolist(), strict=True))
    if name == "flipout":
        import potpourri3d

        flips = potpourri3d.EdgeFlipGeodesicSolver(vertices, faces)
        lengths = [len(flips.find_geodesic_path(a, b)) for a, b in pairs]
    else:
        from pygeodesic.geodesic import PyGeodesicAlgorithmExact

        exact = PyGeodesicAlgorithmExact(vertices, faces)
        lengths = [exact.geodesicDistance(a, b)[0] for a, b in pairs]
    if min(lengths) <= 0:
        raise SystemExit("a path was not found")


def picture(file: str) -> None:
    """One picture of the mesh, as large as those of a run."""
    import pyvista as pv

    plotter = pv.Plotter(off_screen=True, window_size=(1600, 1200))
    plotter.add_mesh(pv.read(file), smooth_shading=True)
    with TemporaryDirectory() as folder:
        plotter.screenshot(str(Path(folder) / "part.png"))


def main() -> None:
    """Run one."""
    name, file, paths = sys.argv[1:]
    if name == "pyvista":
        picture(file)
    else:
        geodesics(name, file, int(paths))


if __name__ == "__main__":
    main()
