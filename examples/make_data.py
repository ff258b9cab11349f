"""Writes the sample parts in `data/`: smooth shapes, irregular meshes."""

import argparse
from pathlib import Path

import trimesh
from sample_parts import shapes
from sample_parts.mesher import Part, triangulate

PARTS = (
    Part("vase.stl", shapes.vase, closed=False, vertices=4300),
    Part("tank.ply", shapes.tank, closed=True, vertices=5000),
    Part("elbow.obj", shapes.elbow, closed=False, vertices=4000),
    Part("bottle.obj", shapes.bottle, closed=True, vertices=5200, sharpness=12),
    Part("cast.ply", shapes.cast, closed=False, vertices=4500, sharpness=15),
    Part("wing.stl", shapes.wing, closed=True, vertices=6200, grid=(450, 1000), sharpness=7),
)


def write(part: Part, seed: int, folder: Path) -> str:
    """Mesh the part and write it in the format of its file name; return a line with its size."""
    vertices, faces = triangulate(part, seed)
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    how = {"digits": 9, "header": None, "include_normals": False} if part.file.endswith(".obj") else {}
    mesh.export(folder / part.file, **how)
    size = (folder / part.file).stat().st_size
    return f"{part.file}: {len(vertices)} vertices, {len(faces)} triangles, {size / 1e3:.0f} kB"


def main() -> None:
    """Write every part into the folder that --out names."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=Path(__file__).parent.parent / "data")
    folder = parser.parse_args().out
    folder.mkdir(parents=True, exist_ok=True)
    for seed, part in enumerate(PARTS):
        print(write(part, seed, folder))


if __name__ == "__main__":
    main()
