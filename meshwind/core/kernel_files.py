"""The files that keep compiled kernels for the next process.

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
from numba.core.compiler import CompileResult
from numba.misc.appdirs import AppDirs

from meshwind.core.kernel_library import KernelLibrary, is_transient
from meshwind.core.kernel_sources import sources

_PACKAGE = __name__.split(".")[0]
_DIGEST = hashlib.sha256().digest_size
_log = logging.getLogger(_PACKAGE)
_told: list[str] = []
"""What was said of the files' folder; it is said once."""


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
                result = _unpacked(pickle.loads(data), target_context)
            except (AttributeError, ImportError, pickle.UnpicklingError):
                continue  # a record or a function that it names has gone
            if result is not None:
                return result
        return None

    def _save_overload(self, sig: tuple[Any, ...], data: Any) -> None:
        if not self._enabled or not CompileResultCacheImpl.check_cachable(None, data):
            return
        if is_transient(sig):
            return
        codegen = data.codegen
        packed = pickle.dumps(data._reduce(), protocol=-1)
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
        compiler = [sources(f"{_PACKAGE}.core.{name}") for name in ("kernel", "kernel_library", "kernel_files")]
        key = (self._index_key(sig, codegen), numba.__version__, sources(self._py_func.__module__), *compiler)
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


def _unpacked(packed: tuple[Any, ...], target_context: Any) -> CompileResult | None:
    """What was compiled, out of `CompileResult._reduce`; None where a kernel that it calls is not what it was."""
    (
        kept, description, environment, signature, objectmode, lifted, annotation, reload_init, environments
    ) = packed  # fmt: skip
    codegen = target_context.codegen()
    library = KernelLibrary.unpacked(codegen, kept)
    if library is None:
        return None
    for function in reload_init:
        function()
    for each in environments:
        codegen.set_env(each.env_name, each)
    return CompileResult(
        target_context=target_context, typing_context=target_context.typing_context, library=library,
        environment=environment, entry_point=target_context.get_executable(library, description, environment),
        fndesc=description, type_annotation=annotation, signature=signature, objectmode=objectmode, lifted=lifted,
        typing_error=None, call_helper=None, metadata=None, reload_init=reload_init, referenced_envs=environments,
    )  # fmt: skip


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
