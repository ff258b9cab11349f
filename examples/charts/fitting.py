"""From mesh to surface: the true error of a fit against its control points and against seconds."""

from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from comparison.parts import PARTS, irregular
from matplotlib.lines import Line2D

import meshwind as mw
from charts.record import Results
from charts.style import BLUE, GREEN, GREY, RED, log_axes, save
from charts.timing import timed
from meshwind.mesh import mesh_from

VERTICES = (1000, 4000, 16_000, 64_000)
TOLERANCES = (1e-3, 1e-4, 1e-5, 1e-6, 1e-12)


def facets_error(part: str, vertices: np.ndarray[Any, Any], faces: np.ndarray[Any, Any], size: float) -> float:
    """Rms radial distance of the facets' middles to the part, over its diagonal: where polyhedral methods start."""
    middle = vertices[faces].mean(axis=1)
    off = np.hypot(middle[:, 0], middle[:, 1]) - PARTS[part].radius(middle[:, 2])
    return float(np.sqrt(np.mean(off**2))) / size


def measure(quick: bool) -> list[dict[str, Any]]:
    """Fit meshes of the vase, the barrel and the hyperboloid to a ladder of tolerances."""
    rows = []
    mw.fit(mw.flatten(mw.annulus(mesh_from(*irregular(PARTS["barrel"], 2000)))))  # compile
    for part in PARTS:
        for count in VERTICES[: 2 if quick else None]:
            vertices, faces = irregular(PARTS[part], 2 * count)
            opened, annulus = timed(lambda v=vertices, f=faces: mw.annulus(mesh_from(v, f)))  # type: ignore[misc]
            flattened, chart = timed(lambda a=annulus: mw.flatten(a))  # type: ignore[misc]
            for tolerance in TOLERANCES:
                seconds, surface = timed(lambda c=chart, t=tolerance: mw.fit(c, t))  # type: ignore[misc]
                nu, nv = surface.control_points.shape[:2]
                rows.append(
                    dict(
                        part=part,
                        vertices=len(vertices),
                        tolerance=tolerance,
                        control_points=nu * nv,
                        nu=nu,
                        nv=nv,
                        open_seconds=opened,
                        flatten_seconds=flattened,
                        fit_seconds=seconds,
                        seconds=opened + flattened + seconds,
                        error=PARTS[part].error(surface),
                        facets_error=facets_error(part, vertices, faces, surface.size),
                    )
                )
    return rows


def draw(results: Results, rows: list[dict[str, Any]]) -> None:
    """Two panels a part: against control points and against seconds from the mesh in memory."""
    parts = list(PARTS)
    figure, grid = plt.subplots(2, len(parts), figsize=(5 * len(parts), 7.6), sharey="row")
    colours = dict(
        zip(
            sorted({row["vertices"] for row in rows if row["part"] == parts[0]}), (GREY, BLUE, GREEN, RED), strict=False
        )
    )
    for j, part in enumerate(parts):
        for (key, word), axes in zip(
            (("control_points", "control points"), ("seconds", "open + flatten + fit [s]")), grid[:, j], strict=True
        ):
            mine = [row for row in rows if row["part"] == part]
            for vertices, colour in zip(sorted({row["vertices"] for row in mine}), colours.values(), strict=False):
                some = sorted((row for row in mine if row["vertices"] == vertices), key=lambda row: row[key])
                axes.plot(
                    [r[key] for r in some],
                    [r["error"] for r in some],
                    "o-",
                    color=colour,
                    ms=5,
                )
                axes.axhline(some[0]["facets_error"], color=colour, ls=":", lw=1)
            log_axes(axes, word, "rms distance to the true part / diagonal")
            axes.set_title(f"{part}, irregular mesh; dotted: the mesh's own facets")
    figure.suptitle(
        f"Mesh to surface: each dot a tolerance of {', '.join(f'{t:g}' for t in TOLERANCES)}; the error is measured"
        " against the exact part"
    )
    words = [f"mesh of about {count:,} vertices" for count in VERTICES]
    handles = [
        Line2D([], [], color=colour, marker="o", label=word)
        for word, colour in zip(words, colours.values(), strict=False)
    ]
    figure.tight_layout(rect=(0, 0.05, 1, 1))
    figure.legend(handles=handles, loc="lower center", ncol=len(handles))
    save(figure, results.folder, "mesh_to_surface")
