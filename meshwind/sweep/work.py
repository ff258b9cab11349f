"""What a worker does: fit a part, wind one case of it.  Nothing here knows where it runs."""

from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numba
from threadpoolctl import threadpool_limits

from meshwind.core.errors import BadInputError
from meshwind.mesh import Mesh
from meshwind.mesh.io.scalars import Scalars
from meshwind.options import Options
from meshwind.pipeline import Clock, Part, Result, fit_part, wind_part
from meshwind.sweep.study import Case


@dataclass(frozen=True)
class Done:
    """What came of a case: the figures for its row, the files of its folder by name, and why there are none.

    Where reason is not "", the case was refused, or lost with its worker, and has neither figures nor files.
    """

    figures: dict[str, Any]
    files: dict[str, bytes]
    reason: str = ""
    lost: bool = False


def alone() -> None:
    """Keep this process to one thread: as many processes run as there are cores."""
    numba.set_num_threads(1)
    threadpool_limits(1)


def fitted(mesh: Mesh, field: Scalars | None, options: Options) -> Part | str:
    """The part that all cases with these options share, or why there is none."""
    alone()
    try:
        return fit_part(mesh, options, Clock(None), field)
    except BadInputError as error:
        return str(error)


def wound(part: Part | str, case: Case) -> Done:
    """Wind one case on its part."""
    if isinstance(part, str):
        return Done({}, {}, part)
    alone()
    try:
        result = wind_part(part, case.options, "", Clock(None))
        with TemporaryDirectory() as place:
            out = Path(place) / "case"
            result.write(out, render=case.render)
            files = {path.relative_to(out).as_posix(): path.read_bytes() for path in out.rglob("*") if path.is_file()}
    except BadInputError as error:
        return Done({}, {}, str(error))
    return Done(_figures(result), files)


def _figures(result: Result) -> dict[str, Any]:
    """The figures of a row: the same whatever the machine, so none of time."""
    report = result.report()
    paths, crossings, cover = report["paths"], report["crossings"], report["coverage"]
    failed = paths["not_converged"]
    return {
        "revolutions_wound": report["winding"]["revolutions"],
        "paths": paths["converged"] + len(failed),
        "at_rest": paths["converged"],
        "why_not": failed[0]["why"] if failed else "",
        "length": paths["length_total"],
        "bridged_share": paths["bridged_fraction"],
        "bridges": paths["bridges"],
        "longest_bridge": paths["longest_bridge"],
        "max_gap": paths["max_gap"],
        "max_slip": paths["max_slip"],
        "crossings": crossings["count"],
        "angle_min": crossings["angle"]["min"],
        "angle_median": crossings["angle"]["median"],
        "angle_max": crossings["angle"]["max"],
        "band": cover["band_width"],
        "bare_share": cover["bare"],
        "once_share": cover["once"],
        "twice_share": cover["twice"],
        "more_share": cover["more"],
        "neighbours_max": report["spacing"]["neighbours"]["max"],
        "quads": report["quads"]["quads"],
        "triangles": report["quads"]["triangles"],
        "mass": report["fibre"]["mass"],
        "fit_error": report["surface"]["fit_error"]["relative_max"],
        "evaluations": report["model"]["surface_evaluations"],
    }
