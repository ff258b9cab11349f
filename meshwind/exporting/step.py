"""surface.step: the fitted surface as one B-spline face and the fibres as curves, for CAD."""

import os
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np

from meshwind.core.cast import Floats
from meshwind.core.errors import BadInputError
from meshwind.core.opencascade import knots_array, need, occ, points_array, quiet
from meshwind.core.units import millimetres
from meshwind.core.version import version
from meshwind.exporting.splines import clamped_surface, curve_through
from meshwind.results import schema
from meshwind.results.reading import Results
from meshwind.surface.evaluate import DEGREE
from meshwind.surface.surface import Surface

EPOCH = "SOURCE_DATE_EPOCH"
"""Variable of the environment with the seconds since 1970 that stand for now, as in reproducible builds."""


def write_step(folder: Path, results: Results) -> list[str]:
    """Write surface.step into an existing folder, in mm; return what the user should know.

    The surface is the fitted spline, not facets; a fibre is the cubic spline through its particles, named by its path
    and family.  Paths that did not converge are left out.  Raises BadInputError without OpenCASCADE.
    """
    need()
    scale = millimetres(results.units)
    shapes = [(results.name, face(results.surface, scale))]
    for path in np.flatnonzero(results.at_rest):
        name = f"path {path} family {results.paths.family[path]:+d}"
        shapes.append((name, edge(results.paths.points[path], scale)))
    _write(folder / schema.STEP, shapes, results.name)
    left = int((~results.at_rest).sum())
    notes = [f"{schema.STEP}: left out as not at rest: {left} of {len(results.paths)} paths"] if left else []
    if not results.units:
        notes.append(f"{schema.STEP}: the run names no unit, so its lengths are taken as mm")
    return notes


def write_step_of(path: Path, surface: Surface, units: str, name: str) -> None:
    """Write one surface as a face of this name, in mm; raises BadInputError without OpenCASCADE."""
    need()
    _write(path, [(name, face(surface, millimetres(units)))], name)


def day() -> str:
    """The present day, without a time, so that the same run gives the same bytes on a day, as a date of STEP."""
    given = os.environ.get(EPOCH, "")
    now = datetime.fromtimestamp(int(given), UTC) if given.isdecimal() else datetime.now(UTC)
    return f"{now:%Y-%m-%d}T00:00:00"


def face(surface: Surface, scale: float = 1.0) -> Any:
    """The surface as a face of OpenCASCADE."""
    poles, knots_u, knots_v = clamped_surface(surface)
    (u, times_u), (v, times_v) = knots_array(knots_u), knots_array(knots_v)
    geometry = occ("Geom").Geom_BSplineSurface(points_array(scale * poles), u, v, times_u, times_v, DEGREE, DEGREE)
    made = occ("BRepBuilderAPI").BRepBuilderAPI_MakeFace(geometry, 1e-7)
    if not made.IsDone():
        raise BadInputError(f"OpenCASCADE makes no face of the surface ({made.Error()}); fit it to a smoother mesh")
    return made.Face()


def edge(points: Floats, scale: float = 1.0) -> Any:
    """A fibre through points (n, 3) as an edge of OpenCASCADE."""
    curve = curve_through(points)
    knots, times = knots_array(scale * curve.knots)
    geometry = occ("Geom").Geom_BSplineCurve(points_array(scale * curve.poles), knots, times, DEGREE)
    return occ("BRepBuilderAPI").BRepBuilderAPI_MakeEdge(geometry).Edge()


def _write(path: Path, shapes: list[tuple[str, Any]], product: str) -> None:
    """Write shapes by their names; product: what the file is of, for its header."""
    strings, control = occ("TCollection"), occ("STEPCAFControl")
    document = occ("TDocStd").TDocStd_Document(strings.TCollection_ExtendedString("meshwind"))
    tool = occ("XCAFDoc").XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    for name, shape in shapes:
        label = tool.AddShape(shape, False)
        occ("TDataStd").TDataStd_Name.Set_s(label, strings.TCollection_ExtendedString(name))
    with quiet():
        writer = control.STEPCAFControl_Writer()
        done = writer.Transfer(document, occ("STEPControl").STEPControl_StepModelType.STEPControl_AsIs)
        header = occ("APIHeaderSection").APIHeaderSection_MakeHeader(writer.ChangeWriter().Model())
        text, program = strings.TCollection_HAsciiString, f"meshwind {version()}"
        header.SetTimeStamp(text(day()))
        header.SetName(text(product))
        header.SetPreprocessorVersion(text(program))
        header.SetOriginatingSystem(text(program))
        for none in (header.SetAuthorValue, header.SetOrganizationValue):
            none(1, text(""))
        header.SetAuthorisation(text(""))
        header.SetDescriptionValue(1, text(f"winding of {product}"))
        status = writer.Write(str(path)) if done else None
    if status != occ("IFSelect").IFSelect_ReturnStatus.IFSelect_RetDone:
        raise OSError(f"OpenCASCADE could not write {path.name}")
