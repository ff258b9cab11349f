"""Casts and checks of arrays that callers give; functions behind the public ones rely on them."""

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from meshwind.core.errors import BadInputError

Array: TypeAlias = NDArray[Any]
Floats: TypeAlias = NDArray[np.float64]
Ints: TypeAlias = NDArray[np.int64]
Bools: TypeAlias = NDArray[np.bool_]


def frozen(array: Array) -> Array:
    """Return a C-contiguous, read-only view or copy of `array`, as results are immutable."""
    view = np.ascontiguousarray(array).view()
    view.setflags(write=False)
    return view


def floats(values: ArrayLike, name: str, *shape: int) -> Floats:
    """Cast to a finite float64 array of the given shape, where -1 stands for any length."""
    array = np.ascontiguousarray(values, dtype=np.float64)
    if array.ndim != len(shape) or any(want not in (-1, got) for want, got in zip(shape, array.shape, strict=True)):
        wanted = ", ".join("n" if want < 0 else str(want) for want in shape)
        raise BadInputError(f"{name} has shape {array.shape}; give an array of shape ({wanted})")
    if np.count_nonzero(np.isfinite(array)) < array.size:
        raise BadInputError(f"{name} holds NaN or infinite values; remove them first")
    return array


def ints(values: ArrayLike, name: str, *shape: int) -> Ints:
    """Cast to an int64 array of the given shape, where -1 stands for any length."""
    return floats(values, name, *shape).astype(np.int64)


class PicklableRecord:
    """Base of frozen dataclasses that are pickled: arrays stay read-only, cached properties are left out.

    Kernels are compiled for read-only arrays, and would be compiled again for others.
    """

    def __getstate__(self) -> dict[str, Any]:
        return {name: self.__dict__[name] for name in self.__dataclass_fields__}  # type: ignore[attr-defined]

    def __setstate__(self, state: dict[str, Any]) -> None:
        for value in state.values():
            if isinstance(value, np.ndarray):
                value.flags.writeable = False
        self.__dict__.update(state)
