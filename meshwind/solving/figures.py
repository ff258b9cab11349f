"""The figures of a solved deck: the largest displacement, the worst ply, and the load that makes it fail."""

from typing import NotRequired, TypedDict

import numpy as np
from scipy.spatial import cKDTree

from meshwind.appearance.words import quantity
from meshwind.core.cast import Floats, Ints
from meshwind.core.errors import BadInputError
from meshwind.exporting.shell_about import ReadAbout, again
from meshwind.results.schema import SHELL
from meshwind.solving.fields import Solved

_EDGE = 2.5
"""Over sqrt(R t), the distance from a rim of radius R at which what it does to a wall of thickness t has died away."""
_LARGE = 0.05
"""Displacement over the part's diagonal, and strain, above which a linear solution says little."""


class Place(TypedDict):
    """A point: its coordinates, and the number of the element or node in the deck."""

    at: list[float]
    number: int


class Failure(Place):
    """Where a ply is nearest to failure, at the middle of an element.

    exposure: the load over that at which it fails; load_factor: 1 over it, None without stress; tsai_wu: the
    criterion's polynomial; ply of plies of the element from the inside out, its layer and family; stress: 11, 22, 12 in
    MPa; thickness of the element.
    """

    exposure: float
    load_factor: float | None
    tsai_wu: float
    ply: int
    plies: int
    layer: int
    family: int
    stress: list[float]
    from_rim: float
    thickness: float


class Moved(Place):
    """The largest displacement."""

    length: float


class SolvedFigures(TypedDict):
    """What solved.json holds; lengths are in mesh units, stresses in MPa.

    largest: of all elements; inside: of those further than `edge` from the rims, beyond what clamps and loads do there;
    both are missing where the material's strengths are not known, the latter also if there are none so far.
    """

    part: str
    units: str
    material: str
    deck: str
    elements: int
    plies: int
    moved: Moved
    interaction: float
    edge: float
    largest: NotRequired[Failure]
    inside: NotRequired[Failure]
    notes: list[str]


def figures(done: Solved, about: ReadAbout, deck: str) -> SolvedFigures:
    """The figures; deck: the fingerprint of the deck that was solved.

    Raises BadInputError if the part moves by more than its size, as a part that nothing holds does.
    """
    node = int(done.moved.argmax())
    if (most := float(done.moved[node])) > _size(done):
        raise BadInputError(
            f"the part moves by {quantity(most, about.units, 3)}, more than its size: it is not held, or the "
            f"load is far too large; see the step of {SHELL}, or write it again: {again()}"
        )
    from_rim, edge = _from_rim(done)
    made: SolvedFigures = {
        "part": about.name,
        "units": about.units,
        "material": about.material,
        "deck": deck,
        "elements": len(done.deck),
        "plies": len(done.deck.plies),
        "moved": {
            "length": float(done.moved[node]),
            "at": done.deck.points[node].tolist(),
            "number": node + 1,
        },
        "interaction": about.strengths.interaction,
        "edge": edge,
        "notes": _notes(done, about, deck),
    }
    if done.worst is not None:
        made["largest"] = _failure(done, np.arange(len(done.deck)), from_rim)
        inside = np.flatnonzero(from_rim > edge)
        if len(inside):
            made["inside"] = _failure(done, inside, from_rim)
    return made


def _failure(done: Solved, among: Ints, from_rim: Floats) -> Failure:
    worst = done.worst
    assert worst is not None
    e = int(among[worst.exposure[among].argmax()])
    layer, exposure = done.worst_layer[e], float(worst.exposure[e])
    return {
        "exposure": exposure,
        "load_factor": 1.0 / exposure if exposure > 0.0 else None,
        "tsai_wu": float(worst.polynomial[e]),
        "ply": int(worst.place[e]) + 1,
        "plies": int(done.deck.layers[e]),
        "layer": layer.layer,
        "family": layer.family,
        "stress": worst.stress[e].tolist(),
        "at": done.deck.centre[e].tolist(),
        "number": e + 1,
        "from_rim": float(from_rim[e]),
        "thickness": float(done.thickness[e]),
    }


def _from_rim(done: Solved) -> tuple[Floats, float]:
    """Distance (k,) of each element's middle from the nearer rim, and that at which the rims no longer count."""
    rims = [done.deck.points[rim] for rim in done.deck.rims]
    radius = max(float(np.linalg.norm(rim - rim.mean(axis=0), axis=1).max()) for rim in rims)
    away = cKDTree(np.concatenate(rims)).query(done.deck.centre)[0]
    return np.asarray(away), _EDGE * float(np.sqrt(radius * np.median(done.thickness)))


def _size(done: Solved) -> float:
    """Diagonal of the part."""
    return float(np.linalg.norm(np.ptp(done.deck.points, axis=0)))


def _notes(done: Solved, about: ReadAbout, deck: str) -> list[str]:
    """What a user should know."""
    notes = []
    if deck != about.deck:
        notes.append(f"{SHELL} was changed after its export; strengths are those of its export")
    if done.worst is None:
        notes.append(f"no strengths are known of {about.material}, so that there is no index of failure")
    size = _size(done)
    most = max(float(np.nanmax(np.abs(fields.strain))) for fields in done.plies.values())
    if done.deck.curved:
        notes.append("the deck is geometrically nonlinear, so that stresses do not grow in proportion with the load")
    elif done.moved.max() > _LARGE * size or most > _LARGE:
        moved = 100.0 * float(done.moved.max()) / size
        notes.append(
            f"displacements reach {moved:.2g} % of the part and strains {100.0 * most:.2g} %: "
            "too much for a linear solution; see that the load is meant and in its unit, and that the part is held"
        )
    return notes


def lines(made: SolvedFigures) -> list[str]:
    """The figures in words, one line each."""
    units, moved = made["units"], made["moved"]
    head = f"{made['part']}: {made['elements']} elements, {made['plies']} directions of fibres, {made['material']}"
    out = [f"part      {head}", f"moved     up to {quantity(moved['length'], units)}, at {_at(moved['at'])}"]
    if (largest := made.get("largest")) is not None:
        out += [f"exposure  {_words(largest, units)}", f"          {_stressed(largest, made['interaction'])}"]
        inside = made.get("inside")
        if inside is not None and inside["number"] != largest["number"]:
            edge = quantity(made["edge"], units, 2)
            out.append(f"          further than {edge} from the rims {_words(inside, units)}")
        out.append(f"load      {loaded(made)}")
    return out


def _words(found: Failure, units: str) -> str:
    away, thick = quantity(found["from_rim"], units, 2), quantity(found["thickness"], units, 2)
    place = f"element {found['number']} at {_at(found['at'])}, {thick} thick, {away} from a rim"
    return f"{found['exposure']:.3g} in {_which(found)}, {place}"


def _which(found: Failure) -> str:
    return f"ply {found['ply']} of {found['plies']} (layer {found['layer']}, family {found['family']:+d})"


def _stressed(found: Failure, interaction: float) -> str:
    along, across, shear = (f"{value:.3g}" for value in found["stress"])
    there = f"stress there {along} MPa along the fibre, {across} across, {shear} in shear"
    return f"{there}; Tsai-Wu, F12 = {interaction:g} sqrt(F11 F22)"


def loaded(made: SolvedFigures) -> str:
    """At what multiples of the load the first ply fails, anywhere and beyond the reach of the rims, in words."""
    largest, inside = made.get("largest"), made.get("inside")
    factor = None if largest is None else largest["load_factor"]
    if largest is None or factor is None:
        return "no ply has any stress"
    words = f"the first ply fails at {factor:.3g} times the load"
    if inside is not None and inside["number"] != largest["number"] and inside["load_factor"] is not None:
        words += f", beyond the reach of the rims at {inside['load_factor']:.3g} times"
    return words


def _at(point: list[float]) -> str:
    return f"({', '.join(f'{value:.4g}' for value in point)})"
