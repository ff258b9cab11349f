"""Compiled kernels: how they are declared, and what of each is compiled.

Most of the time that a new user waits is Numba's, and most of that is spent on code that nothing calls:

- Python calls a kernel through a wrapper that unpacks each array of each record.  Kernels without `nogil` are called by
  other kernels, so they get one only where Python calls them all the same.
- Numba takes the code of all that a kernel calls, however deep, into the kernel's own, so that what lies at the bottom
  is compiled once more for each kernel above it.  Here only short ones are taken in (`meshwind.core.kernel_library`).
- It compiles a function for `0` and for `int64` apart.  Here it is compiled for the latter.
"""

from collections.abc import Callable
from functools import cached_property
from typing import Any

import numba
from numba.core.compiler import Flags
from numba.core.dispatcher import _FunctionCompiler  # type: ignore[attr-defined]
from numba.core.registry import CPUDispatcher
from numba.core.types import Literal, unliteral  # type: ignore[attr-defined]

from meshwind.core.kernel_files import KernelFiles
from meshwind.core.kernel_library import KernelCompiler


def njit(nogil: bool = False, cache: bool = False, **options: Any) -> Callable[[Callable[..., Any]], Any]:
    """As `numba.njit`, for kernels that Python calls (nogil) and for those that kernels call (others).

    cache: keep what is compiled in files, which any number of processes can write at a time.  The others of Numba's
    options are taken as they are.
    """

    def declare(function: Callable[..., Any]) -> Any:
        if numba.config.DISABLE_JIT:
            return function
        kernel = Kernel(function, targetoptions=dict(options, nogil=nogil, nopython=True, boundscheck=None))
        if cache:
            kernel._cache = KernelFiles(function)
        return kernel

    return declare


class _Flags(Flags):  # type: ignore[misc]
    """Flags that are found and compared at once: Numba looks itself up by them at each operator of a kernel.

    Its own hash is that of the names of all flags, which it sorts each time: the same for all.
    """

    _HASH = hash(Flags())

    def __hash__(self) -> int:
        return self._HASH

    def __eq__(self, other: object) -> Any:
        return (isinstance(other, Flags) and self._values == other._values) or super().__eq__(other)


class _Types(_FunctionCompiler):  # type: ignore[misc]
    """What a kernel is compiled for."""

    def fold_argument_types(self, args: Any, kws: Any) -> tuple[Any, tuple[Any, ...]]:
        """The types of the arguments: those of literals are those of their values."""
        signature, folded = super().fold_argument_types(args, kws)
        return signature, tuple(unliteral(each) if isinstance(each, Literal) else each for each in folded)

    def _customize_flags(self, flags: Any) -> Any:
        flags = _Flags(flags)
        flags.no_cfunc_wrapper = True
        flags.no_cpython_wrapper = not self.targetoptions["nogil"]
        return flags


class Kernel(CPUDispatcher):  # type: ignore[misc]
    """A compiled function."""

    def __init__(self, py_func: Callable[..., Any], locals: Any = None, targetoptions: Any = None) -> None:
        super().__init__(py_func, locals, targetoptions, KernelCompiler)
        self._compiler = _Types(py_func, self.targetdescr, self.targetoptions, self.locals, KernelCompiler)

    def add_overload(self, result: Any) -> None:
        """Take in what was compiled or loaded."""
        if self.targetoptions["nogil"]:
            super().add_overload(result)
        else:
            self.overloads[tuple(result.signature.args)] = result  # not told to the calls of Python

    def _compile_for_args(self, *args: Any, **named: Any) -> Any:
        """What Python calls for these arguments, which no code for calls of Python fits yet."""
        if self.targetoptions["nogil"]:
            return super()._compile_for_args(*args, **named)
        self._compilation_chain_init_hook()
        kinds = tuple(self.typeof_pyval(each) for each in args)
        entry = self._door.compile(kinds)
        self._insert([each._code for each in kinds], entry, False)
        return entry

    @cached_property
    def _door(self) -> "Kernel":
        """A kernel that calls this one and can be called by Python."""
        names = ", ".join(self._compiler.pysig.parameters)
        through = eval(f"lambda {names}: kernel({names})", {"kernel": self, "__name__": __name__})
        return Kernel(through, targetoptions=dict(self.targetoptions, nogil=True))
