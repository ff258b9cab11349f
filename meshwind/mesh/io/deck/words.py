"""Words on what of a deck is not part of the surface, or is read otherwise than it is written."""

from collections import Counter

from meshwind.core.errors import BadInputError
from meshwind.mesh.io.deck.elements import SECTION, cell_kind
from meshwind.mesh.io.deck.part import Part

_LENGTH = 80
"""Largest number of characters of a list of names."""


def words_on_elements(parts: list[Part], file: str) -> list[str]:
    """Words on elements that are left out, and on those given twice.  Raises BadInputError if none is left."""
    parts = list({id(part): part for part in parts}.values())
    unknown, sections = _others(parts, None), _others(parts, SECTION)
    known = sum(len(cells.ids) for part in parts for cells in part.cells) - sum(part.twice[1] for part in parts)
    total = known + unknown.total() + sections.total()
    if not known and unknown:
        raise BadInputError(f"{file}: its {total} elements are of types that are not read ({_list(unknown)}); "
                            "export shells or solids")  # fmt: skip
    if not known and sections:
        raise BadInputError(f"{file}: its {total} elements are of an axisymmetric section ({_list(sections)}), which "
                            "is not read; export shells or solids in space")  # fmt: skip
    nodes, cells = (sum(part.twice[which] for part in parts) for which in (0, 1))
    short = sum(len(cells.ids) for part in parts for cells in part.cells if cells.shortened)
    said = {
        f"elements of types that are not known ({_list(unknown)}) are left out, of {total}": unknown.total(),
        f"elements of an axisymmetric section ({_list(sections)}) are left out, of {total}": sections.total(),
        f"elements of {known} are read without the nodes in the middle of their sides": short,
        "nodes are defined again at another place; the last definition of each counts": nodes,
        "elements are defined again; the last definition of each counts": cells,
    }
    return [f"{count} {words}" for words, count in said.items() if count]


def words_on_parts(parts: dict[str, Part], used: set[str]) -> list[str]:
    """Words on parts with elements that no instance uses; without instances they are all read."""
    idle = [part.name or "without a name" for name, part in parts.items()
            if name not in used and (part.cells or part.others)]  # fmt: skip
    if not idle:
        return []
    if used:
        return [f"parts that no instance uses are left out: {_list(idle)}"]
    return [f"no instance uses a part; they are read where they are written: {_list(idle)}"]


def _others(parts: list[Part], kind: str | None) -> Counter[str]:
    """Numbers of the elements that are not read, by their types, of those types that `cell_kind` gives a kind."""
    count: Counter[str] = Counter()
    for part in parts:
        for name, ids in part.others:
            if cell_kind(name) == kind:
                count[name or "without a type"] += len(ids)
    return +count


def _list(names: Counter[str] | list[str]) -> str:
    words = ", ".join(list(names)[:5])
    return words if len(words) <= _LENGTH else words[: _LENGTH - 3] + "..."
