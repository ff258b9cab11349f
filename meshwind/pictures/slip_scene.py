"""What is to be seen on slip.png: the friction that the fibres need against the friction that there is."""

from typing import Any

import numpy as np

from meshwind.appearance.looks import Scale
from meshwind.core.cast import Floats
from meshwind.pictures.subject import Subject
from meshwind.pictures.winding_scene import fibres

NONE = 1e-6
"""Slip below this is round-off: the fibre is a geodesic."""


def slip_scene(of: Subject) -> dict[str, Any]:
    """Fibres at rest by their slip; NaN where it is not defined: off the surface and at the two ends."""
    friction, most = of.paths.friction, of.figures.max_slip
    end = max(friction, most) if max(friction, most) > NONE else 0.0
    slip = of.paths.slip[:, of.kept]
    scale = Scale(("slip:", "friction", "needed"), "viridis", 0.0, end or 1.0)
    title = f"{of.name}: slip of the fibres"
    seen = of.framed("slip", title, _subtitle(of, end)) | fibres(of) | scale.told
    return seen | {"shares": scale.shares(slip), "needed": end > 0.0, "bridges": not bool(of.paths.on_surface.all())}


def _subtitle(of: Subject, end: float) -> str:
    friction, most = of.paths.friction, of.figures.max_slip
    if end == 0.0:
        return "no friction needed: wherever a fibre touches it is a geodesic"
    held = _held(of.paths.slip, friction)
    parts = [f"friction {friction:g}" if friction else "wound without friction", f"largest slip {most:.3g}"]
    if friction:
        parts.append(f"{100.0 * held:.0f} % of the fibre that touches needs all of the friction")
    return "  ·  ".join(parts)


def _held(slip: Floats, friction: float) -> float:
    """Share of the known slips that are at the friction: there the fibre has slipped until friction held it."""
    known = slip[np.isfinite(slip)]
    return float((known > 0.999 * friction).mean()) if len(known) and friction > 0.0 else 0.0
