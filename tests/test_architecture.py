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
    "appearance",
    "results",
    "workflow",
    "editing",
    "export",
    "pictures",
    "run",
    "sweep",
    "cli",
    "__main__",
]
"""Whatever stands later may import what stands earlier, never the other way round."""
LONGEST = 350
FILES = sorted(PACKAGE.rglob("*.py"))


def room(file: Path) -> str:
    """The package or module right below meshwind that a file belongs to."""
    return file.relative_to(PACKAGE).parts[0].removesuffix(".py")


def imported(tree: ast.AST) -> set[str]:
    """Names of meshwind's rooms that a module imports at run time."""
    skipped = {id(n) for t in ast.walk(tree) if isinstance(t, ast.If) and "TYPE_CHECKING" in ast.dump(t.test)
               for n in ast.walk(t)}  # fmt: skip
    names: set[str] = set()
    for node in ast.walk(tree):
        if id(node) in skipped:
            continue
        if isinstance(node, ast.ImportFrom) and node.module and node.module.startswith("meshwind"):
            parts = node.module.split(".")
            names |= {parts[1]} if len(parts) > 1 else {alias.name for alias in node.names}
        elif isinstance(node, ast.Import):
            names |= {a.name.split(".")[1] for a in node.names if a.name.startswith("meshwind.")}
    return names


@pytest.mark.parametrize("file", [f for f in FILES if room(f) != "__init__"], ids=lambda f: str(f.relative_to(PACKAGE)))
def test_imports_go_one_way(file: Path) -> None:
    here = ORDER.index(room(file))
    for name in imported(ast.parse(file.read_text(encoding="utf-8"))):
        assert ORDER.index(name) <= here, f"{file.name} imports {name}"


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
        "osqp",
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
