"""The chart as an image: PNG with 16 bits per channel, or an array in NPZ."""

from __future__ import annotations

import struct
import zlib
from pathlib import Path
from typing import Any
from zipfile import BadZipFile

import numpy as np
from numpy.typing import ArrayLike, NDArray

from meshwind.core.cast import Floats, floats
from meshwind.core.checks import path_given
from meshwind.core.errors import BadInputError
from meshwind.surface.image import from_image, surface_image
from meshwind.surface.surface import Surface

LEVELS = 65535
LOW, HIGH, UNITS = "meshwind XYZ min", "meshwind XYZ max", "meshwind units"
"""Text entries of the PNG: the x, y and z, in the mesh's units, of a channel's darkest and lightest level, and
that unit's name."""
PIXELS, LEAST, MOST = 2, 256, 2048
"""Pixels per span, and bounds: the spline between pixels is then known to more than 16 bits."""


def write_chart_image(path: Path, surface: Surface, units: str = "") -> None:
    """Write the surface as an image, two pixels per span: PNG to 1/65535 of the part's size, or NPZ in full."""
    width, height = (int(np.clip(PIXELS * spans, LEAST, MOST)) for spans in surface.spans)
    write_image(path, surface_image(surface, width, height), units)


def write_image(path: Path, image: ArrayLike, units: str = "") -> None:
    """Write an image (height, width, 3) of a surface: .png in 16 bits, .npz in full precision; units: of its lengths.

    Rows of the array are rows of the picture from the top.  Raises BadInputError for any other file name extension.
    """
    path = Path(path)
    pixels = floats(image, "image", -1, -1, 3)
    if _kind(path) == ".npz":
        with path.open("wb") as file:
            np.savez(file, image=pixels)
        return
    low, high = pixels.min(axis=(0, 1)), pixels.max(axis=(0, 1))
    scale = np.where(high > low, high - low, 1.0)
    levels = np.rint((pixels - low) / scale * LEVELS).astype(np.uint16)
    texts = {key: " ".join(repr(float(x)) for x in corner) for key, corner in ((LOW, low), (HIGH, high))}
    _write_png(path, levels, texts | ({UNITS: units} if units else {}))


def read_image(path: str | Path) -> Surface:
    """Read the surface from an image file of a run.

    A PNG holds each coordinate to 1/131070 of the part's range: enough to show and to exchange a shape, but its
    curvature is rough.  Wind from an NPZ file, which holds the numbers in full.

    Parameters
    ----------
    path : str or Path
        File `chart.png` of a run, or an .npz file that holds the same image as array `image`.

    Returns
    -------
    Surface
        Surface, periodic in u, in the unit of the run's mesh.

    Raises
    ------
    BadInputError
        If the file cannot be read or holds no such image.

    See Also
    --------
    from_image : The same from an array.

    Examples
    --------
    >>> import meshwind as mw
    >>> import numpy as np
    >>> result = mw.wind("data/elbow.obj", paths=3, particles=51, out="out", render=False)
    >>> surface = mw.read_image("out/chart.png")
    >>> uv = [(0.1, 0.2), (0.6, 0.7)]
    >>> np.allclose(surface.points(uv), result.surface.points(uv), atol=1e-3 * surface.size)
    True
    """
    path = path_given(path, "path", "file of an image")
    if not path.is_file():
        raise BadInputError(f"{path}: there is no such file")
    return from_image(_numbers(path) if _kind(path) == ".npz" else _colours(path))


def _kind(path: Path) -> str:
    kind = path.suffix.lower()
    if kind not in (".png", ".npz"):
        raise BadInputError(f"{path.name}: an image of a surface ends in .png or .npz; choose one of them")
    return kind


def _numbers(path: Path) -> Floats:
    try:
        with np.load(path) as held:
            return np.asarray(held["image"], dtype=np.float64)
    except (OSError, EOFError, ValueError, KeyError, BadZipFile) as error:
        raise BadInputError(f"{path.name}: holds no array 'image'; write it again from its surface") from error


def _colours(path: Path) -> Floats:
    levels, texts = _read_png(path)
    if levels.dtype != np.uint16 or levels.ndim != 3 or levels.shape[2] != 3:
        raise BadInputError(f"{path.name}: is no PNG with 3 channels of 16 bits; write it again from its surface")
    low, high = _corner(path, texts, LOW), _corner(path, texts, HIGH)
    return np.asarray(low + levels / LEVELS * (high - low))


def _corner(path: Path, texts: dict[str, str], key: str) -> Floats:
    try:
        return floats([float(word) for word in texts[key].split()], key, 3)
    except (KeyError, ValueError) as error:
        raise BadInputError(
            f"{path.name}: its text entry '{key}' does not hold three numbers; write it again from its surface"
        ) from error


def _write_png(path: Path, levels: NDArray[np.uint16], texts: dict[str, str]) -> None:
    from vtkmodules.util import numpy_support
    from vtkmodules.vtkCommonDataModel import vtkImageData
    from vtkmodules.vtkIOImage import vtkPNGWriter

    height, width = levels.shape[:2]
    convert: Any = numpy_support.numpy_to_vtk
    picture = vtkImageData()
    picture.SetDimensions(width, height, 1)
    picture.GetPointData().SetScalars(convert(_upside_down(levels).reshape(-1, 3), deep=True))
    writer = vtkPNGWriter()
    writer.WriteToMemoryOn()  # VTK itself does not report a full disk
    writer.SetInputData(picture)
    for key, text in texts.items():
        writer.AddText(key, text)
    writer.Write()
    if writer.GetErrorCode():
        raise OSError(f"VTK could not write {path.name}")
    back: Any = numpy_support.vtk_to_numpy
    path.write_bytes(back(writer.GetResult()).tobytes())


def _read_png(path: Path) -> tuple[NDArray[Any], dict[str, str]]:
    """Levels (height, width, channels) and the text entries."""
    from vtkmodules.util import numpy_support
    from vtkmodules.vtkIOImage import vtkPNGReader

    texts = _checked(path)
    reader = vtkPNGReader()
    reader.SetFileName(str(path))
    reader.Update()
    width, height, _ = reader.GetOutput().GetDimensions()
    convert: Any = numpy_support.vtk_to_numpy
    levels = convert(reader.GetOutput().GetPointData().GetScalars())
    return _upside_down(levels.reshape(height, width, -1)), texts


def _checked(path: Path) -> dict[str, str]:
    """Text entries of a PNG, checked to be complete: VTK crashes on truncated files, Pillow drops half the bits."""
    from PIL import Image

    try:
        with Image.open(path, formats=["PNG"]) as picture:
            picture.verify()
        with Image.open(path, formats=["PNG"]) as picture:
            picture.load()
            return {key: text for key, text in picture.info.items() if isinstance(text, str)}
    except (
        OSError,
        EOFError,
        SyntaxError,
        ValueError,
        struct.error,
        zlib.error,
        Image.DecompressionBombError,
    ) as error:
        raise BadInputError(f"{path.name}: is damaged or no PNG; write it again from its surface") from error


def _upside_down(rows: NDArray[Any]) -> NDArray[Any]:
    """Rows in reverse order: VTK counts them from the bottom, pictures and arrays from the top."""
    return np.ascontiguousarray(rows[::-1])
