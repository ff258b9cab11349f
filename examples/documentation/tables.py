"""Tables of README and the site, each made from results that are kept."""

from collections.abc import Callable

from documentation.kept import Kept
from documentation.words import figure, markdown, share, size, span

ERRORS = (1e-4, 1e-6, 1e-8)
"""Errors of the length at which methods are compared."""
METHODS = {
    "backward-euler": "backward Euler (4.16, 4.17), best time step and damping",
    "backward-euler-reuse": "the same, matrix reused",
    "backward-euler-ruled": "the same, its lengths computed by our rule instead of its polyline's",
    "explicit-euler": "explicit Euler",
    "symplectic-euler": "symplectic Euler",
    "rk4": "Runge-Kutta 4",
    "kkt": "KKT (7.2 to 7.9)",
    "penalty": "penalty force (7.1)",
    "flipout": "FlipOut on a mesh",
    "mmp-pygeodesic": "exact polyhedral geodesics (pygeodesic)",
    "mmp-libigl": "exact polyhedral geodesics (libigl)",
    "shooting-dop853": "shooting with SciPy's DOP853",
    "shooting-trace": "shooting with `mw.trace`",
    "collocation": "collocation, SciPy's `solve_bvp`",
}
SHORT = METHODS | {
    "backward-euler": "backward Euler",
    "backward-euler-reuse": "backward Euler, matrix reused",
    "backward-euler-ruled": "backward Euler with our rule for lengths",
}
"""Their names where they stand alone."""
FLYING = ("hyperboloid", "elbow")
"""Problems whose fibre is in the air from end to end, on which any three particles are exact."""
PARTS = ("barrel", "vase", "hyperboloid")
RUNS = (
    ("faces", 10_000, 200, 401),
    ("faces", 1_000_000, 200, 401),
    ("faces", 2_000_000, 200, 401),
    ("paths", 10_000, 10_000, 401),
    ("particles", 10_000, 40, 5_001),
)
"""What is shown of the growth of a run: what grew, faces, paths and particles."""
NEAR = 0.1
"""Relative difference of the faces of a mesh from those that it was to have."""
VIEWED = {
    "200 fibres": "`tank.ply`, 200 fibres",
    "cast": "`cast.ply`",
    "filament": "`vase.stl`, a filament with its band",
    "program": "its program",
    "layers": "`tank.ply`, five layers of band",
}
"""Words for the pages of the viewer that are measured."""
WAITS = {
    "meshwind": "meshwind: from the mesh to files and pictures",
    "before": "meshwind {}, the release before",
    "flipout": "FlipOut (potpourri3d): as many geodesics, no files",
    "pygeodesic": "exact polyhedral geodesics (pygeodesic), no files",
    "pyvista": "PyVista: the mesh read, and one picture of it",
}


def other_methods(kept: Kept) -> str:
    """Time of other methods over ours at equal error."""
    rows = [["method", *(f"error {figure(error)}" for error in ERRORS)]]
    for method, name in METHODS.items():
        cells = []
        for error in ERRORS:
            row = kept.row("ratios_at_equal_error", method=method, error=error)
            if not int(row["problems"]):
                cells.append("not reached")
                continue
            between = span([row("least"), row("most")])
            cells.append(f"{figure(row('middle'))} ({between}; {row['problems']})")
        rows.append([name, *cells])
    return markdown(rows)


def beaten(kept: Kept) -> str:
    """Problems on which another method is better than ours at equal error."""
    best: dict[tuple[str, str, str], float] = {}
    for row in kept.rows("beaten"):
        if row["problem"].startswith(FLYING):
            continue
        key = row["problem"], row["by"], row["cost"]
        best[key] = max(best.get(key, 0.0), row("factor"))
    rows = [["problem", "method", "quicker by up to", "evaluations fewer by up to"]]
    for problem, by in dict.fromkeys(key[:2] for key in best):
        both = [best.get((problem, by, cost)) for cost in ("seconds", "evaluations")]
        rows.append([problem, SHORT[by], *("-" if each is None else f"{figure(each)} times" for each in both)])
    return markdown(rows)


def decimated(kept: Kept) -> str:
    """Fits to decimated meshes."""
    rows = [["decimated, faces kept", "facets off by", "surface off by", "stated", "places within it"]]
    for part in PARTS:
        some = kept.rows("fit_truth", mesh="decimated", part=part)
        shares = ", ".join(share(row("much")) for row in some)
        off = [", ".join(figure(row(what)) for row in some) for what in ("facets", "surface", "stated")]
        rows.append([f"{part}, {shares} %", *off, ", ".join(share(row("within")) for row in some) + " %"])
    return markdown(rows)


def noisy(kept: Kept) -> str:
    """Fits to noisy meshes."""
    rows = [["noise, in mean edges", "found, over the noise", "surface off by, over it", "stated", "places within it"]]
    for part in PARTS:
        some = kept.rows("fit_truth", mesh="noisy", part=part)
        much = ", ".join(row["much"] for row in some)
        off = [", ".join(f"{row(what):.2f}" for row in some) for what in ("noise", "surface", "stated")]
        rows.append([f"{part}, {much}", *off, ", ".join(share(row("within")) for row in some) + " %"])
    return markdown(rows)


def fit_cost(kept: Kept) -> str:
    """Cost from file to surface by size."""
    rows = [["faces", "one LU", "read", "open", "flatten", "fit", "total", "peak memory"]]
    for row in kept.rows("fit_cost"):
        stages = [figure(row(stage) / row("lu")) for stage in ("read", "open", "flatten", "fit")]
        total = f"{figure(row('total over lu'))} ({figure(row('total'))} s)"
        rows.append([size(row("asked")), f"{figure(row('lu'))} s", *stages, total, f"{figure(row('memory') / 1e9)} GB"])
    return markdown(rows)


def whole_runs(kept: Kept) -> str:
    """Time and memory of whole runs."""
    rows = [["faces", "paths", "particles", "time", "peak memory"]]
    for swept, faces, paths, particles in RUNS:
        found = kept.rows("scaling", swept=swept, paths=paths, particles=particles)
        (row,) = (each for each in found if abs(each("faces") / faces - 1.0) < NEAR)
        cost = f"{figure(row('seconds'))} s", f"{figure(row('memory') / 1e9)} GB"
        rows.append([size(faces), f"{paths:,}", f"{particles:,}", *cost])
    return markdown(rows)


def first_run(kept: Kept) -> str:
    """First and second runs beside peers."""
    jobs = ("first run", "second run", "without pictures")
    rows = [["", "first run", "second run", "without pictures"]]
    names = {row["who"]: row["version"] for row in kept.rows("first_run_versions")}
    for who, words in WAITS.items():
        cells = []
        for job in jobs:
            found = kept.rows("first_run_medians", job=job, who=who)
            cells.append(f"{figure(found[0]('seconds'))} s" if found else "")
        if any(cells):
            rows.append([words.format(names.get(who, "")), *cells])
    return markdown(rows)


def redesigns(kept: Kept) -> str:
    """Redesigns of the parts of data/."""
    rows = [["part", "revolutions", "rounds", "bridged before", "largest gap before", "after", "largest displacement",
             "volume"]]  # fmt: skip
    for row in kept.rows("redesigns"):
        gaps = [", ".join(figure(float(gap), 3) for gap in row[f"gaps {when}"].split()) for when in ("before", "after")]
        bridged, volume = f"{figure(100.0 * row('bridged before'))} %", f"{100.0 * row('volume'):+.2g} %"
        turns = row["revolutions"].replace(" ", ",")
        rows.append([f"`{row['part']}`", turns, row["rounds"], bridged, *gaps, figure(row("displacement"), 3), volume])
    return markdown(rows)


def viewer(kept: Kept) -> str:
    """Size of the viewer's pages, time until they are there, and how fast parts turn."""
    rows = [["page", "fibres", "triangles", "size", "first picture", "frames a second"]]
    for row in kept.rows("viewer_speed"):
        triangles = row("triangles") + row("band triangles")
        rows.append([VIEWED[row["page"]], row["fibres"], size(triangles), f"{figure(row('bytes') / 1e6)} MB",
                     f"{figure(row('first picture'))} s", figure(row("frames a second"))])  # fmt: skip
    return markdown(rows)


TABLES: dict[str, Callable[[Kept], str]] = {
    "redesigns": redesigns,
    "decimated": decimated,
    "noisy": noisy,
    "other_methods": other_methods,
    "beaten": beaten,
    "fit_cost": fit_cost,
    "whole_runs": whole_runs,
    "first_run": first_run,
    "viewer": viewer,
}
"""All tables by the name in their mark."""
NEEDED = (
    "redesigns", "ratios_at_equal_error", "ratios", "beaten", "source_setting", "velocity_scaling", "outcomes",
    "explicit_limits", "rough_ribs", "rough_mesh_to_surface", "rough_meshes", "rough_folds", "rough_rest_states",
    "rough_bumps", "rough_layers", "turnarounds", "rewound_tube", "rewound_parts", "fit_truth", "fit_cost",
    "fit_order", "fit_facets", "against_flipout", "first_run_medians", "first_run_versions", "scaling",
    "scaling_growth", "viewer_speed",
)  # fmt: skip
"""Results that the documentation rests on, by the names of their files."""
