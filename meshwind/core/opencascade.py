"""Access to OpenCASCADE, an optional part: where it is missing, the error says what to install."""

from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from meshwind.core.errors import BadInputError

STEP, IGES = (".step", ".stp"), (".iges", ".igs")
"""Endings of the files of CAD that OpenCASCADE reads."""
MISSING = "STEP and IGES need OpenCASCADE; install it with: pip install 'meshwind[cad]'"


def need(before: str = "") -> None:
    """Raise BadInputError, with words before it, if OpenCASCADE is not installed or too old."""
    if find_spec("OCP") is None or find_spec("OCP.collections") is None:
        raise BadInputError(before + MISSING)


def occ(module: str) -> Any:
    """A module of OpenCASCADE, such as Geom."""
    return import_module(f"OCP.{module}")


@contextmanager
def quiet() -> Iterator[None]:
    """Suppress OpenCASCADE's messages on the terminal; its results are checked instead."""
    message = occ("Message")
    messenger = message.Message.DefaultMessenger_s()
    printers = list(messenger.Printers())
    for printer in printers:
        messenger.RemovePrinter(printer)
    try:
        yield
    finally:
        for printer in printers:
            messenger.AddPrinter(printer)


def read_shape(path: Path) -> tuple[Any, int]:
    """The shape in a STEP or IGES file, None if there is none, and how many of its roots could not be read.

    Lengths are in mm.  Raises BadInputError if the file cannot be read.
    """
    suffix = path.suffix.lower()
    with quiet():
        reader = occ("STEPControl").STEPControl_Reader() if suffix in STEP else occ("IGESControl").IGESControl_Reader()
        if reader.ReadFile(str(path)) != occ("IFSelect").IFSelect_ReturnStatus.IFSelect_RetDone:
            raise _unreadable(path)
        wanted = reader.NbRootsForTransfer()
        lost = wanted - reader.TransferRoots()
        shape = reader.OneShape()
    return None if shape.IsNull() else shape, max(lost, 0)


def _unreadable(path: Path) -> BadInputError:
    return BadInputError(f"{path.name}: OpenCASCADE cannot read it; export it again from CAD")


def parts_of(shape: Any, kind: str) -> list[Any]:
    """The parts of a shape of a kind, such as FACE or EDGE, each as often as it is used."""
    topology = occ("TopoDS").TopoDS
    explorer = occ("TopExp").TopExp_Explorer(shape, getattr(occ("TopAbs").TopAbs_ShapeEnum, f"TopAbs_{kind}"))
    parts = []
    while explorer.More():
        parts.append(getattr(topology, kind.capitalize())(explorer.Current()))
        explorer.Next()
    return parts


def points_array(values: Any) -> Any:
    """An OpenCASCADE array of the points of an array (m, 3) or (m, n, 3)."""
    collections, gp = occ("collections"), occ("gp")
    if values.ndim == 2:
        line = collections.Array1_gp_Pnt(1, len(values))
        for i, point in enumerate(values.tolist(), start=1):
            line.SetValue(i, gp.gp_Pnt(*point))
        return line
    grid = collections.Array2_gp_Pnt(1, values.shape[0], 1, values.shape[1])
    for i, row in enumerate(values.tolist(), start=1):
        for j, point in enumerate(row, start=1):
            grid.SetValue(i, j, gp.gp_Pnt(*point))
    return grid


def knots_array(knots: Any) -> tuple[Any, Any]:
    """Knots and their multiplicities, as OpenCASCADE's arrays, of a knot vector with repetitions."""
    collections = occ("collections")
    first = [0, *(k for k in range(1, len(knots)) if knots[k] != knots[k - 1])]
    many = [b - a for a, b in zip(first, [*first[1:], len(knots)], strict=True)]
    values, counts = collections.Array1_double(1, len(first)), collections.Array1_int(1, len(first))
    for k, (at, count) in enumerate(zip(first, many, strict=True), start=1):
        values.SetValue(k, float(knots[at]))
        counts.SetValue(k, count)
    return values, counts
