"""Files whose content is of another kind than their ending says are refused with what they are."""

import bz2
import gzip
import io
import lzma
import zipfile
from pathlib import Path

import pytest
import trimesh
from barrels import POINTS, TRIANGLES, refusal, written

from meshwind.mesh import SUFFIXES

LFS = b"version https://git-lfs.github.com/spec/v1\noid sha256:4d7a21\nsize 12345\n"


def exported(kind: str, **options: str) -> bytes:
    data = trimesh.Trimesh(POINTS, TRIANGLES, process=False).export(file_type=kind, **options)
    return data.encode() if isinstance(data, str) else bytes(data)


def zipped(name: str, content: bytes) -> bytes:
    held = io.BytesIO()
    with zipfile.ZipFile(held, "w") as archive:
        archive.writestr(name, content)
    return held.getvalue()


MESHES = {
    ".stl": [exported("stl"), exported("stl_ascii")],
    ".ply": [exported("ply"), exported("ply", encoding="ascii")],
    ".obj": [exported("obj"), b"# made by hand\r\no a\r\n" + exported("obj")],
    ".off": [exported("off")],
    ".glb": [exported("glb")],
    ".3mf": [zipped("3D/3dmodel.model", b"<model/>")],
    ".vtk": [b"# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 0 float\n"],
    ".vtp": [b'<?xml version="1.0"?>\n<VTKFile type="PolyData" version="1.0"></VTKFile>\n'],
    ".vtu": [b'<VTKFile type="UnstructuredGrid" version="1.0"></VTKFile>\n'],
    ".msh": [b"$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"],
    ".inp": [b"** by hand\n*HEADING\nx\n*NODE\n1, 0, 0, 0\n"],
}
ENDINGS = (".stl", ".ply", ".obj", ".off")


@pytest.mark.parametrize("ending", ENDINGS)
@pytest.mark.parametrize("kind", MESHES)
def test_a_mesh_of_another_format_is_to_be_renamed(kind: str, ending: str, tmp_path: Path) -> None:
    if kind == ending:
        return
    for content in MESHES[kind]:
        words = refusal(written(tmp_path, f"part{ending}", content))
        assert words.endswith(f" file by its content; rename it to part{kind}"), words
        assert words.startswith("is a")


OTHERS = {
    "Git LFS": (LFS, "is a Git LFS pointer, not the mesh; fetch it with git lfs pull"),
    "gzip": (gzip.compress(exported("stl")), "is compressed (gzip) by its content; unpack it first"),
    "bzip2": (bz2.compress(exported("stl")), "is compressed (bzip2) by its content; unpack it first"),
    "xz": (lzma.compress(exported("stl")), "is compressed (xz) by its content; unpack it first"),
    "ZIP": (zipped("part.stl", exported("stl")), "is a ZIP archive by its content; unpack it first"),
    "web page": (b"\n<!DOCTYPE html>\n<html><body>404</body></html>\n", "is a web page, not a mesh; download the file"),
    "web page in capitals": (b"<HTML>\n<HEAD></HEAD></HTML>\n", "is a web page, not a mesh; download the file itself"),
    "STEP": (b"ISO-10303-21;\nHEADER;\n" + 100 * b" ", "is a STEP file by its content; rename it to part.step"),
    "picture": (b"\x89PNG\r\n\x1a\n" + bytes(200), "is a picture by its content"),
    "PDF": (b"%PDF-1.7\n" + bytes(200), "is a PDF document by its content"),
    "zeros": (bytes(1000), "begins with nothing but zeros, as after a copy that failed; copy or export it again"),
}


@pytest.mark.parametrize("ending", SUFFIXES)
@pytest.mark.parametrize("what", OTHERS)
def test_what_is_no_mesh_is_named(what: str, ending: str, tmp_path: Path) -> None:
    content, words = OTHERS[what]
    if what == "zeros" and ending == ".stl":  # a binary file of one empty triangle, and more
        content = content[:83]
    if (what, ending) not in (("ZIP", ".3mf"), ("STEP", ".step"), ("STEP", ".stp")):
        assert refusal(written(tmp_path, f"part{ending}", content)).startswith(words)


@pytest.mark.parametrize("ending", ENDINGS)
@pytest.mark.parametrize("encoding", ["utf-16-le", "utf-16-be"])
def test_text_of_two_bytes_is_to_be_saved_anew(encoding: str, ending: str, tmp_path: Path) -> None:
    text = MESHES[ending][-1].decode().encode(encoding)  # without a byte order mark
    assert refusal(written(tmp_path, f"part{ending}", text)) == "is text in UTF-16; save it as UTF-8"


def test_a_broken_file_of_its_own_kind_keeps_its_reason(tmp_path: Path) -> None:
    for ending in ENDINGS:
        whole = MESHES[ending][0]
        assert "by its content" not in refusal(written(tmp_path, f"part{ending}", whole[: len(whole) // 2]))


@pytest.mark.parametrize("ending", [".p21", ".txt", ".dat", ""])
@pytest.mark.parametrize("kind", ["STEP", "gzip", "web page", "stl", "obj"])
def test_a_file_of_an_unknown_ending_is_named_by_its_content(kind: str, ending: str, tmp_path: Path) -> None:
    content, words = OTHERS.get(kind) or (exported(kind), f" file by its content; rename it to part.{kind}")
    assert words in refusal(written(tmp_path, f"part{ending}", content))


def test_an_iges_file_is_to_be_renamed(tmp_path: Path) -> None:
    content = b"".join(b"%-72sS%7d\n" % (b"part", line) for line in (1, 2))
    words = "is an IGES file by its content; rename it to part.igs, or export it as STL"
    assert refusal(written(tmp_path, "part.stl", content)) == words
