"""Numbers in glTF files: accessors, which say how bytes of the buffers become arrays (clause 3.6.2)."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from meshwind.core.cast import Floats, Ints
from meshwind.mesh.io.gltf.document import MESHOPT, Document, table, whole

_TYPES = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4", 5130: "<f8"}
"""Component types; the last one is that of KHR_accessor_float64."""
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
_MAX_ZEROS = 30_000_000
"""Numbers of an accessor without a buffer, which its file may announce at will."""
_MAX_NUMBERS = 1_000_000_000
"""Numbers of all accessors together: those of one buffer may be read again and again."""


class Accessors:
    """The accessors of a file."""

    def __init__(self, document: Document) -> None:
        self.document, self._read = document, 0
        self._values: dict[int, Floats] = {}

    def values(self, number: object, kind: str) -> Floats:
        """Numbers (count, width) of an accessor of a kind such as "VEC3", normalised where it says so (clause 3.11).

        Raises ValueError if it is of another kind, or its buffer does not hold them.
        """
        at = whole(number, "an accessor's number")
        accessor = self.document.entry("accessors", at)
        if accessor.get("type") != kind:
            raise ValueError(f"accessor {at} is {str(accessor.get('type'))[:20]}, where {kind} is needed")
        if at not in self._values:
            raw = self._raw(at)
            values = raw.astype(np.float64)
            if accessor.get("normalized") is True and raw.dtype.kind in "iu":
                values = np.maximum(values / np.iinfo(raw.dtype).max, -1.0)
            self._values[at] = values
        return self._values[at]

    def indices(self, number: object) -> Ints:
        """Whole numbers of an accessor of indices or joints, one row after the other."""
        at = whole(number, "an accessor's number")
        raw = self._raw(at)
        if raw.dtype.kind not in "iu":
            raise ValueError(f"accessor {at} holds decimal numbers, where indices are needed")
        return raw.astype(np.int64).ravel()

    def has_data(self, number: object) -> bool:
        """Whether an accessor's numbers are in the file, rather than left to an extension."""
        accessor = self.document.entry("accessors", number)
        return "bufferView" in accessor or "sparse" in accessor

    def _raw(self, number: int) -> NDArray[Any]:
        """Numbers as they are stored: zeros without a buffer, and sparse ones replaced (clause 3.6.2.3)."""
        accessor = self.document.entry("accessors", number)
        kind, width = _kind(accessor), _WIDTHS.get(str(accessor.get("type")), 0)
        count = whole(accessor.get("count"), f"the count of accessor {number}")
        if width == 0:
            raise ValueError(f"the type of accessor {number} is {str(accessor.get('type'))[:20]}")
        if "bufferView" in accessor:
            raw = self._rows(accessor, kind, (count, width))
        elif count * width <= _MAX_ZEROS:
            raw = np.zeros((count, width), dtype=kind)
        else:
            raise ValueError(f"accessor {number} announces {count * width} numbers that are not in the file")
        self._read += raw.size
        if self._read > _MAX_NUMBERS:
            raise ValueError(f"its accessors have more than {_MAX_NUMBERS} numbers together")
        if "sparse" not in accessor:
            return raw
        sparse = table(accessor["sparse"], "a sparse accessor")
        places, new = table(sparse.get("indices"), "its indices"), table(sparse.get("values"), "its values")
        replaced = whole(sparse.get("count"), "the count of a sparse accessor")
        rows = self._rows(places, _kind(places), (replaced, 1))[:, 0].astype(np.int64)
        if replaced and (rows.min() < 0 or rows.max() >= count):
            raise ValueError(f"accessor {number} replaces number {rows.max()} of {count}")
        raw = raw.copy()
        raw[rows] = self._rows(new, kind, (replaced, width))
        return raw

    def _rows(self, held: dict[str, Any], kind: np.dtype[Any], shape: tuple[int, int]) -> NDArray[Any]:
        """Numbers in a view of a buffer, whose rows may lie apart (byteStride)."""
        view = self.document.entry("bufferViews", held.get("bufferView"))
        for extension in MESHOPT:
            if extension in self.document.extensions(view) and not self.document.has_content(view.get("buffer")):
                self.document.compressed(extension)
        buffer = self.document.buffer(view.get("buffer"))
        offset = whole(held.get("byteOffset", 0), "an offset")
        start, size = whole(view.get("byteOffset", 0), "an offset"), whole(view.get("byteLength"), "a view's length")
        row = kind.itemsize * shape[1]
        stride = whole(view.get("byteStride", row), "a stride") or row
        if stride < row:
            raise ValueError(f"a view's rows are {stride} bytes apart, and {row} bytes long")
        end = offset + (shape[0] - 1) * stride + row if shape[0] else 0
        if end > size:
            raise ValueError(f"an accessor needs {end} bytes of a view of {size}")
        if start + size > len(buffer):
            raise ValueError(f"a view reaches to byte {start + size} of a buffer of {len(buffer)}")
        if shape[0] == 0:
            return np.empty(shape, dtype=kind)
        part = np.frombuffer(buffer, dtype=np.uint8, count=end - offset, offset=start + offset)
        rows = np.lib.stride_tricks.as_strided(part, (shape[0], row), (stride, 1))
        return np.ascontiguousarray(rows).view(kind).reshape(shape)


def _kind(held: dict[str, Any]) -> np.dtype[Any]:
    code = held.get("componentType")
    if not isinstance(code, int | float) or code not in _TYPES:
        raise ValueError(f"a component type is {str(code)[:20]}, which glTF does not know")
    return np.dtype(_TYPES[int(code)])
