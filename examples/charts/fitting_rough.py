"""From rough meshes to surfaces: the true error of a fit beside that of the mesh's own facets, and what it states."""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import matplotlib.pyplot as plt
import numpy as np
from comparison.parts import PARTS, Revolved, decimated, irregular
from comparison.truth import measure as measured
from matplotlib.lines import Line2D

from charts.record import Results
from charts.style import BLUE, GREEN, GREY, RED, log_axes, save
from meshwind.core.cast import Floats, Ints

Mesh = tuple[Floats, Ints]
FACES = 8000
"""Of a mesh before it is made rough, ..."""
FINE = 32_000
"""... and before it is decimated or scanned."""
SMEARED, ROUNDS = 0.5, 2
"""How far a vertex's noise in a scan goes towards its neighbours' mean, so often: a scanner's error has a width."""
STRAY, FAR = 0.003, 5.0
"""Share of the vertices of a scan that are off by so many times more."""
KEPT = 0.25
"""Share of the faces of a scan that is left, as scans come decimated."""


def edge(mesh: Mesh) -> float:
    """Mean length of an edge."""
    vertices, faces = mesh
    return float(np.linalg.norm(vertices[faces] - np.roll(vertices[faces], 1, axis=1), axis=2).mean())


def noisy(part: Revolved, much: float) -> Mesh:
    """Gaussian noise in mean edges."""
    vertices, faces = mesh = irregular(part, FACES)
    return vertices + much * edge(mesh) * np.random.default_rng(2).normal(size=vertices.shape), faces


def scanned(part: Revolved, much: float) -> Mesh:
    """Noise in mean edges that neighbours share, with strays, on a fine mesh that is then decimated."""
    vertices, faces = mesh = irregular(part, FINE)
    random = np.random.default_rng(4)
    noise = random.normal(size=vertices.shape)
    noise[random.random(len(vertices)) < STRAY] *= FAR
    for _ in range(ROUNDS):
        total, count = np.zeros_like(noise), np.zeros(len(noise))
        for k in range(3):
            np.add.at(total, faces[:, k], noise[faces[:, k - 1]])
            np.add.at(count, faces[:, k], 1.0)
        noise += SMEARED * (total / count[:, None] - noise)
    return decimated(vertices + much * edge(mesh) * noise, faces, KEPT)


def creased(z: Floats) -> Floats:
    """Radius of a cylinder between two cones: two edges that no smooth surface follows."""
    return np.asarray(np.minimum(np.minimum(0.5 + 0.6 * z, 1.0), 0.5 + 0.6 * (3.0 - z)))


class Kind(NamedTuple):
    """A kind of rough mesh: how it is made from a part and a number, what this is, and the numbers that are shown."""

    make: Callable[[Revolved, float], Mesh]
    axis: str
    much: Sequence[float]
    parts: dict[str, Revolved]


KINDS = {
    "decimated": Kind(
        lambda part, much: decimated(*irregular(part, FINE), much),
        f"share kept of {FINE:,} faces",
        (0.5, 0.25, 0.1, 0.05, 0.03),
        PARTS,
    ),
    "noisy": Kind(noisy, f"noise in mean edges, {FACES:,} faces", (0.01, 0.03, 0.1, 0.3), PARTS),
    "creased": Kind(
        lambda part, much: irregular(part, int(much)),
        "faces",
        (1000, 4000, 16_000, 64_000),
        {"cylinder between cones": Revolved(creased, 3.0)},
    ),
    "scanned": Kind(
        scanned,
        f"noise in mean edges, shared by neighbours, with strays; {KEPT:.0%} kept of {FINE:,} faces",
        (0.01, 0.03, 0.1, 0.3),
        PARTS,
    ),
}
PLAIN = ("decimated", "creased")
"""Kinds whose axis has the numbers themselves."""
COLOURS = (BLUE, GREEN, RED)
"""Of the parts of a kind."""
LINES = {
    "surface": ("o", "-", 1.6, "the surface"),
    "facets": ("s", ":", 1.2, "the mesh's own facets"),
    "stated": ("", "--", 1.0, "what the surface states"),
}
"""Marker, line, its width and words of each figure."""


def measure(quick: bool) -> list[dict[str, Any]]:
    """Fit meshes of every kind."""
    rows = []
    for name, kind in KINDS.items():
        for word, part in list(kind.parts.items())[: 1 if quick else None]:
            for much in kind.much[1:3] if quick else kind.much:
                found = measured(part, *kind.make(part, much))
                about = {"kind": name, "part": word, "much": much, "led by": found.led_by}
                rows.append(about | found.over(found.surface.size) | {"within": found.within})
    return rows


def draw(results: Results, rows: list[dict[str, Any]]) -> None:
    """A panel for each kind."""
    figure, grid = plt.subplots(2, 2, figsize=(12, 9.5))
    for (name, kind), axes in zip(KINDS.items(), grid.flat, strict=True):
        mine = [row for row in rows if row["kind"] == name]
        for part, colour in zip(kind.parts, COLOURS, strict=False):
            some = [row for row in mine if row["part"] == part]
            for key, (marker, line, width, _) in LINES.items():
                much, error = ([row[of] for row in some] for of in ("much", key))
                axes.plot(much, error, marker=marker, ls=line, color=colour, lw=width, ms=5)
        log_axes(axes, kind.axis, "rms distance to the true part / diagonal")
        if name in PLAIN:
            axes.set_xticks(kind.much, [f"{much:,g}" for much in kind.much])
            axes.minorticks_off()
        least = min(row["within"] for row in mine)
        axes.set_title(f"{name}: at least {100 * least:.0f} % of the places within what is stated")
        if list(kind.parts) != list(PARTS):
            axes.set_xlabel(f"{kind.axis} of a {', '.join(kind.parts)}")
    figure.suptitle("Rough meshes to surfaces: error of the surface against the exact part, beside that of the facets")
    handles = [Line2D([], [], color=colour, lw=3, label=part) for part, colour in zip(PARTS, COLOURS, strict=True)]
    handles += [
        Line2D([], [], color=GREY, marker=marker, ls=line, lw=width, label=words)
        for marker, line, width, words in LINES.values()
    ]
    figure.tight_layout(rect=(0, 0.04, 1, 1))
    figure.legend(handles=handles, loc="lower center", ncol=6)
    save(figure, results.folder, "rough_mesh_to_surface")
