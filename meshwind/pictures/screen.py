"""A window with a wound part, to turn with the mouse."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from meshwind.appearance.looks import colour_map
from meshwind.core.geometry import Block

if TYPE_CHECKING:
    import pyvista

_THICK = 2e-3
"""Radius of a fibre over the diagonal of the part."""


def has_screen() -> bool:
    """Whether a window can open: not in a notebook, and on Linux only where there is a display."""
    if "ipykernel" in sys.modules:
        return False
    return not sys.platform.startswith("linux") or bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


def show(blocks: Mapping[str, Block], title: str) -> None:
    """Open a window with the blocks of a wound part, and return when it is closed."""
    window(blocks, title).show()


def window(blocks: Mapping[str, Block], title: str, **options: Any) -> pyvista.Plotter:
    """The window, not open yet; options: of PyVista's Plotter."""
    import pyvista

    from meshwind.pictures import canvas

    made = pyvista.Plotter(title=title, **options)
    thick = _THICK * float(np.linalg.norm(np.ptp(blocks["part"].points, axis=0)))
    for name, block in blocks.items():
        mesh = block.to_pyvista()
        if name == "part":
            made.add_mesh(mesh, color=canvas.PART, smooth_shading=True, name=name)
        elif name == "fibres":
            tubes = mesh.tube(radius=thick, n_sides=8)
            colours = [canvas.FAMILY[family] for family in (-1, 1)]
            made.add_mesh(tubes, scalars="family", cmap=colours, show_scalar_bar=False, name=name)
        elif name == "bridges":
            tubes = mesh.tube(radius=1.5 * thick, n_sides=8)
            made.add_mesh(tubes, scalars="gap", cmap=colour_map("gap"), name=name, scalar_bar_args={"title": "gap"})
    made.add_axes()
    return made
