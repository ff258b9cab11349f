"""The options of a redesign: what it is to hold, and how it is edited."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from math import isfinite
from numbers import Real
from os import PathLike
from pathlib import Path
from typing import Any

from meshwind.core.checks import check_switch, is_number, number, text, whole
from meshwind.core.errors import BadInputError
from meshwind.core.option import option
from meshwind.core.parsing import AUTO, several_turns, shortened
from meshwind.workflow.option_checks import FIELD
from meshwind.workflow.options import FIBRES, IN_MESH_UNITS

EDIT = "The edit"
"""Group of these options."""


@dataclass(frozen=True)
class EditOptions:
    """Options of an edit; raises BadInputError for one that cannot be used, with its value and what it may be.

    bound: largest displacement, None for any, "field:NAME" for a scalar of the mesh file, or one for each vertex, of
    each control point (m,) where a surface is edited by itself; frozen: what must not move (see `redesign`), there as a
    mask (nu, nv) of control points or a function from their positions (m, 3) to a mask (m,); symmetry: order of
    rotation about u that is kept; mirror: planes of reflection that are; threshold: a gap up to this is none, None for
    the surface's uncertainty; at_most: gap that may stay; keep_volume, only_outward, only_inward: what the change
    keeps, at samples of the surface; rounds: largest number of them; fairness: wave length over the part's size at
    which a change of the net costs as much by its bending as by its size, 0 for (6.12) alone; pressing: least normal
    curvature along the fibres times the part's size.
    """

    bound: Any = field(
        default=None,
        metadata=option(
            f"Largest displacement, in the mesh's units, or {FIELD}NAME for a scalar of the mesh file",
            EDIT,
            metavar="LENGTH",
            otherwise="none",
            read=str,
        ),
    )
    frozen: Any = field(
        default=None,
        metadata=option(
            'Region that must not move: ranges of u, v and the mesh\'s x, y and z, as in "v<0.1, z>20", boxes, as in '
            f'"x>0 & 2<z<5", faces, as in "faces:3-17" or "faces:FILE", or {FIELD}NAME for a scalar of the mesh file',
            EDIT,
            metavar="WHERE",
            read=str,
            name="freeze",
        ),
    )
    symmetry: int = field(default=1, metadata=option("Order of the rotational symmetry that is kept", EDIT))
    mirror: str | None = field(
        default=None,
        metadata=option(
            'Mirror planes that are kept: x, y or z through the middle of the part, "x=12", or "a b c d" for '
            "ax+by+cz=d, by commas",
            EDIT,
            metavar="PLANES",
        ),
    )
    threshold: float | None = field(
        default=None,
        metadata=option(
            "Ignore gaps smaller than this", EDIT, unit=IN_MESH_UNITS, otherwise="the surface's uncertainty"
        ),
    )
    at_most: float = field(
        default=0.0,
        metadata=option("Largest gap that may stay, such as the thickness of the band", EDIT, unit=IN_MESH_UNITS),
    )
    keep_volume: bool = field(default=False, metadata=option("Keep the volume, to 1e-3 of it", EDIT))
    only_outward: bool = field(default=False, metadata=option("Add material only", EDIT))
    only_inward: bool = field(default=False, metadata=option("Take material away only", EDIT))
    rounds: int = field(default=10, metadata=option("Maximum number of rounds of editing and winding again", EDIT))
    fairness: float = 0.4
    pressing: float = 0.2
    """A bow of 1/40 of a chord as long as the part.

    A refit of the edited mesh moves the surface by its fit error over waves of some spans; with this much the fibres
    of the sample parts lift off again by less than that error.
    """

    def __post_init__(self) -> None:
        whole(self.rounds, "rounds", 0)
        whole(self.symmetry, "symmetry", 1)
        if self.mirror is not None and not isinstance(self.mirror, str):
            raise BadInputError(f"mirror is {text(self.mirror)}; give planes such as 'x' or 'x=12,y'")
        object.__setattr__(self, "bound", _bound(self.bound))
        if self.threshold is not None and not (is_number(self.threshold) and self.threshold > 0):
            raise BadInputError(f"threshold is {text(self.threshold)}; give a length above 0, or none at all")
        for name in ("keep_volume", "only_outward", "only_inward"):
            check_switch(getattr(self, name), name)
        if self.only_outward and self.only_inward:
            raise BadInputError("only_outward and only_inward leave nothing to move; give one of them")
        for name in ("fairness", "pressing", "at_most"):
            object.__setattr__(self, name, number(getattr(self, name), name, 0.0))


def _bound(value: Any) -> Any:
    """A bound: a length above 0, also as a text, the name of a field, or as it is if it is an array."""
    if value is None or (isinstance(value, str) and value.startswith(FIELD) and value.removeprefix(FIELD).strip()):
        return value
    if not isinstance(value, str | Real):
        return value
    try:
        length = float(value)
    except ValueError as error:
        raise BadInputError(f"bound is {shortened(repr(value))}; give a length, or {FIELD}NAME") from error
    if not (isfinite(length) and length > 0):
        raise BadInputError(f"bound is {value}; give a length above 0, or none at all")
    return length


@dataclass(frozen=True)
class WindingOptions:
    """What a redesigned part is to hold; raises BadInputError for what cannot be wound.

    revolutions: one number, "auto", or several, of a winding each; layers: the file of a laminate instead.  By default
    the revolutions are chosen, as those that bridge least leave the least to edit.
    """

    revolutions: float | str | tuple[float, ...] = field(
        default=AUTO,
        metadata=option(
            "Turns of a path from end to end, as in 0.5 or 5/12; auto picks the value with stable paths and least "
            "bridging; several, by commas, are windings that the part is to hold at once",
            FIBRES,
            metavar="TURNS",
            words=(AUTO,),
            read=several_turns,
        ),
    )
    layers: str | PathLike[str] | None = field(
        default=None,
        metadata=option(
            "TOML file of a laminate, whose layers the part is to hold, each on the bare part", FIBRES, is_file=True
        ),
    )

    def __post_init__(self) -> None:
        if isinstance(self.revolutions, str):
            object.__setattr__(self, "revolutions", several_turns(self.revolutions))
        if isinstance(self.revolutions, Iterable) and not isinstance(self.revolutions, str):
            numbers = tuple(number(each, "revolutions", 0.0) for each in self.revolutions)
            if not numbers:
                raise BadInputError("revolutions is empty; give one number or more")
            object.__setattr__(self, "revolutions", numbers if len(numbers) > 1 else numbers[0])
        elif self.revolutions != AUTO:
            object.__setattr__(self, "revolutions", number(self.revolutions, "revolutions", 0.0))
        if self.layers is not None and self.revolutions != AUTO:
            raise BadInputError("revolutions and layers both say what is wound; give one of both")

    def written(self) -> dict[str, object]:
        """The options as they stand in files."""
        several = ",".join(f"{each!r}" for each in self.several)
        file = None if self.layers is None else Path(self.layers)
        return {"revolutions": several or self.revolutions, "layers": file}

    @property
    def most(self) -> float | str:
        """The revolutions, or the most of several."""
        return max(self.revolutions) if isinstance(self.revolutions, tuple) else self.revolutions

    @property
    def several(self) -> tuple[float, ...]:
        """The revolutions, where they are several."""
        return self.revolutions if isinstance(self.revolutions, tuple) else ()
