"""Malformed files end in a mesh or in one line: no crash, no hang, nothing printed, and no other file is touched."""

import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from hostile_files import EDITS, FORMATS, MALICIOUS, OUTSIDE, changed, corpus, sound
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from meshwind.core.errors import BadInputError
from meshwind.mesh import Mesh, read
from meshwind.mesh.io.scalars import read_scalars

FILES = {name: (suffix, content) for name, suffix, content in corpus()}
PATIENCE = 60.0
UNIT = st.floats(0.0, 1.0, exclude_max=True)


def tried(path: Path) -> bool:
    """Whether a file gives a mesh; it may instead be refused in one line, in time."""
    start = time.monotonic()
    try:
        mesh = read(path)
    except BadInputError as error:
        assert "\n" not in str(error) and 10 < len(str(error)) < 400
        return False
    finally:
        assert time.monotonic() - start < PATIENCE
    assert isinstance(mesh, Mesh) and np.isfinite(mesh.vertices).all() and len(mesh.faces) > 0
    return True


def test_every_file_of_the_corpus_is_read_or_refused(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert len(FILES) >= 300
    folder = tmp_path / "parts"
    folder.mkdir()
    meshes = 0
    for suffix, content in FILES.values():
        path = folder / f"part{suffix}"
        path.write_bytes(content)
        meshes += tried(path)
        path.unlink()
        assert not list(folder.iterdir())
    assert 0 < meshes < len(FILES) // 2
    assert capfd.readouterr() == ("", "")


@given(st.sampled_from(FORMATS), st.lists(st.tuples(st.sampled_from(list(EDITS)), UNIT, UNIT), min_size=1, max_size=5))
@settings(max_examples=150, deadline=None, database=None, derandomize=True,
          suppress_health_check=[HealthCheck.function_scoped_fixture])  # fmt: skip
def test_a_changed_file_is_read_or_refused(tmp_path: Path, kind: str, edits: list[tuple[str, float, float]]) -> None:
    suffix, data = sound(kind)
    (tmp_path / f"part{suffix}").write_bytes(changed(data, edits))
    tried(tmp_path / f"part{suffix}")


@given(st.sampled_from(["vtk", "vtu", "vtp", "ply", "msh"]), st.lists(
    st.tuples(st.sampled_from(list(EDITS)), UNIT, UNIT), min_size=1, max_size=4))  # fmt: skip
@settings(max_examples=40, deadline=None, database=None, derandomize=True,
          suppress_health_check=[HealthCheck.function_scoped_fixture])  # fmt: skip
def test_scalars_of_a_changed_file_are_refused(
    tmp_path: Path, kind: str, edits: list[tuple[str, float, float]]
) -> None:
    suffix, data = sound(kind)
    (tmp_path / f"part{suffix}").write_bytes(changed(data, edits))
    with pytest.raises(BadInputError) as refusal:
        read_scalars(tmp_path / f"part{suffix}", "friction")
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize("name", [name for name, (_, content) in MALICIOUS.items() if OUTSIDE.encode() in content])
def test_references_in_a_file_are_not_followed_out_of_its_folder(name: str, tmp_path: Path) -> None:
    """They refer to a pipe, which would block a reader that opens it."""
    (tmp_path / "parts").mkdir()
    os.mkfifo(tmp_path / "parts" / OUTSIDE)
    suffix, content = MALICIOUS[name]
    (tmp_path / "parts" / f"part{suffix}").write_bytes(content)
    command = [sys.executable, "-m", "meshwind", "check", f"part{suffix}"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE, cwd=tmp_path / "parts")
    assert done.returncode == 2
    assert len(done.stderr.splitlines()) == 1 and done.stderr.startswith("meshwind: error: ")


def test_a_gltf_may_refer_to_a_file_beside_it(tmp_path: Path) -> None:
    import trimesh
    from mesh_shapes import pear

    for name, content in trimesh.Trimesh(*pear(1), process=False).scene().export(file_type="gltf").items():
        (tmp_path / name).write_bytes(content)
    assert tried(tmp_path / "model.gltf")
