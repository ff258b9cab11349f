"""Any command line and any results folder: done, or exit status 2 with one line, and no stray file."""

import shutil
import sys
from pathlib import Path

import pytest
from broken_meshes import save_obj
from hostile_files import EDITS, changed
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st
from mesh_shapes import cone

import meshwind as mw
from meshwind.cli import main
from meshwind.core.errors import BadInputError
from meshwind.exporting.formats import FORMATS
from meshwind.exporting.targets import ExportOptions, write_exports

STRANGE = [
    "", " ", "nan", "inf", "-1", "0", "1e308", "1e-308", "-0.0", "1/0", "0x10", "--", "-", "\0", "\n", "ü", "\ud800",
    "a" * 5000, "%s", "{}", "9" * 400, "1_0", "٣", "auto", "NaN/1", "../..", "field:", "field:mu",
]  # fmt: skip
KNOWN = {
    "--paths": ["1", "2"], "--revolutions": ["0.25", "1/3"], "--friction": ["0.1", "0"], "--component": ["0"],
    "--ends": ["z", "auto", "0,0,0 0,0,3", "loops 0 1", "loops 0 0", "1,2"], "--opening": ["0.2"],
    "--tolerance": ["1e-3"], "--threshold": ["0", "1e-3"], "--worst-fit": ["0.5"], "--units": ["mm"],
    "--particles": ["33", "3"],
    "--band-width": ["0.1"], "--tex": ["800"], "--tows": ["2"], "--band-thickness": ["0.1"],
    "--pins": ["part.obj", "pins.csv"], "--out": ["out", "a/b"],
}  # fmt: skip
ODD = st.one_of(st.sampled_from(STRANGE), st.text(max_size=12), st.floats().map(str), st.integers().map(str))
OPTION = st.sampled_from(list(KNOWN)).flatmap(
    lambda name: st.tuples(st.just(name), st.one_of(st.sampled_from(KNOWN[name]), ODD))
)
MESHES = st.one_of(st.sampled_from(["part.obj"] * 8 + ["pins.csv", "none.stl", "."]), ODD)
few = settings(deadline=None, database=None, derandomize=True,
               suppress_health_check=[HealthCheck.function_scoped_fixture])  # fmt: skip


@given(MESHES, st.lists(OPTION, max_size=4))
@example("part.obj", [("--out", "\0")])
@example("part.obj", [("--pins", "\0")])
@settings(few, max_examples=120)
def test_whatever_is_typed(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capfd: pytest.CaptureFixture[str],
    mesh: str,
    options: list[tuple[str, str]],
) -> None:
    folder = tmp_path / "here"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    save_obj(folder / "part.obj", cone())
    (folder / "pins.csv").write_text("u0,v0,u1,v1\n0,0,0.2,1\n")
    given_here = {"--paths": "2", "--particles": "33", "--out": "out"} | dict(options)
    arguments = ["wind", mesh, "--no-render", *(word for pair in given_here.items() for word in pair)]
    monkeypatch.chdir(folder)
    monkeypatch.setattr(sys, "argv", ["meshwind", *arguments])
    capfd.readouterr()
    with pytest.raises(SystemExit) as ended:
        main()
    printed, complained = capfd.readouterr()
    found = {path.name for path in folder.iterdir()} - {"part.obj", "pins.csv"}
    assert {path.name for path in tmp_path.iterdir()} == {"here"}
    if ended.value.code == 2:
        complaints = [line for line in complained.splitlines() if not line.endswith("...")]
        assert len(complaints) == 1 and complaints[0].startswith("meshwind: error: ")
        assert printed == "" and not found
    else:
        assert ended.value.code in (0, 3)
        assert (folder / given_here["--out"] / "report.json").is_file() and len(found) <= 1


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("results")
    save_obj(folder / "part.obj", cone())
    mw.wind(folder / "part.obj", paths=2, revolutions=0.2, particles=33, out=folder / "out", render=False)
    return folder / "out"


UNIT = st.floats(0.0, 1.0, exclude_max=True)
READ = "paths.vtp", "surface.npz", "report.json", "surface.vtu", "quads.vtu", "bridges.vtp", "crossings.vtp"


@given(st.sampled_from(READ), st.lists(st.tuples(st.sampled_from(list(EDITS)), UNIT, UNIT), min_size=1, max_size=3))
@example("surface.npz", [("cut", 0.0, 0.0)])
@settings(few, max_examples=60)
def test_whatever_a_results_folder_holds(
    tmp_path: Path, results: Path, name: str, edits: list[tuple[str, float, float]]
) -> None:
    folder, out = tmp_path / "run", tmp_path / "out"
    for each in (folder, out):
        shutil.rmtree(each, ignore_errors=True)
    shutil.copytree(results, folder)
    (folder / name).write_bytes(changed((folder / name).read_bytes(), edits))
    try:
        write_exports(folder, ("fibers", "frames", "viewer"), out, ExportOptions(formats=tuple(FORMATS), shell="quads"))
    except BadInputError as error:
        assert "\n" not in str(error) and not out.exists()
    else:
        assert (out / "viewer.html").is_file()
