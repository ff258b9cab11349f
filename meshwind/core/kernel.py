"""Compiled kernels, and the files that keep them for the next process.

Numba's own files are safe for one process at a time only: it names the code of a kernel in an index before it writes
it, so that a process that is killed between the two, or another one that writes the same index, can leave a name for
the wrong code.  Here each kernel for each types of its arguments is one file without an index, which is written under
another name and then renamed.  It says from which sources it was compiled, those of the kernels that it calls
included, so that a change of any of them, or a damaged file, only means that it is compiled again.
"""

import hashlib
import logging
import os
import pickle
import sys
from collections.abc import Callable
from functools import lru_cache
from pathlib import Path
from tempfile import NamedTemporaryFile
from typing import Any

import numba
from numba.core import config
from numba.core.caching import CompileResultCacheImpl, FunctionCache
from numba.core.dispatcher import Dispatcher
from numba.misc.appdirs import AppDirs

_PACKAGE = __name__.split(".")[0]
_DIGEST = hashlib.sha256().digest_size
_log = logging.getLogger(_PACKAGE)
_told: list[str] = []
"""What was said of the files' folder; it is said once."""


def njit(**options: Any) -> Callable[[Callable[..., Any]], Any]:
    """As `numba.njit`, with files that any number of processes can write at a time where `cache` is true."""
    keep = options.pop("cache", False)

    def declare(function: Callable[..., Any]) -> Any:
        kernel: Any = numba.njit(**options)(function)
        if keep and hasattr(kernel, "enable_caching"):  # with NUMBA_DISABLE_JIT it is the function itself
            kernel._cache = KernelFiles(function)
        return kernel

    return declare


class KernelFiles(FunctionCache):  # type: ignore[misc]
    """The files of one kernel.  Nothing is looked up before it is called: most kernels of a run are not."""

    def __init__(self, py_func: Callable[..., Any]) -> None:
        self._py_func, self._name = py_func, repr(py_func)
        self.enable()

    @property
    def cache_path(self) -> str:
        """The folder that is written to first."""
        return str(folders(self._py_func.__code__.co_filename)[0])

    def flush(self) -> None:
        """Remove all files of the kernel."""
        for folder in folders(self._py_func.__code__.co_filename):
            for file in folder.glob(f"{self._stem}-*.nbc"):
                file.unlink(missing_ok=True)

    def holds(self, sig: tuple[Any, ...], codegen: Any) -> bool:
        """Whether there is a file for these types of the arguments, from the sources as they are."""
        return any(self._read(folder, sig, codegen, whole=False) is not None for folder in self._folders)

    def _load_overload(self, sig: tuple[Any, ...], target_context: Any) -> Any:
        if not self._enabled:
            return None
        for folder in self._folders:
            data = self._read(folder, sig, target_context.codegen())
            if not data:
                continue
            try:
                return CompileResultCacheImpl.rebuild(None, target_context, pickle.loads(data))
            except (AttributeError, ImportError, pickle.UnpicklingError):
                continue  # a record or a function that it names has gone
        return None

    def _save_overload(self, sig: tuple[Any, ...], data: Any) -> None:
        if not self._enabled or not CompileResultCacheImpl.check_cachable(None, data):
            return
        if " at 0x" in repr(sig):
            return  # a function among the arguments: its address means nothing in another process
        codegen = data.codegen
        packed = pickle.dumps(CompileResultCacheImpl.reduce(None, data), protocol=-1)
        whole = self._mark(sig, codegen) + hashlib.sha256(packed).digest() + packed
        reasons = []
        for folder in self._folders:
            try:
                _replace(folder / self._file(sig, codegen), whole)
            except OSError as error:
                reasons.append(f"{folder}: {error.strerror or error}")
            else:
                return
        _tell(reasons)

    @property
    def _folders(self) -> list[Path]:
        return folders(self._py_func.__code__.co_filename)

    @property
    def _stem(self) -> str:
        code = self._py_func.__code__
        return f"{Path(code.co_filename).stem}.{code.co_qualname if sys.version_info >= (3, 11) else code.co_name}"

    def _file(self, sig: tuple[Any, ...], codegen: Any) -> str:
        key = repr(self._index_key(sig, codegen)) + sys.implementation.cache_tag
        return f"{self._stem}-{hashlib.sha256(key.encode()).hexdigest()[:24]}.nbc"

    def _mark(self, sig: tuple[Any, ...], codegen: Any) -> bytes:
        """What the file is compiled from: its first bytes."""
        key = (self._index_key(sig, codegen), numba.__version__, sources(self._py_func.__module__))
        return hashlib.sha256(repr(key).encode()).digest()

    def _read(self, folder: Path, sig: tuple[Any, ...], codegen: Any, whole: bool = True) -> bytes | None:
        """The file's content, empty unless it is to be read whole; None where there is none that can be used."""
        try:
            with (folder / self._file(sig, codegen)).open("rb") as file:
                if file.read(_DIGEST) != self._mark(sig, codegen):
                    return None
                if not whole:
                    return b""
                digest, data = file.read(_DIGEST), file.read()
        except OSError:
            return None
        return data if hashlib.sha256(data).digest() == digest else None


def is_kept() -> bool:
    """Whether all that this process compiled could be written."""
    return not _told


@lru_cache
def folders(source: str) -> list[Path]:
    """Folders for the kernels of a source file, the first one first: all are read, the first possible is written.

    That of NUMBA_CACHE_DIR alone, if it is given; otherwise `__pycache__` beside the source, then the user's.
    """
    home = Path(source).resolve().parent
    apart = f"{home.name}_{hashlib.sha256(str(home).encode()).hexdigest()[:24]}"
    if config.CACHE_DIR:
        return [Path(config.CACHE_DIR) / apart]
    return [home / "__pycache__", Path(AppDirs(appname=_PACKAGE, appauthor=False).user_cache_dir) / apart]


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


def _replace(path: Path, content: bytes) -> None:
    """Write a file so that whoever reads it finds all of it or none."""
    path.parent.mkdir(parents=True, exist_ok=True)
    half = None
    try:
        with NamedTemporaryFile(dir=path.parent, prefix="half-", suffix=".nbc", delete=False) as file:
            half = file.name
            file.write(content)
        os.replace(half, path)
    except OSError:
        if half is not None:
            Path(half).unlink(missing_ok=True)
        raise


def _tell(reasons: list[str]) -> None:
    if not _told:
        _told.extend(reasons)
        _log.warning(
            "meshwind: warning: compiled kernels cannot be kept (%s), so every run compiles them; "
            "set NUMBA_CACHE_DIR to a folder that can be written", "; ".join(reasons)
        )  # fmt: skip
