"""What a run imports: a plain winding waits for nothing that only other runs need."""

import subprocess
import sys
from pathlib import Path

import pytest

from meshwind.pictures import renderer

ROOT = Path(__file__).parents[1]
OTHERS = (
    "meshwind.editing.redesign", "meshwind.exporting", "meshwind.filament.closing", "meshwind.filament.laminate",
    "meshwind.march", "meshwind.mesh.io.deck", "meshwind.mesh.io.gltf", "meshwind.mesh.io.msh", "meshwind.mesh.io.stl",
    "meshwind.mesh.io.vtk", "meshwind.planning.alternatives", "meshwind.planning.revolutions", "meshwind.program",
    "meshwind.workflow.helices", "meshwind.workflow.layers", "scipy.integrate", "scipy.ndimage",
    "clarabel", "h5py", "meshio", "pandas", "trimesh",
)  # fmt: skip
"""What a plain winding of a PLY file never needs."""
DRAWING = "meshwind.pictures.gallery", "meshwind.pictures.render", "meshwind.pictures.subject", "meshwind.run.drawing"
"""What only drawing needs, in the process that computes."""
HEAVY = "PIL", "matplotlib", "pyvista"
"""What only drawing needs: the process that computes draws curves and charts itself, while the other draws parts."""


def within(names: set[str], packages: tuple[str, ...]) -> list[str]:
    """The packages that any of the modules is or is in."""
    return [package for package in packages if any(f"{name}.".startswith(f"{package}.") for name in names)]


def imported(code: str) -> set[str]:
    """Names of the modules that a process has imported when it has run some code."""
    code = f"import sys\n{code}\nprint(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=ROOT)
    return set(done.stdout.splitlines()[-1].split())


def wound(out: Path, *options: str) -> set[str]:
    """Names of the modules that a small winding imports."""
    given = ["meshwind", "wind", "data/tank.ply", "--paths", "3", "--particles", "51", "--out", str(out), *options]
    return imported(
        f"sys.argv = {given}\nfrom meshwind.cli import main\ntry:\n    main()\nexcept SystemExit as end:\n"
        "    assert not end.code"
    )


def test_a_plain_winding_imports_only_what_it_needs(tmp_path: Path) -> None:
    names = wound(tmp_path / "out", "--no-render")
    assert "meshwind.path.solve" in names
    assert within(names, (*OTHERS, *DRAWING, *HEAVY)) == []


@pytest.mark.usefixtures("opengl")
def test_a_winding_with_pictures_leaves_parts_to_the_other_process(tmp_path: Path) -> None:
    names = wound(tmp_path / "out")
    assert (tmp_path / "out" / "sheet.png").is_file()
    assert "meshwind.run.drawing" in names
    assert within(names, (*OTHERS, "pyvista")) == []


def test_the_process_that_draws_does_not_wait_for_what_computes() -> None:
    names = imported(f"import runpy\nrunpy.run_path({renderer.__file__!r})")
    assert "meshwind.pictures.winding_picture" in names
    assert within(names, ("numba", "scipy", "igl", "matplotlib.figure", "meshwind.path", "meshwind.surface")) == []
