"""The jobs of a study: read a mesh, fit it, wind a case on the part.  Nothing here depends on where they run."""

from dataclasses import dataclass, field, replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numba
from threadpoolctl import threadpool_limits

from meshwind.core.errors import BadInputError
from meshwind.run.result import Result
from meshwind.studies.study import Case, CaseStatus, Row
from meshwind.workflow.clock import Clock
from meshwind.workflow.options import Options
from meshwind.workflow.part import Part, Source, fit_part, read_source
from meshwind.workflow.winding import wind_part


@dataclass(frozen=True)
class CaseGroup:
    """Cases that share a part, by their numbers in the study."""

    cases: dict[int, Case]

    @property
    def options(self) -> Options:
        """Those of its first case: the options that the part depends on are the same for all."""
        return next(iter(self.cases.values())).options

    def read(self) -> Source | str:
        """The mesh that the part is fitted to, or why it cannot be read."""
        case = next(iter(self.cases.values()))
        try:
            # without its path, so that the files of a case do not depend on where the mesh is kept
            return replace(read_source(case.mesh, case.options), file=None)
        except BadInputError as error:
            return str(error)


def grouped(cases: dict[int, Case]) -> list[CaseGroup]:
    """The cases by the part that they share."""
    by_part: dict[tuple[object, ...], dict[int, Case]] = {}
    for number, case in cases.items():
        by_part.setdefault(case.shared, {})[number] = case
    return [CaseGroup(group) for group in by_part.values()]


@dataclass(frozen=True)
class Done:
    """A finished case: how it ended, the figures for its row, and the files of its folder by name.

    reason: why it was refused or lost, or why its first path that did not converge did not; "" otherwise.
    """

    status: CaseStatus
    reason: str = ""
    figures: Row = field(default_factory=dict)
    files: dict[str, bytes] = field(default_factory=dict)


def fit_job(source: Source, options: Options) -> Part | str:
    """In a worker: the part that all cases with these options share, or why it cannot be fitted."""
    _use_one_thread()
    try:
        return fit_part(source, options, Clock())
    except BadInputError as error:
        return str(error)


def wind_job(part: Part | str, case: Case) -> Done:
    """In a worker: wind one case on its part."""
    if isinstance(part, str):
        return Done(CaseStatus.REFUSED, part)
    _use_one_thread()
    try:
        result = Result.of(wind_part(part, case.options, "", Clock()))
        with TemporaryDirectory() as folder:
            out = Path(folder) / "case"
            result.write(out, render=case.render)
            files = {path.relative_to(out).as_posix(): path.read_bytes() for path in out.rglob("*") if path.is_file()}
    except BadInputError as error:
        return Done(CaseStatus.REFUSED, str(error))
    failed = result.report()["paths"]["not_converged"]
    if failed:
        return Done(CaseStatus.NOT_ALL_AT_REST, failed[0]["why"], _figures(result), files)
    return Done(CaseStatus.AT_REST, "", _figures(result), files)


def _use_one_thread() -> None:
    """Keep this process to one thread: as many processes run as there are cores."""
    numba.set_num_threads(1)
    threadpool_limits(1)


def _figures(result: Result) -> Row:
    """The figures of a row: the same on every machine, so none of time."""
    report = result.report()
    paths, crossings, cover = report["paths"], report["crossings"], report["coverage"]
    return {
        "revolutions_wound": report["winding"]["revolutions"],
        "paths": paths["converged"] + len(paths["not_converged"]),
        "at_rest": paths["converged"],
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
        "mass": report["fibre"]["fibre_mass"],
        "fit_error": report["surface"]["fit_error"]["relative_max"],
        "evaluations": report["model"]["surface_evaluations"],
    }
