"""The laminate's file: TOML with a table [[layer]] for each layer, in order of winding."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from math import isfinite
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any

from meshwind.core.checks import path_given
from meshwind.core.defaults import TURNAROUNDS
from meshwind.core.errors import BadInputError
from meshwind.core.parsing import AUTO, nearest, read_toml, shortened, turns
from meshwind.core.spoken import argument
from meshwind.filament.thickness import FLAT, HOLLOW, Laying
from meshwind.workflow.band_plan import band_plan, roving_of
from meshwind.workflow.options import Options

if TYPE_CHECKING:
    from meshwind.filament.laminate import Ply

HELICAL, HOOP = KINDS = ("helical", "hoop")
_ONLY = {
    HELICAL: ("angle", "revolutions", "paths", "turn_start", "turn_end"), HOOP: ("passes", "overlap", "stagger")
}  # fmt: skip
"""Keys that one kind of layer has and the other has not."""
_NAMES = {"from": "start", "to": "end"}
"""Keys of the file whose names differ from the fields'."""
_MOST_LAYERS = 200
"""Layers of a laminate: each is wound on a surface of its own."""


@dataclass(frozen=True)
class LayerPlan:
    """A layer as its table says it; None where a key is not given.

    kind: "helical" or "hoop"; angle: in degrees, at the widest place; revolutions: turns of a path; paths: a family,
    or "auto" for as many as cover the part; band_width, band_thickness: in the part's units; tex, tows, fibre_density,
    resin_density, fibre_volume: as `Roving`; the run's count where these are None; friction; start, end: places along
    the part, as `station` reads them; repeat: times that the layer is wound; section, bridges: as `Laying`; passes,
    overlap, stagger: as `HoopPlan`; turn_start, turn_end: how it turns at both ends, where the layers are one filament;
    by default as the run's; cut: whether the fibre is cut before it, rather than led on from the layer before.
    """

    kind: str
    angle: float | None = None
    revolutions: float | str | None = None
    paths: int | str = AUTO
    band_width: float | None = None
    band_thickness: float | None = None
    tex: float | None = None
    tows: int | None = None
    fibre_density: float | None = None
    resin_density: float | None = None
    fibre_volume: float | None = None
    friction: float | None = None
    start: float | str = 0.0
    end: float | str = 1.0
    repeat: int = 1
    section: str = FLAT
    bridges: str = HOLLOW
    passes: int = 1
    overlap: float = 0.0
    stagger: float = 0.0
    turn_start: str | None = None
    turn_end: str | None = None
    cut: bool = False

    def __post_init__(self) -> None:
        if self.kind not in KINDS:
            raise BadInputError(f"kind is {shortened(repr(self.kind))}; give {' or '.join(KINDS)}")
        if self.kind == HELICAL and (self.angle is None) == (self.revolutions is None):
            raise BadInputError("a helical layer needs an angle or its revolutions; give one of both")
        if self.angle is not None and not 0.0 <= self.angle < 90.0:
            raise BadInputError(f"angle is {self.angle:g}; give degrees from 0 up to, not with, 90, or a hoop layer")
        if isinstance(self.revolutions, str):
            object.__setattr__(self, "revolutions", _turned(self.revolutions))
        elif self.revolutions is not None and not 0.0 <= self.revolutions < float("inf"):
            raise BadInputError(f"revolutions is {self.revolutions:g}; give a number from 0 up")
        if isinstance(self.paths, str) and self.paths != AUTO:
            raise BadInputError(f"paths is {shortened(repr(self.paths))}; give a whole number, or {AUTO!r}")
        for name, least in (("paths", 1), ("repeat", 1), ("passes", 1)):
            value = getattr(self, name)
            if not isinstance(value, str) and value < least:
                raise BadInputError(f"{name} is {value}; give a whole number from {least} up")
        if self.friction is not None and not 0.0 <= self.friction <= 10.0:
            raise BadInputError(f"friction is {self.friction:g}; give a number from 0 to 10")
        for name in ("turn_start", "turn_end"):
            word = getattr(self, name)
            if word is not None and word not in (AUTO, *TURNAROUNDS):
                raise BadInputError(f"{name} is {shortened(repr(word))}; give {', '.join(TURNAROUNDS)} or {AUTO}")

    def ply(self, options: Options, units: str) -> Ply:
        """Its band, with the run's values where it has none of its own; `units` are those of the part."""
        band = band_plan(options, units, self)
        if band.width is None:
            raise BadInputError(
                f"a layer needs the width of its band; give band_width in its table, or {argument('band_width')}"
            )
        if band.thickness is None:
            raise BadInputError("a layer needs the thickness of its band; give band_thickness, or tex")
        friction = self.friction
        if friction is None:
            friction = options.friction if isinstance(options.friction, float) else 0.0
        from meshwind.filament.laminate import Ply  # late: most runs have no laminate

        laying = Laying(band.width, band.thickness, self.section, self.bridges)
        return Ply(laying, friction, band.roving)

    def turns(self, options: Options) -> tuple[str, str]:
        """Its turnarounds at the start and at the end."""
        return self.turn_start or options.turn_start, self.turn_end or options.turn_end


def _turned(text: str) -> float:
    value = turns(text)
    if isinstance(value, str):
        raise BadInputError(f"revolutions is {text!r}; give a number as in 0.5 or 5/12, or an angle")
    return value


_TEXT, _WHOLE = ((str,), "a text in quotes"), ((int,), "a whole number")
_PLACE = (float, int, str), 'v from 0 to 1, or a text such as "z=120"'
_TYPES: dict[str, tuple[tuple[type, ...], str]] = {
    "revolutions": ((float, int, str), "a number, or a fraction in quotes"),
    "paths": ((int, str), 'a whole number, or "auto"'),
    "start": _PLACE, "end": _PLACE, "repeat": _WHOLE, "passes": _WHOLE, "tows": _WHOLE,
    "cut": ((bool,), "true or false"),
    "kind": _TEXT, "section": _TEXT, "bridges": _TEXT, "turn_start": _TEXT, "turn_end": _TEXT,
}  # fmt: skip
"""Types of TOML that a key's value may have, and their words; all others are numbers."""
_NUMBER = (float, int), "a number"


@dataclass(frozen=True)
class LayersFile:
    """A laminate's file and the layers that it names, in order of winding."""

    file: Path
    plans: tuple[LayerPlan, ...]


def read_layers(file: str | PathLike[str], options: Options) -> LayersFile:
    """Read a laminate's file.

    Parameters
    ----------
    file : str or PathLike
        TOML with a table [[layer]] for each layer, in order of winding.
    options : Options
        Those of the run, which may not say where paths end.

    Returns
    -------
    LayersFile
        The layers, one for each table.

    Raises
    ------
    BadInputError
        If the file cannot be read, or a table has a key or a value that no layer has; the message names the layer.
    """
    path = path_given(file, "layers", "TOML file of the layers")
    if not fspath(file).strip():
        raise BadInputError(f"layers is {fspath(file)!r}; give the path of a TOML file of the layers")
    for name in ("pins", "spacing", "angle"):
        if getattr(options, name) is not None:
            raise BadInputError(f"{name} and layers both say where paths lie; give one of both")
    tables = read_toml(path, "laminate")
    other = [key for key in tables if key != "layer"]
    if other:
        raise BadInputError(f"{path}: {other[0]!r} stands outside of a layer; begin each layer with [[layer]]")
    layers = tables.get("layer", [])
    if not isinstance(layers, list) or not layers or not all(isinstance(each, dict) for each in layers):
        raise BadInputError(f"{path} has no layer; begin each layer with [[layer]]")
    plans = tuple(_read(path, number, table, options) for number, table in enumerate(layers, 1))
    if not options.continuous:
        turned = next((k for k, plan in enumerate(plans, 1) if plan.turn_start or plan.turn_end), None)
        if turned is not None:
            raise BadInputError(
                f"{path}: layer {turned}: turnarounds are of a filament; set {argument('continuous')}, or leave "
                "them out"
            )
        cut = next((k for k, plan in enumerate(plans, 1) if plan.cut), None)
        if cut is not None:
            raise BadInputError(
                f"{path}: layer {cut}: only a filament is cut; set {argument('continuous')}, or leave cut out"
            )
    if sum(plan.repeat for plan in plans) > _MOST_LAYERS:
        raise BadInputError(f"{path} has more than {_MOST_LAYERS} layers; wind it in several runs")
    return LayersFile(path, plans)


def _read(path: Path, number: int, table: Mapping[str, Any], options: Options) -> LayerPlan:
    names = {field.name for field in fields(LayerPlan)} - set(_NAMES.values()) | set(_NAMES)
    values: dict[str, Any] = {}
    try:
        for key, value in table.items():
            name = key.replace("-", "_")
            if name not in names:
                raise BadInputError(f"{key!r} is no key of a layer; {nearest(key, sorted(names))}")
            name = _NAMES.get(name, name)
            types, words = _TYPES.get(name, _NUMBER)
            if type(value) not in types or (isinstance(value, float) and not isfinite(value)):
                raise BadInputError(f"{key} is {shortened(repr(value))}; give {words}")
            values[name] = float(value) if type(value) is int and float in types else value
        if "kind" not in values:
            raise BadInputError(f"kind is missing; give {' or '.join(KINDS)}")
        _check_kind(values)
        plan = LayerPlan(**values)
        roving_of(options, plan)  # its numbers are checked before any work
    except BadInputError as error:
        raise BadInputError(f"{path}: layer {number}: {error}") from error
    return plan


def _check_kind(values: Mapping[str, Any]) -> None:
    """Raise BadInputError for a key that the other kind of layer has."""
    for kind, names in _ONLY.items():
        wrong = [name for name in names if name in values]
        if wrong and values["kind"] in KINDS and values["kind"] != kind:
            raise BadInputError(f"{wrong[0]} is for {kind} layers; leave it out of a {values['kind']} layer")
