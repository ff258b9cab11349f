"""Scenes with their pages and files, packed for the process that draws.

Importing this module loads nothing heavy, as both processes need it.
"""

import io
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, is_dataclass
from pathlib import Path
from types import NoneType, UnionType
from typing import Any, get_args, get_origin, get_type_hints

import numpy as np
from numpy.typing import NDArray

from meshwind.pictures.page import Page
from meshwind.pictures.scenes import Scene

_KINDS: dict[str, type[Any]] = {kind.__name__: kind for kind in get_args(Scene)}


@dataclass(frozen=True)
class Drawing:
    """A scene and the page to draw it on."""

    scene: Scene
    page: Page = field(default_factory=Page)


def pack(file: Path, drawing: Drawing) -> bytes:
    """A drawing and its file as an .npz whose arrays are named picture, page/width, scene/part/points, ..."""
    packed = io.BytesIO()
    np.savez(packed, picture=str(file.absolute()), kind=type(drawing.scene).__name__, **_arrays(drawing))
    return packed.getvalue()


def unpack(packed: bytes) -> tuple[Path, Drawing]:
    """The drawing that was packed, and its file."""
    with np.load(io.BytesIO(packed)) as held:
        arrays = dict(held)
    scene = _record(_KINDS[str(arrays["kind"])], _below(arrays, "scene"))
    return Path(str(arrays["picture"])), Drawing(scene, _record(Page, _below(arrays, "page")))


def save(image: Any, file: Path) -> None:
    """Write an image as a .png, quickly rather than small."""
    image.save(str(file), compress_level=1)


def _arrays(record: Any) -> dict[str, Any]:
    """Fields of a record, and of records in it, that are not None, as arrays."""
    arrays: dict[str, Any] = {}
    for each in fields(record):
        value = getattr(record, each.name)
        if is_dataclass(value):
            arrays |= {f"{each.name}/{name}": array for name, array in _arrays(value).items()}
        elif value is not None:
            arrays[each.name] = np.asarray(value)
    return arrays


def _record(kind: type[Any], arrays: Mapping[str, NDArray[Any]]) -> Any:
    """A record of the given kind from the arrays of its fields."""
    hints = get_type_hints(kind)
    return kind(**{each.name: _value(hints[each.name], each.name, arrays) for each in fields(kind)})


def _value(hint: Any, name: str, arrays: Mapping[str, NDArray[Any]]) -> Any:
    """Value of a field by its type: a record, a plain value, a tuple or an array; None if it has no arrays."""
    kind = next(part for part in get_args(hint) if part is not NoneType) if isinstance(hint, UnionType) else hint
    if is_dataclass(kind):
        below = _below(arrays, name)
        return _record(kind, below) if below else None  # type: ignore[arg-type]
    if name not in arrays:
        return None
    if get_origin(kind) is tuple:
        return tuple(arrays[name].tolist())
    return kind(arrays[name].item()) if kind in (str, int, float, bool) else arrays[name]


def _below(arrays: Mapping[str, NDArray[Any]], name: str) -> dict[str, NDArray[Any]]:
    """Arrays whose names start with the given one, by the rest of their names."""
    return {key.removeprefix(f"{name}/"): array for key, array in arrays.items() if key.startswith(f"{name}/")}
