"""The house rules that a reader relies on: imports go one way, heavy libraries come late, files stay short."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[1] / "meshwind"
ORDER = [
    "theory",
    "core",
    "mesh",
    "chart",
    "surface",
    "march",
    "path",
    "methods",
    "planning",
    "layup",
    "filament",
    "results",
    "appearance",
    "workflow",
    "editing",
    "exporting",
    "solving",
    "pictures",
    "program",
    "run",
    "studies",
    "cli",
    "__main__",
]
"""A package may import those before it, never those after it."""
OWN = "its own modules"
WITHIN = {
    "mesh": ["geometry", "walls", "repair", "io", "opening", OWN],
    "mesh.io": [
        "in_subprocess", "file_mesh", "text", "lines", "unused", "cells", "face_lists", "fields",
        "stl", "ply", "deck", "gltf", "threemf", "msh", "vtk", OWN,
    ],
    "surface": [OWN, "fitting"],
    "path": ["kernels", OWN],
    "program": [
        "blocks", "machine", "timing", "axes", "mandrel", "posts", "readback", "body", "track", "eye", "head", "clear",
        "faults", "stepping", "hollows", "travel", "work", "program", "rewinding", OWN,
    ],
}  # fmt: skip
"""The same for the packages within a package; what the package itself shows, its __init__, comes after all of them."""
LONGEST = 350
FILES = sorted(PACKAGE.rglob("*.py"))


def room(file: Path) -> str:
    """The package or module right below meshwind that a file belongs to."""
    return file.relative_to(PACKAGE).parts[0].removesuffix(".py")


def module(file: Path) -> str:
    """Name of the module in a file, without "meshwind."; that of a package for its __init__."""
    return ".".join(file.relative_to(PACKAGE).with_suffix("").parts).removesuffix("__init__").rstrip(".")


MODULES = {module(file): file for file in FILES}


def imported(file: Path) -> set[str]:
    """The modules of meshwind that a file imports at run time, without "meshwind."."""
    tree = ast.parse(file.read_text(encoding="utf-8"))
    skipped = {id(n) for t in ast.walk(tree) if isinstance(t, ast.If) and "TYPE_CHECKING" in ast.dump(t.test)
               for n in ast.walk(t)}  # fmt: skip
    names: set[str] = set()
    for node in ast.walk(tree):
        if id(node) in skipped:
            continue
        if isinstance(node, ast.ImportFrom) and node.module and node.module.split(".")[0] == "meshwind":
            package = node.module.removeprefix("meshwind").removeprefix(".")
            parts = {f"{package}.{alias.name}".removeprefix(".") for alias in node.names}
            names |= {part if part in MODULES else package for part in parts}
        elif isinstance(node, ast.Import):
            names |= {a.name.removeprefix("meshwind.") for a in node.names if a.name.startswith("meshwind.")}
    return names - {module(file)}


IMPORTS = {name: imported(file) for name, file in MODULES.items()}
INSIDE = [name for name in MODULES if name]
"""All modules but the one that shows the public names."""


@pytest.mark.parametrize("name", INSIDE)
def test_imports_go_one_way(name: str) -> None:
    here = ORDER.index(name.split(".")[0])
    for other in IMPORTS[name]:
        assert ORDER.index(other.split(".")[0]) <= here, f"{name} imports {other}"


def rank(package: str, name: str) -> int:
    """Place of a module in the order within a package."""
    first, order = name.removeprefix(package).removeprefix(".").split(".")[0], WITHIN[package]
    return len(order) if not first else order.index(first if first in order else OWN)


@pytest.mark.parametrize(("package", "name"), [
    (package, name) for package in WITHIN for name in INSIDE if f"{name}.".startswith(f"{package}.")
])  # fmt: skip
def test_imports_go_one_way_within_a_package(package: str, name: str) -> None:
    for other in IMPORTS[name]:
        if f"{other}.".startswith(f"{package}."):
            assert rank(package, other) <= rank(package, name), f"{name} imports {other}"


def test_packages_within_packages_have_an_order() -> None:
    within = {".".join(file.parent.relative_to(PACKAGE).parts) for file in FILES}
    ordered = {f"{package}.{name}" for package, names in WITHIN.items() for name in names}
    assert {name for name in within if "." in name} <= ordered
    assert all(f"{package}.{name}" in MODULES for package, names in WITHIN.items() for name in names if name != OWN)


def test_no_modules_import_each_other_in_a_circle() -> None:
    left = {name: set(IMPORTS[name]) for name in INSIDE}
    while free := {name for name, others in left.items() if not others & left.keys()}:
        left = {name: others for name, others in left.items() if name not in free}
    assert not left, f"circles among {sorted(left)}"


def test_every_room_has_its_place() -> None:
    assert {room(f) for f in FILES} - {"__init__"} == set(ORDER)


@pytest.mark.parametrize("file", FILES, ids=lambda f: str(f.relative_to(PACKAGE)))
def test_files_stay_short(file: Path) -> None:
    assert len(file.read_text(encoding="utf-8").splitlines()) <= LONGEST


@pytest.mark.parametrize("code", ["import meshwind", *(
    f"import sys; sys.argv = ['meshwind', {arguments}]\nfrom meshwind.cli import main\ntry:\n    main()\n"
    "except SystemExit:\n    pass"
    for arguments in ("'--help'", "'--version'", "'wind', '--help'", "'redesign', '--help'", "'export', '--help'",
                      "'render', '--help'", "'check', '--help'", "'info', '--help'", "'wind', '--paths', 'none'")
)], ids=lambda code: code.split("\n")[0].removeprefix("import sys; sys.argv = "))  # fmt: skip
def test_heavy_libraries_load_late(code: str) -> None:
    """What does not compute does not wait for what computes: help and version take as long as typer itself."""
    heavy = [
        "numpy",
        "numba",
        "scipy",
        "igl",
        "trimesh",
        "pyvista",
        "vtkmodules",
        "meshio",
        "matplotlib",
        "PIL",
        "clarabel",
        "h5py",
    ]
    code += f"\nimport sys\nprint([m for m in {heavy} if m in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[]"


def test_public_names_exist() -> None:
    import meshwind as mw

    for name in mw.__all__:
        assert getattr(mw, name) is not None
    # importing a module below meshwind sets its name there, in place of what the name should give
    assert not set(mw.__all__) & {room(file) for file in FILES}
    with pytest.raises(AttributeError, match="no attribute 'nonsense'"):
        _ = mw.nonsense
