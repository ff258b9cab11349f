"""Filaments of known shape for programs: lines of the parameters, to and fro, with hoops at the rims."""

from pathlib import Path

import numpy as np
from layup_shapes import cylinder, helices

from meshwind.core.cast import Floats
from meshwind.filament.course import Course, Kind, in_a_row, joined
from meshwind.filament.filament import Filament
from meshwind.layup.layup import assess
from meshwind.mesh.geometry.mesh import Mesh
from meshwind.program.work import Work
from meshwind.results.filament_file import write_filaments
from meshwind.results.report import RunFacts, report, write_report
from meshwind.results.write import surface_maps, write_files
from meshwind.surface import Surface
from meshwind.surface.grid import grid


def along(surface: Surface, start: tuple[float, float], end: tuple[float, float], count: int, kind: Kind) -> Course:
    """The line between two places of the parameters."""
    uv = np.linspace(start, end, count)
    none = np.zeros(count, dtype=np.int64)
    normal = surface.normals(uv)
    return Course(
        surface.points(uv), normal, np.zeros(count), np.zeros(count), none + int(kind), none, none, none - 1,
    )  # fmt: skip


def numbered(course: Course, circuit: int, passed: int) -> Course:
    """The course with its circuit and its pass."""
    none = np.zeros(len(course), dtype=np.int64)
    path = np.where(course.kind == Kind.LAID, passed, -1)
    return Course(
        course.points, course.normal, course.angle, course.slip, course.kind, none + circuit, none + passed, path
    )  # fmt: skip


def filament(surface: Surface, circuits: int, turns: float, dwell: float, count: int = 101) -> Filament:
    """Circuits of a pass of `turns`, a hoop of `dwell` turns, and the same back."""
    courses, u = [], 0.0
    for circuit in range(circuits):
        for back in (0, 1):
            v0, v1 = (1.0, 0.0) if back else (0.0, 1.0)
            passed = 2 * circuit + back
            courses.append(numbered(along(surface, (u, v0), (u + turns, v1), count, Kind.LAID), circuit, passed))
            u += turns
            hoop = along(surface, (u, v1), (u + dwell, v1), max(int(120 * dwell), 2), Kind.DWELL)
            courses.append(numbered(hoop, circuit, passed))
            u += dwell
    course = joined(courses)
    return Filament(course, np.zeros(len(course), dtype=np.int64), np.zeros(len(course)))


def work(surface: Surface, circuits: int = 2, turns: float = 0.8, dwell: float = 0.3, count: int = 101) -> Work:
    """What is to be wound, in mm."""
    diagonal = float(np.linalg.norm(np.ptp(surface.points(grid_of()), axis=0)))
    return Work((filament(surface, circuits, turns, dwell, count),), surface, diagonal, "mm", "part")


def grid_of() -> Floats:
    """Some places of the parameters all over a surface."""
    return np.stack(np.meshgrid(np.linspace(0, 1, 33), np.linspace(0, 1, 17)), axis=2).reshape(-1, 2)


def chord(points: Floats, kind: Kind, normal: Floats) -> Course:
    """A course of single points with one normal."""
    none = np.zeros(len(points), dtype=np.int64)
    return Course(
        points, np.broadcast_to(normal, points.shape), np.zeros(len(points)), np.zeros(len(points)),
        none + int(kind), none, none, none,
    )  # fmt: skip


def pieces(*courses: Course) -> Filament:
    """A filament of courses one after another."""
    course = in_a_row(courses)
    return Filament(course, np.zeros(len(course), dtype=np.int64), np.zeros(len(course)))


def write_run(out: Path, circuits: int) -> Path:
    """Write a run's folder with a filament of so many circuits."""
    layup = assess(helices(4, 0.6, 61, cylinder()))
    surface = layup.paths.surface
    on = grid(surface)
    mesh = Mesh(on.points, np.concatenate([on.quads[:, [0, 1, 2]], on.quads[:, [0, 2, 3]]]))
    write_files(out, layup, surface_maps(layup, mesh))
    write_filaments(out / "filament.vtp", [filament(surface, circuits, 0.6, 0.2)])
    write_report(out / "report.json", report(layup, mesh, None, RunFacts(0.6)))
    return out
