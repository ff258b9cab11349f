"""The machine code of one kernel, which finds that of the kernels that it calls by their names."""

import hashlib
import sys
from importlib import import_module
from typing import Any, NamedTuple

import llvmlite.binding as llvm
from numba.core.caching import NullCache
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.compiler_machinery import LoweringPass, register_pass
from numba.core.registry import CPUDispatcher
from numba.core.typed_passes import IRLegalization

from meshwind.core.kernel_sources import sources

SHORT = 200
"""Instructions up to which a kernel is taken into those that call it; LLVM would not put longer ones in place."""


class Origin(NamedTuple):
    """Where a kernel is found: its module and name there, and the types of its arguments."""

    module: str
    name: str
    types: tuple[Any, ...]

    def library(self) -> "KernelLibrary":
        """The code of the kernel, loaded or compiled where it is not there yet."""
        kernel = getattr(import_module(self.module), self.name)
        kernel.compile(self.types)
        library: KernelLibrary = kernel.overloads[self.types].library
        return library


_NAMED: set[Origin] = set()
"""What this process holds the code of under the name that it has in files."""


class KernelLibrary(JITCodeLibrary):  # type: ignore[misc]
    """Code of a kernel.

    origin: where the kernel is found again; None for one without files, whose code is taken into that of its callers;
    apart: libraries of the kernels whose code is not in here; symbols: names of the functions that others can call;
    instructions: those of the functions without the wrapper for Python.
    """

    def __init__(self, codegen: Any, name: str, origin: Origin | None = None) -> None:
        super().__init__(codegen, name)
        self.origin = origin
        self.apart: list[KernelLibrary] = []
        self.symbols: tuple[str, ...] = ()
        self.instructions = 0
        self._bitcode = b""
        self._shared_module: Any = None
        self.enable_object_caching()

    def finalize(self) -> None:
        """Take in the short kernels that are called, optimise, and compile."""
        self._raise_if_finalized()
        for library in dict.fromkeys(self._linking_libraries):
            self._reload_init.update(library._reload_init)
            if isinstance(library, KernelLibrary):
                if library.origin is not None and library.instructions > SHORT:
                    self._leave_apart([library])
                    continue
                self._leave_apart(library.apart)
            self._final_module.link_in(library._get_module_for_linking(), preserve=True)
        self._optimize_final_module()
        self._final_module.verify()
        self._finalize_final_module()
        own = [each for each in self._final_module.functions if each.linkage == llvm.Linkage.external]
        own = [each for each in own if not each.is_declaration]
        self.symbols = tuple(each.name for each in own)
        self.instructions = sum(
            len(list(block.instructions)) for each in own if not each.name.startswith(_WRAPPER) for block in each.blocks
        )

    def _optimize_functions(self, ll_module: Any) -> None:
        """Leave each function to the passes over the whole module, which do the same again."""
        ll_module.data_layout = self._codegen._data_layout

    def serialize_using_object_code(self) -> tuple[Any, ...]:
        """What `unpacked` makes the library of; code that is never taken in is kept as machine code alone."""
        code = b"" if self.instructions > SHORT else self._get_module_for_linking().as_bitcode()
        apart = tuple((each.origin, each.symbols) for each in self.apart)
        return self.name, self.origin, apart, self.symbols, self.instructions, self._get_compiled_object(), code

    @classmethod
    def unpacked(cls, codegen: Any, packed: tuple[Any, ...]) -> "KernelLibrary | None":
        """A library out of a file; None where a kernel that it calls has another name now, or another has its name."""
        name, origin, apart, symbols, instructions, machine_code, bitcode = packed
        if origin in _NAMED:
            return None
        self = cls(codegen, name, origin)
        for other, named in apart:
            library = other.library()
            if library.symbols != named:
                return None
            self.apart.append(library)
        self.symbols, self.instructions, self._bitcode = symbols, instructions, bitcode
        self._set_compiled_object(machine_code)
        self._finalize_final_module()
        codegen._engine._defined_symbols.update(symbols)
        _NAMED.add(origin)
        return self

    def _leave_apart(self, libraries: "list[KernelLibrary]") -> None:
        self.apart += [each for each in libraries if each not in self.apart]

    def _get_module_for_linking(self) -> Any:
        if self._shared_module is None and self._bitcode:
            self._shared_module = llvm.parse_bitcode(self._bitcode)
        return super()._get_module_for_linking()


_WRAPPER = "_ZN7cpython"
"""How the names of Numba's wrappers for Python begin."""


class KernelCompiler(CompilerBase):  # type: ignore[misc]
    """Numba's compiler, with libraries of kernels, whose names are the same in all processes."""

    def define_pipelines(self) -> list[Any]:
        """The passes."""
        origin = _origin(self.state)
        if origin is not None and origin not in _NAMED:
            key = repr((origin.module, origin.name, sources(origin.module)))
            function = self.state.func_id
            function.unique_id = int(hashlib.sha256(key.encode()).hexdigest()[:12], 16)
            function.unique_name = f"{function.func_qualname}${function.unique_id}"
        passes = DefaultPassBuilder.define_nopython_pipeline(self.state)
        passes.add_pass_after(_Library, IRLegalization)
        passes.finalize()
        return [passes]


@register_pass(mutates_CFG=False, analysis_only=False)
class _Library(LoweringPass):  # type: ignore[misc]
    """Have the code lowered into a library of ours."""

    _name = "kernel_library"

    def __init__(self) -> None:
        super().__init__()

    def run_pass(self, state: Any) -> bool:
        origin = _origin(state)
        if origin is not None:
            _NAMED.add(origin)
        state.library = KernelLibrary(state.targetctx.codegen(), state.func_id.func_qualname, origin)
        return True


def is_transient(types: tuple[Any, ...]) -> bool:
    """Whether one of the arguments is a function: its address means nothing in another process."""
    return " at 0x" in repr(types)


def _origin(state: Any) -> Origin | None:
    """Where the kernel that is compiled is found again; None where it is not, or has no files."""
    function: Any = state.func_id.func
    module = sys.modules.get(function.__module__)
    kernel: Any = vars(module).get(function.__name__) if module is not None else None
    if not isinstance(kernel, CPUDispatcher) or kernel.py_func is not function or isinstance(kernel._cache, NullCache):
        return None
    if is_transient(state.args):
        return None
    return Origin(function.__module__, function.__name__, tuple(state.args))
