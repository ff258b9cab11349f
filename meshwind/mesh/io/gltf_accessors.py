"""Numbers in glTF files: accessors, which say how bytes of the buffers become arrays (section 3.6.2)."""

from typing import Any

import numpy as np

from meshwind.core.cast import Floats

_TYPES = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
_MAX_NUMBERS = 300_000_000


class Accessors:
    """The accessors of a file with the contents of its buffers."""

    def __init__(self, scene: dict[str, Any], buffers: list[bytes]) -> None:
        self.scene, self.buffers = scene, buffers

    def values(self, number: int) -> Floats:
        """Numbers (count, width) of an accessor: normalised where it says so, zeros without data, sparse ones set.

        Raises ValueError if its buffer does not hold them.
        """
        accessor = self.scene["accessors"][number]
        kind, count = np.dtype(_TYPES[accessor["componentType"]]), int(accessor["count"])
        width = _WIDTHS[accessor["type"]]
        if count < 0 or count * width > _MAX_NUMBERS:
            raise ValueError("an accessor has too many numbers")
        if "bufferView" in accessor:
            raw = self._table(accessor["bufferView"], accessor.get("byteOffset", 0), kind, (count, width))
        else:
            raw = np.zeros((count, width), dtype=kind)
        sparse = accessor.get("sparse")
        if sparse is not None:
            raw = self._with_sparse(raw, sparse)
        values = raw.astype(np.float64)
        if accessor.get("normalized") and kind.kind in "iu":
            values = np.maximum(values / np.iinfo(kind).max, -1.0)  # section 3.11
        return values

    def _with_sparse(self, raw: Any, sparse: dict[str, Any]) -> Any:
        """The numbers with some of them replaced."""
        count, at, new = int(sparse["count"]), sparse["indices"], sparse["values"]
        if not 0 <= count <= len(raw):
            raise ValueError("a sparse accessor replaces more than there is")
        kind = np.dtype(_TYPES[at["componentType"]])
        rows = self._table(at["bufferView"], at.get("byteOffset", 0), kind, (count, 1))[:, 0].astype(np.int64)
        if count and rows.max() >= len(raw):
            raise ValueError("a sparse accessor replaces what is not there")
        raw = raw.copy()
        raw[rows] = self._table(new["bufferView"], new.get("byteOffset", 0), raw.dtype, (count, raw.shape[1]))
        return raw

    def _table(self, view: int, offset: int, kind: Any, shape: tuple[int, int]) -> Any:
        """Numbers of a view of a buffer, whose rows may lie apart (byteStride)."""
        held = self.scene["bufferViews"][view]
        buffer = self.buffers[held["buffer"]]
        start, size = int(held.get("byteOffset", 0)), int(held["byteLength"])
        row = kind.itemsize * shape[1]
        stride = int(held.get("byteStride", 0)) or row
        end = int(offset) + (shape[0] - 1) * stride + row if shape[0] else 0
        if min(start, size, offset) < 0 or stride < row or start + size > len(buffer) or end > size:
            raise ValueError("an accessor reaches beyond its buffer")
        if shape[0] == 0:
            return np.empty(shape, dtype=kind)
        part = np.frombuffer(buffer, dtype=np.uint8, count=end - offset, offset=start + offset)
        rows = np.lib.stride_tricks.as_strided(part, (shape[0], row), (stride, 1))
        return np.ascontiguousarray(rows).view(kind).reshape(shape)
