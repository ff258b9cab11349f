"""Access to OpenCASCADE, an optional part: where it is missing, the error says what to install."""

import math
from codecs import BOM_UTF8
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from meshwind.core.errors import BadInputError
from meshwind.core.units import MILLIMETRES

STEP, IGES = (".step", ".stp"), (".iges", ".igs")
"""Endings of the files of CAD that OpenCASCADE reads."""
_HEAD = 400
"""Length of the part of a STEP file that has its first words."""
MISSING = "STEP and IGES need OpenCASCADE; install it with: pip install 'meshwind[cad]'"


def is_there() -> bool:
    """Whether OpenCASCADE is installed and new enough."""
    return find_spec("OCP") is not None and find_spec("OCP.collections") is not None


def need(before: str = "") -> None:
    """Raise BadInputError, with words before it, if OpenCASCADE is not installed or too old."""
    if not is_there():
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


@dataclass(frozen=True)
class HeldShape:
    """What OpenCASCADE finds in a file: a shape in mm, None if there is none, and how many of its roots are lost.

    units: in which the file itself has its lengths, as they are spelled there; none if it does not say so.
    """

    shape: Any
    lost: int
    units: tuple[str, ...]


def read_shape(path: Path) -> HeldShape:
    """The shape in a STEP or IGES file.  Raises BadInputError if the file cannot be read."""
    is_step = path.suffix.lower() in STEP
    with quiet(), _plain(path, is_step) as plain:
        reader = occ("STEPControl").STEPControl_Reader() if is_step else occ("IGESControl").IGESControl_Reader()
        if reader.ReadFile(str(plain)) != occ("IFSelect").IFSelect_ReturnStatus.IFSelect_RetDone:
            raise _unreadable(path, is_step)
        units = _step_units(reader) if is_step else _iges_units(reader)
        wanted = reader.NbRootsForTransfer()
        lost = wanted - reader.TransferRoots()
        shape = reader.OneShape()
    return HeldShape(None if shape.IsNull() else shape, max(lost, 0), units)


@contextmanager
def _plain(path: Path, is_step: bool) -> Iterator[Path]:
    """The path of the file, or of a copy without its byte order mark, which OpenCASCADE does not take in STEP."""
    with path.open("rb") as file:
        marked = is_step and file.read(len(BOM_UTF8)) == BOM_UTF8
    if not marked:
        yield path
        return
    with TemporaryDirectory() as folder:
        copy = Path(folder, f"part{path.suffix}")
        copy.write_bytes(path.read_bytes().removeprefix(BOM_UTF8))
        yield copy


def _step_units(reader: Any) -> tuple[str, ...]:
    """Names of the units of length of all representations, each once."""
    names = [occ("collections").Sequence_TCollection_AsciiString() for _ in range(3)]
    reader.FileUnits(*names)
    return tuple(dict.fromkeys(str(name.ToCString()) for name in names[0] if name.Length()))


def _iges_units(reader: Any) -> tuple[str, ...]:
    """The unit of the global section by its length, as its name is free text."""
    length = float(reader.IGESModel().GlobalSection().UnitValue())
    named = (name for name, size in MILLIMETRES.items() if math.isclose(size, length, rel_tol=1e-6))
    return (next(named, f"a unit of {length:.6g} mm"),)


def _unreadable(path: Path, is_step: bool) -> BadInputError:
    """The refusal of a file, which says that it is cut short if its end (ISO 10303-21, clause 5) is missing."""
    content = path.read_bytes()
    if is_step and b"ISO-10303-21" in content[:_HEAD] and b"END-ISO-10303-21" not in content:
        return BadInputError(
            f"{path.name}: is cut short, as its end (END-ISO-10303-21) is missing; copy it or export it again"
        )
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
