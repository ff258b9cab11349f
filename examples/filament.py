"""A tank, a spar and a bottle wound as one filament each: the tables and pictures of the page in `filament`.

    python examples/filament.py --out examples/filament

--only tank,spar takes some of them.
"""

import argparse
import csv
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from documentation.page import put
from documentation.words import markdown
from gallery import PAGE, small
from numpy.typing import NDArray

import meshwind as mw

ROOT = Path(__file__).parents[1]
PLANS = Path(__file__).parent / "filament"
PICTURES = ("filament", "laminate")
PAGE_FILE = "README.md"
"""Page in the folder, into whose marks the tables go where it is there."""
STATIONS = (0.1, 0.3, 0.5, 0.7, 0.9)
"""Where the tables say what the laminate is."""


def main() -> None:
    """Wind, print the tables, put them into the page, and draw."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("out/filament"), help="folder for the pictures")
    parser.add_argument("--only", default="tank,spar,bottle", help="names by commas")
    given = parser.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    for name in given.only.split(","):
        with TemporaryDirectory() as folder:
            wound(name, Path(folder), given.out)


def wound(name: str, work: Path, out: Path) -> None:
    """One part: its layers as one filament, its tables and pictures."""
    mesh = {"tank": ROOT / "data" / "tank.ply", "bottle": ROOT / "data" / "bottle.obj"}.get(name) or spar(work)
    run = work / name
    result = mw.wind(mesh, layers=PLANS / f"{name}.toml", continuous=True, units="mm", out=run, render=False)
    tables = {f"{name} layers": layers(result), f"{name} stations": stations(run / "laminate.csv")}
    print(f"\n{name}", *tables.values(), sep="\n\n")
    if (out / PAGE_FILE).is_file():
        page = (out / PAGE_FILE).read_text(encoding="utf-8")
        for mark, made in tables.items():
            page = put(page, mark, made)
        (out / PAGE_FILE).write_text(page, encoding="utf-8")
    mw.render(run, only=list(PICTURES), page=PAGE)
    for picture in PICTURES:
        small(run / f"{picture}.png", out / f"{name}_{picture}.png")
        print(f"wrote {out / name}_{picture}.png", flush=True)


def layers(result: mw.Result) -> str:
    """The layers in the order of winding."""
    report = result.report()
    rows = [
        ["layer", "pattern", "angle", "cover", "thickness", "fibre", "join before it", "fibre mass", "resin mass"],
        *(
            [
                f"{number} {layer['kind']}",
                pattern["words"],
                f"{layer['angle']['min']:.1f} to {layer['angle']['max']:.1f}°",
                f"{layer['cover']['min']:.2f} to {layer['cover']['max']:.2f}",
                f"{layer['thickness']['median']:.2f} mm, at most {layer['thickness']['max']:.2f}",
                f"{pattern['fibre_length'] / 1000.0:.1f} m",
                f"{(layer['join'] or {'length': 0.0})['length'] / 1000.0:.2f} m",
                f"{pattern['fibre_mass'] or 0.0:.1f} g",
                f"{pattern['resin_mass'] or 0.0:.1f} g",
            ]
            for number, (layer, pattern) in enumerate(zip(report["laminate"], report["pattern"], strict=True), 1)
        ),
    ]
    return markdown(rows)


def stations(file: Path) -> str:
    """Angle and thickness of each layer at some stations."""
    with file.open() as lines:
        read = list(csv.DictReader(lines))
    many = 1 + max(int(row["layer"]) for row in read)
    rows = [["v", "z", *(f"layer {k + 1}" for k in range(many)), "in all"]]
    for v in STATIONS:
        cells, total, z = [], 0.0, ""
        for k in range(many):
            mine = [row for row in read if int(row["layer"]) == k]
            near = min(mine, key=lambda row: abs(float(row["v"]) - v))
            if abs(float(near["v"]) - v) > 0.02:
                cells.append("none")
                continue
            z, total = f"{float(near['z']):.0f} mm", total + float(near["thickness"])
            cells.append(f"{float(near['angle']):.1f}°, {float(near['thickness']):.2f} mm")
        rows.append([f"{v:g}", z, *cells, f"{total:.2f} mm"])
    return markdown(rows)


def spar(work: Path) -> Path:
    """Mesh of a tube of elliptic section, 160 x 60 mm, 400 mm long, with irregular vertices."""
    around, along = 120, 80
    random = np.random.default_rng(1)
    u, z = np.meshgrid(np.arange(around) / around, np.linspace(0.0, 400.0, along), indexing="ij")
    u = u + random.uniform(-0.3, 0.3, u.shape) / around
    z[:, 1:-1] += random.uniform(-0.3, 0.3, (around, along - 2)) * 400.0 / (along - 1)
    points = np.stack([80.0 * np.cos(2 * np.pi * u), 30.0 * np.sin(2 * np.pi * u), z], axis=-1).reshape(-1, 3)
    i, j = (each.ravel() for each in np.meshgrid(np.arange(around), np.arange(along - 1), indexing="ij"))
    ahead = (i + 1) % around
    corners: NDArray[np.int64] = np.stack([i * along + j, ahead * along + j, ahead * along + j + 1, i * along + j + 1])
    faces = np.concatenate([corners[[0, 1, 2]].T, corners[[0, 2, 3]].T])
    file = work / "spar.ply"
    with file.open("w", encoding="ascii") as out:
        out.write(f"ply\nformat ascii 1.0\nelement vertex {len(points)}\n")
        out.write("".join(f"property double {name}\n" for name in "xyz"))
        out.write(f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n")
        np.savetxt(out, points, fmt="%.9g")
        np.savetxt(out, np.insert(faces, 0, 3, axis=1), fmt="%d")
    return file


if __name__ == "__main__":
    main()
