"""What a kernel is compiled from: its module's source, and all that it takes from others."""

import hashlib
import sys
from functools import lru_cache
from pathlib import Path

from numba.core.dispatcher import Dispatcher

_PACKAGE = __name__.split(".")[0]


@lru_cache
def sources(module: str) -> str:
    """Digest of the source files of a module and of those whose kernels or records it takes, and so on.

    The numbers that these modules take from others count as well: they are part of the code.
    """
    names, left = {module}, [module]
    while left:
        for value in list(vars(sys.modules[left.pop()]).values()):
            if isinstance(value, Dispatcher):
                home = value.py_func.__module__
            elif isinstance(value, type) and issubclass(value, tuple):
                home = value.__module__
            else:
                continue
            if home.split(".")[0] == _PACKAGE and home not in names:
                names.add(home)
                left.append(home)
    return hashlib.sha256("".join(_source(name) + _numbers(name) for name in sorted(names)).encode()).hexdigest()


@lru_cache
def _numbers(module: str) -> str:
    """The numbers, texts and tuples of them among the names of a module."""
    held = vars(sys.modules[module]).items()
    return repr(sorted((name, repr(value)) for name, value in held if _is_plain(value) and not name.startswith("__")))


def _is_plain(value: object) -> bool:
    if type(value) is tuple:
        return all(_is_plain(each) for each in value)
    return isinstance(value, int | float | complex | str) and type(value).__module__ == "builtins"


@lru_cache
def _source(module: str) -> str:
    """Name of a module and digest of its source."""
    file = sys.modules[module].__file__
    try:
        text = Path(file).read_bytes() if file else b""
    except OSError:  # in an archive: its kernels change with the version
        text = b""
    return f"{module} {hashlib.sha256(text).hexdigest()} "
