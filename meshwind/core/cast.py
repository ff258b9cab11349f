"""Casts and checks of arrays that callers give; functions behind the public ones rely on them."""

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from meshwind.core.errors import BadInputError
from meshwind.core.parsing import shortened

Array: TypeAlias = NDArray[Any]
Floats: TypeAlias = NDArray[np.float64]
Ints: TypeAlias = NDArray[np.int64]
Bools: TypeAlias = NDArray[np.bool_]


def frozen(array: Array) -> Array:
    """Return a C-contiguous, read-only view or copy of `array`, as results are immutable."""
    view = np.ascontiguousarray(array).view()
    view.setflags(write=False)
    return view


def numbers(values: object, name: str, wanted: str = "an array of numbers") -> Floats:
    """Cast to float64 what holds numbers, be they finite or not."""
    try:
        return np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError):  # no numbers, or rows of different lengths
        raise BadInputError(f"{name} is {shortened(repr(values))}; give {wanted}") from None


def floats(values: ArrayLike, name: str, *shape: int) -> Floats:
    """Cast to a finite float64 array of the given shape, where -1 stands for any length."""
    array = np.ascontiguousarray(numbers(values, name, f"numbers of {_in_words(shape)}"))
    if array.ndim != len(shape) or any(want not in (-1, got) for want, got in zip(shape, array.shape, strict=True)):
        raise BadInputError(f"{name} has shape {array.shape}; give an array of {_in_words(shape)}")
    if np.count_nonzero(np.isfinite(array)) < array.size:
        raise BadInputError(f"{name} holds NaN or infinite values; remove them first")
    return array


def depth(values: ArrayLike, name: str) -> int:
    """The number of axes of what a caller gives."""
    try:
        return np.ndim(values)
    except ValueError:
        raise BadInputError(f"{name} has rows of different lengths; give an array of numbers") from None


def _in_words(shape: tuple[int, ...]) -> str:
    """A shape as NumPy writes it, with n for any length."""
    lengths = ["n" if want < 0 else str(want) for want in shape]
    return f"shape ({lengths[0]},)" if len(lengths) == 1 else f"shape ({', '.join(lengths)})"


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
