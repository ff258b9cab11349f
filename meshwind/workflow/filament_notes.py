"""Notes on a filament: how it closes, what turns it at its ends, and what does not hold."""

import numpy as np

from meshwind.appearance.words import quantity
from meshwind.core.spoken import argument
from meshwind.filament.cap_turn import Cap
from meshwind.filament.closing import ClosedLayer
from meshwind.filament.ends import CAP
from meshwind.filament.lift import leaning
from meshwind.filament.part_turn import Bend
from meshwind.filament.pin_turn import Pins
from meshwind.path.paths import Status
from meshwind.workflow.notes import Note

_SAME_TURNS = 1e-9
"""Revolutions that differ by less are the same."""
_STANDS_UP = 1.0
"""Degrees by which a turnaround stands up from the part at a rim that are worth a word."""
_LEANS = 3.0
"""Degrees at which a fibre may pull along a pin: friction on the pin holds it, as tan 3 is 0.05."""
_AWAY = 1e-3
"""Share of the diagonal by which fibres may leave the part before a rim without a note."""
_HOLLOW = 1e-3
"""Share of the diagonal by which a rim may be hollow without a note."""


def about_filament(layer: ClosedLayer, caps: tuple[bool, bool], units: str = "") -> tuple[Note, ...]:
    """Notes on how a layer closes, what turns at its ends, and what does not hold; caps: which ends are closed."""
    asked, wound = layer.plan.revolutions, layer.revolutions
    notes = []
    if abs(wound - asked) >= _SAME_TURNS:
        notes.append(Note(f"revolutions moved from {asked:.6g} to {wound:.6g}, with which the filament closes"))
    if all(caps) and not any(turn.name == CAP for turn in layer.turnarounds):
        notes.append(
            Note(
                f"both ends are closed: domes turn fibres by {argument('turn_start', 'cap')} and "
                f"{argument('turn_end', 'cap')}, at another angle"
            )
        )
    if layer.words:
        notes.append(Note(layer.words, bool((layer.paths.status != Status.CONVERGED).any())))
    if layer.left_out:
        notes.append(
            Note(f"{layer.left_out} paths are not in the filament, as some are not at rest: the layer has gaps", True)
        )
    for name, turn in zip(("start", "end"), layer.turnarounds, strict=True):
        held = f"at slip {turn.slip:.3g}" if turn.slip > 0.0 else "without friction"
        notes.append(Note(f"{turn.name} at the {name}{_reach(turn.reach, units)}, {held}: {turn.rule}"))
        if isinstance(turn, Bend) and turn.slip > turn.steered:
            needed = f"needs a friction of {turn.slip:.3g}" if np.isfinite(turn.slip) else "lifts off"
            notes.append(
                Note(
                    f"the {turn.name} at the {name} {needed}, and there is {turn.steered:g}: let the layer end where "
                    "the part is more like a cylinder, or at a rim with pins",
                    True,
                )
            )
        if isinstance(turn, Cap):
            continue  # it has no prism that fibres go over to
        before = layer.hung.before[turn.edge.end]
        if before > _AWAY * layer.paths.surface.size:
            standing = -np.degrees(turn.edge.crease[0])
            up = f" by up to {standing:.0f} degrees" if standing > _STANDS_UP else ""
            notes.append(
                Note(
                    f"at the {name} the {turn.name} stand{'' if turn.name == 'pins' else 's'} up from the part{up}: "
                    f"fibres leave it up to {quantity(before, units, 3)} before the rim and go straight over"
                )
            )
        if isinstance(turn, Pins):
            lean = np.degrees(max(leaning(turn, layer.paths, family) for family in (1, -1)))
            if lean > _LEANS:
                notes.append(
                    Note(
                        f"the pins at the {name} need heads: fibres come to them from further out, at up to "
                        f"{lean:.0f} degrees, and would slip off their ends; or lean the pins outwards as much"
                    )
                )
        if turn.edge.hollow > _HOLLOW * layer.paths.surface.size:
            notes.append(
                Note(
                    f"the rim at the {name} is hollow by up to {quantity(turn.edge.hollow, units, 2)}: turnarounds go "
                    "straight over that"
                )
            )
    return tuple(notes)


def _reach(reach: float, units: str) -> str:
    return f", {quantity(reach, units, 3)} beyond it" if reach > 0.0 else ""
