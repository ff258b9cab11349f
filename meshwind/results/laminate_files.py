"""The laminate's files and figures: what each layer is, along the part and over it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from meshwind.core.cast import Floats
from meshwind.core.geometry import Block
from meshwind.core.units import MILLIMETRES, millimetres
from meshwind.filament.stations import Stations
from meshwind.filament.thickness import Thickness
from meshwind.layup.direction import winding_angle
from meshwind.results import schema
from meshwind.results.laminate_types import JoinFigures, LayerFigures
from meshwind.results.legends import write_legend
from meshwind.results.station_figures import angle_figures, cover_figures, thickness_figures
from meshwind.results.vtk_files import write_faces, write_lines
from meshwind.surface.grid import Grid, grid

if TYPE_CHECKING:
    from meshwind.filament.joins import Strand
    from meshwind.filament.laminate import LaidLayer, Laminate

LEGEND = {
    "v": ("", "place along the part, from 0 at the start rim to 1 at the end rim"),
    "z": ("{u}", "height along the part's axis"),
    "layer": ("", "number of the layer, from 0"),
    "angle": ("degrees", "winding angle, 0 along the part and 90 around it: the median over the paths"),
    "thickness": ("{u}", "thickness of the layer, the mean around the part; empty where that of the band is not known"),
    "cover": ("", "layers of band over the surface, the mean around the part"),
}
"""The columns of laminate.csv."""


def write_laminate(out: Path, laminate: Laminate, units: str = "") -> None:
    """Write laminate.csv, laminate.vtu, laminate.npz and layers.vtp into an existing folder."""
    write_stations(out, [(layer.stations, layer.thickness) for layer in laminate.layers], units)
    _write_maps(out / schema.LAMINATE, laminate, units)
    _write_fibres(out / schema.LAYER_FIBRES, laminate, units)
    with (out / schema.LAYER_SURFACES).open("wb") as file:
        nets = np.stack([surface.control_points for surface in laminate.surfaces])
        arrays: dict[str, Any] = {schema.CONTROL_POINTS: nets, schema.UNITS: np.str_(units)}
        np.savez(file, **arrays)


def write_stations(out: Path, layers: Sequence[tuple[Stations, Thickness | None]], units: str = "") -> None:
    """Write laminate.csv with its legend into an existing folder.

    It has a row for each station and layer; a layer has none where it is not, and no thickness where that is not known.
    """
    write_legend(out / schema.STATIONS_LEGEND, LEGEND, units)
    with (out / schema.STATIONS).open("w", encoding="ascii") as file:
        file.write(f"{','.join(LEGEND)}\n")
        for number, (at, over) in enumerate(layers):
            here = np.isfinite(at.angle)
            columns = [at.v, at.height, np.full(len(at.v), number), np.degrees(at.angle), at.cover]
            if over is not None:
                rings = over.along()
                columns.insert(4, np.interp(at.v, (np.arange(len(rings)) + 0.5) / len(rings), rings))
            thickness = "" if over is None else "%.17g"
            np.savetxt(file, np.stack(columns, axis=1)[here], fmt=f"%.17g,%.17g,%d,%.17g,{thickness},%.17g")


def _write_maps(path: Path, laminate: Laminate, units: str) -> None:
    """The part's surface with thickness and angle of each layer, counted from 1, and the thickness of all."""
    on = grid(laminate.layers[0].surface)
    data: dict[schema.Field, NDArray[Any]] = {schema.UV: on.uv}
    each = [layer.thickness.at(on.uv) for layer in laminate.layers]
    data[schema.THICKNESS] = np.sum(each, axis=0)
    for number, (layer, thickness) in enumerate(zip(laminate.layers, each, strict=True), 1):
        fields = schema.layer_fields(number)
        data[fields.thickness] = thickness
        data[fields.angle] = np.degrees(_angle(layer, on))
    write_faces(path, schema.LAMINATE, Block(on.points, quads=on.quads, point_data=data), units)


def _angle(layer: LaidLayer, on: Grid) -> Floats:
    """Winding angle (k,) of a layer on the grid's points, in radians."""
    if layer.paths is not None:
        return winding_angle(layer.paths, *on.shape).ravel()
    at = layer.stations
    here = np.isfinite(at.angle)
    return np.asarray(np.interp(on.uv[:, 1], at.v[here], at.angle[here]))


def _write_fibres(path: Path, laminate: Laminate, units: str) -> None:
    """One polyline for each path and each hoop, with the number of its layer."""
    points, uv, normals, sizes, layers, families = [], [], [], [], [], []
    for number, layer in enumerate(laminate.layers):
        if layer.hoop is not None:
            course = layer.hoop.course
            rows, where, normal = course.points[None], layer.hoop.tracks.uv, course.normal[None]
            family = np.ones(1, dtype=np.int64)
        else:
            assert layer.paths is not None
            rows, where, normal, family = layer.paths.points, layer.paths.uv, layer.paths.normal, layer.paths.family
        points.append(rows.reshape(-1, 3))
        uv.append(where.reshape(-1, 2))
        normals.append(normal.reshape(-1, 3))
        sizes.append(np.full(len(rows), rows.shape[1]))
        layers.append(np.full(len(rows), number))
        families.append(family)
    starts = np.concatenate([[0], np.cumsum(np.concatenate(sizes))])
    point_data = {schema.UV: np.concatenate(uv), schema.NORMAL: np.concatenate(normals)}
    cell_data = {schema.LAYER: np.concatenate(layers), schema.FAMILY: np.concatenate(families)}
    block = Block(np.concatenate(points), starts, point_data=point_data, line_data=cell_data)
    write_lines(path, schema.LAYER_FIBRES, block, units)


def laminate_figures(laminate: Laminate, units: str = "") -> list[LayerFigures]:
    """The figures of each layer."""
    return [_layer_figures(number, layer, units) for number, layer in enumerate(laminate.layers)]


def _layer_figures(number: int, layer: LaidLayer, units: str) -> LayerFigures:
    length, thickness, roving = layer.fibre_length, layer.thickness, layer.roving
    scale = millimetres(units) if units in MILLIMETRES else 1.0
    hoop = layer.hoop
    return {
        "layer": number,
        "kind": layer.kind,
        "circuits": layer.circuits,
        "left_out": layer.left_out,
        "friction": layer.friction,
        "band_width": layer.laying.width,
        "band_thickness": layer.laying.thickness,
        "bridges": layer.laying.bridges,
        "angle": angle_figures(layer.stations),
        "cover": cover_figures(layer.stations),
        "thickness": thickness_figures(thickness),
        "fibre_length": length,
        "volume": thickness.volume,
        "over_rim": thickness.over_rim / thickness.volume,
        "filler_volume": float((thickness.filler * thickness.area).sum()),
        "fibre_mass": None if roving is None else roving.fibre_mass(length * scale),
        "resin_mass": None if roving is None else roving.resin_mass(length * scale),
        "off_below": layer.off_below,
        "hold": None
        if hoop is None
        else {"friction_needed": hoop.friction, "slips": hoop.slips(layer.friction), "lifts": hoop.lifts},
        "raised": {
            "off_rms": layer.raised.off_rms,
            "off_max": layer.raised.off_max,
            "evened": layer.raised.evened,
            "hollow": layer.raised.hollow,
        },
        "turnarounds": None if layer.closed is None else [each.name for each in layer.closed.turnarounds],
        "join": None if layer.strand is None else _join_figures(layer.strand),
    }


def _join_figures(strand: Strand) -> JoinFigures:
    """The figures of the way that leads to a layer."""
    return {"length": 0.0 if strand.join is None else float(strand.join.arc_length[-1]), "slip": strand.slip}
