"""A barrel of 80 triangles or 40 quadrangles, for tests that write it in every way a format allows."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

from meshwind.core.cast import Floats
from meshwind.core.errors import BadInputError
from meshwind.mesh.geometry.areas_and_volumes import areas
from meshwind.mesh.io.file_mesh import FileMesh
from meshwind.mesh.io.read import load

ROUND, RINGS = 8, 6
Face = tuple[int, ...]


def _points() -> Floats:
    z = np.linspace(0.0, 90.0, RINGS)
    radius = 20.0 + 3.0 * np.sin(np.pi * z / 90.0)
    turn = 2.0 * np.pi * np.arange(ROUND) / ROUND
    rows = [(r * np.cos(t), r * np.sin(t), h) for r, h in zip(radius, z, strict=True) for t in turn]
    return np.array(rows).astype(np.float32).astype(np.float64)  # so that no format rounds them


POINTS = _points()
QUADS: list[Face] = [
    (ROUND * j + i, ROUND * j + (i + 1) % ROUND, ROUND * (j + 1) + (i + 1) % ROUND, ROUND * (j + 1) + i)
    for j in range(RINGS - 1)
    for i in range(ROUND)
]
TRIANGLES: list[Face] = [half for a, b, c, d in QUADS for half in ((a, b, c), (a, c, d))]
MIXED: list[Face] = QUADS[:20] + TRIANGLES[40:]
"""The same barrel: below of quadrangles, above of triangles."""
BOTTOM: Face = tuple(range(ROUND - 1, -1, -1))
"""An octagon that closes the lower end."""


def fan(face: Face) -> list[Face]:
    """Triangles of a convex polygon."""
    return [(face[0], face[k], face[k + 1]) for k in range(1, len(face) - 1)]


def strip(ring: int) -> list[int]:
    """The triangles between two rings as a strip."""
    return [ROUND * (ring + 1 - k) + i % ROUND for i in range(ROUND + 1) for k in (0, 1)]


STRIPS = [number for ring in range(RINGS - 1) for number in [*strip(ring), -1]]


def area(faces: Sequence[Face] = TRIANGLES) -> float:
    """Area of polygons of the barrel's points."""
    return float(areas(POINTS, np.array([part for face in faces for part in fan(face)])).sum())


def numbers(values: Sequence[float] | Floats) -> str:
    """Numbers with all their digits, parted by blanks."""
    return " ".join(repr(float(value)) for value in values)


def written(folder: Path, name: str, content: str | bytes) -> Path:
    """A file with a content; text is written in UTF-8."""
    path = folder / name
    path.write_bytes(content.encode() if isinstance(content, str) else content)
    return path


def read_back(path: Path, expected: float | None = None, triangles: int = 80, warns: str = "") -> FileMesh:
    """Read a file and compare its area and triangles; `warns` is a part of its only warning, "" if there is none."""
    held = load(path)
    assert len(held.faces) == triangles
    assert areas(held.vertices, held.faces).sum() == pytest.approx(area() if expected is None else expected, rel=1e-12)
    assert len(held.warnings) == bool(warns) and all(warns in text for text in held.warnings), held.warnings
    return held


def refusal(path: Path) -> str:
    """What a file is refused with, without its name."""
    with pytest.raises(BadInputError) as caught:
        load(path)
    text = str(caught.value)
    assert text.startswith(f"{path.name}: ") and "\n" not in text and len(text) < 400 and "; " in text
    return text.removeprefix(f"{path.name}: ")
