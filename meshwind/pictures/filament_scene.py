"""Scenes of a filament: its bands in the order of winding, and what the bands leave bare."""

import numpy as np

from meshwind.appearance.gear import gear
from meshwind.appearance.looks import SEQUENTIAL, Scale
from meshwind.appearance.ribbons import ribbons
from meshwind.appearance.strips import Gear, Ribbons
from meshwind.appearance.view import View, framed
from meshwind.appearance.words import quantity
from meshwind.filament.filament import Filament
from meshwind.pictures.scenes import FilamentScene, Groups
from meshwind.pictures.subject import Subject
from meshwind.results.laminate_reading import fibre_of

_OUT, _BACK = "#9cc3dc", "#f2cf8d"
"""Paler than the fibres of the families, so that the signal colour stands out."""
_LAYERS = _OUT, _BACK, "#a9d6b5", "#c9b8e0", "#d8c2a8", "#b7bdc4"
"""Colours of layers, over and over: as pale, and each unlike its neighbours."""


def filament_scene(of: Subject) -> FilamentScene:
    """The bands, lifted and coloured by their order, on the part and its turnarounds."""
    made, stands = ribbons(of.filaments, of.paths.surface, of.widths, of.turned), _gear(of)
    total = float(made.laid[-1])
    words = ("wound so far,", f"in {of.units}") if of.units else ("wound so far",)
    scale = Scale(words, SEQUENTIAL, 0.0, total)
    many = "one filament" if len(of.filaments) == 1 else f"{len(of.filaments)} filaments"
    subtitle = f"{of.pattern}  ·  " if of.pattern else ""
    subtitle += f"{quantity(total, of.units)} of band {_wide(of)}"
    frame = of.frame(f"{of.name}: {many} in the order of winding", subtitle, _view(of, made, stands))
    return FilamentScene(frame, of.part, made, stands, scale)


def bands_scene(of: Subject) -> FilamentScene:
    """The bands by layer or, of a single one, by pass or family, over a part whose bare places show."""
    fibres = of.filaments or (_paths(of) if of.laminate is None else of.laminate.fibres)
    made, stands = ribbons(fibres, of.paths.surface, of.widths, of.turned), _gear(of)
    layers = int(made.layer.max()) + 1
    if layers > 1:
        colours = tuple(_LAYERS[k % len(_LAYERS)] for k in range(layers))
        kinds = [each["kind"] for each in of.layers] if len(of.layers) == layers else [""] * layers
        names = tuple(f"layer {k + 1} {kind}".strip() for k, kind in enumerate(kinds))
        groups, bare = Groups(made.layer, colours, names), f"{layers} layers, one on another"
    else:
        names = ("passes out", "passes back") if of.filaments else ("family +1", "family −1")
        groups = Groups(made.passed % 2, (_OUT, _BACK), names)
        share = of.layup.bands.bare
        bare = "nothing bare" if share == 0.0 else f"{100.0 * share:.2g} % of the part bare"
    frame = of.frame(f"{of.name}: bands of true width", f"band {_wide(of)}  ·  {bare}", _view(of, made, stands))
    return FilamentScene(frame, of.part, made, stands, groups=groups)


def _paths(of: Subject) -> tuple[Filament, ...]:
    """The paths of a winding that is not continuous, each as a filament of its own."""
    return tuple(fibre_of(of.paths, row) for row in range(len(of.paths)))


def _wide(of: Subject) -> str:
    """The widths of the bands in words."""
    low, high = min(of.widths), max(of.widths)
    span = quantity(high, of.units, 3)
    return f"{span} wide" if low == high else f"{quantity(low, '', 3)} to {span} wide"


def _gear(of: Subject) -> Gear:
    return gear(of.paths.surface, of.filaments, of.turned if of.filaments else ())


def _view(of: Subject, strips: Ribbons, stands: Gear) -> View:
    """The view of the part, wide enough for its turnarounds."""
    return framed(np.concatenate([of.points, strips.points.reshape(-1, 3), stands.points]), of.view)
