"""`meshwind check`: what a mesh is and what `wind` would do with it; nothing is changed or written."""

from dataclasses import asdict
from typing import TYPE_CHECKING, Annotated

from meshwind.appearance.words import size
from meshwind.cli.arguments import MeshFile, Printed
from meshwind.cli.output import print_report
from meshwind.cli.signature import Pick, with_records
from meshwind.core.errors import BadInputError
from meshwind.workflow.options import Options

if TYPE_CHECKING:
    from meshwind.mesh.inspection import Findings, Piece, Rim

EXAMPLES = """
    # can this be wound, and where would it be opened?
    meshwind check part.stl

    # with two of its rims as the ends
    meshwind check part.stl --ends "loops 0 2"

    # a pipe with a wall, wound on its inside
    meshwind check pipe.stl --side inner

    # the numbers, for a script
    meshwind check part.stl --json
"""
_TAKEN = "component", "ends", "opening", "side", "opening_by", "units"
"""Options of `wind` that a check takes."""
_MOST = 12
"""Pieces or rims that are listed one by one."""


@with_records
def check(
    mesh: MeshFile,
    options: Annotated[Options, Pick(_TAKEN)],
    printed: Printed,
) -> int:
    """Describe MESH, its pieces, rims and faults, and what `wind` would do with it.  Writes nothing.

    Exit status: 0 it can be opened at two ends and wound; 2 it cannot, and one line says why.
    """
    from meshwind.mesh import check as look_at

    findings = look_at(mesh, **{name: getattr(options, name) for name in _TAKEN})
    print_report(_lines(findings), asdict(findings), printed)
    if findings.problem:
        raise BadInputError(findings.problem)
    return 0


def _lines(found: "Findings") -> list[str]:
    """The findings, one per line, each after a label."""
    return [*described(found), *(f"repair    {act}" for act in found.repairs), *_verdict(found)]


def described(found: "Findings") -> list[str]:
    """The mesh as it is in its file."""
    rims = _count(len(found.rims), "open rim") if found.rims and not found.side else "open"
    shape = ["closed" if found.closed else rims]
    shape += [] if found.genus is None else [f"genus {found.genus}"]
    shape += ["one-sided"] if found.one_sided else []
    faults = [
        f"{_count(count, 'edge')} {what}"
        for count, what in (
            (found.crowded_edges, "with more than two faces"),
            (found.turned_edges, "between faces that are turned opposite ways"),
        )
        if count
    ]
    of_part = found.part_size if any(found.part_size) else found.size
    whole = f"of all {found.piece_count} pieces: " if found.piece_count > 1 else ""
    return [
        f"mesh      {found.name}: {size(of_part, found.units, found.units_from)}",
        f"file      {found.format}, {found.vertices} vertices, {found.faces} faces",
        f"size      {whole}{' x '.join(f'{length:.4g}' for length in found.size)}, diagonal {found.diagonal:.4g}",
        *_listed("piece", [_piece(piece, found.component) for piece in found.pieces], found.piece_count),
        f"shape     {', '.join(shape)}",
        *_listed("rim", [_rim(rim, found) for rim in found.rims], len(found.rims)),
        *(f"fault     {fault}" for fault in faults),
        *(f"warning   {text}" for text in found.warnings),
    ]


def _verdict(found: "Findings") -> list[str]:
    if found.problem:
        return ["verdict   cannot be wound"]
    lengths = " and ".join(f"{length:.4g}" for length in found.rim_lengths)
    return [
        f"ends      {found.ends}",
        *(f"note      {note}" for note in found.notes),
        f"wound     {found.annulus_vertices} vertices, {found.annulus_faces} faces, rims {lengths} long",
        "verdict   can be opened and wound; how well a surface fits it, only wind tests",
    ]


def _piece(piece: "Piece", chosen: int) -> str:
    kind = "closed" if piece.closed else "open"
    taken = ", taken" if piece.number == chosen else ""
    return f"{piece.number}: area {piece.area:.4g}, {_count(piece.faces, 'face')}, {kind}{taken}"


def _rim(rim: "Rim", found: "Findings") -> str:
    from meshwind.mesh.opening.choose_ends import position_text

    place = position_text(rim.place, found.diagonal)
    skin = f" of the {found.side} skin" if found.side else ""
    use = f", {rim.use}" if rim.use else ""
    return f"{rim.number}{skin}: at {place}, {rim.length:.4g} long, {rim.vertices} vertices{use}"


def _listed(label: str, rows: list[str], count: int) -> list[str]:
    """The rows, each after the label; of many only the first."""
    more = [f"{label:10}and {count - _MOST} more"] if count > _MOST else []
    return [f"{label:10}{row}" for row in rows[:_MOST]] + more


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}{'' if number == 1 else 's'}"
