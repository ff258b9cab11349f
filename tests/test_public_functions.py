"""Functions that do what a command does: the same defaults, and errors in the words of the caller."""

import inspect
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from typer.main import get_command

import meshwind as mw
from meshwind.cli.main import app
from meshwind.pictures.page import Page
from meshwind.pictures.render import usual_page
from meshwind.program.targets import write_program

DATA = Path(__file__).parents[1] / "data"
FUNCTIONS: dict[str, Callable[..., Any]] = {
    "wind": mw.wind, "check": mw.check, "redesign": mw.redesign, "render": mw.render, "export": mw.export,
    "sweep": mw.sweep, "program": write_program, "solve": mw.solve_deck,
}  # fmt: skip
OTHERWISE = {"frozen": "freeze"}
"""Names of arguments that the command has another name for."""
APART = {
    ("wind", "out"): "a command writes files, a function only where it is asked to",
    ("program", "to"): "a command draws, too",
}
"""Defaults that differ, and why."""
NONE = {None, "", (), "auto"}
"""Different words for nothing: texts of the command line, sequences of the library, numbers left to be chosen."""


def defaults(command: str) -> dict[str, tuple[Any, Any]]:
    """The defaults of each argument that function and command both have: in the library, and on the command line."""
    options = {each.name: each for each in get_command(app).commands[command].params}  # type: ignore[attr-defined]
    longs = {flag.removeprefix("--").replace("-", "_"): each for each in options.values() for flag in each.opts}
    held = inspect.signature(FUNCTIONS[command]).parameters.values()
    found = {}
    for each in held:
        option = longs.get(OTHERWISE.get(each.name, each.name)) or options.get(each.name or "")
        if option is not None and each.default is not inspect.Parameter.empty:
            found[each.name] = each.default, option.default
    return found


@pytest.mark.parametrize("command", FUNCTIONS)
def test_defaults_are_those_of_the_command(command: str) -> None:
    both = defaults(command)
    assert len(both) >= {"program": 6, "sweep": 4, "render": 3, "solve": 3}.get(command, 6)
    for name, (mine, its) in both.items():
        if (command, name) not in APART:
            same = mine == its or str(mine) == its  # a number that may be a word is a text on the command line
            assert same or {mine, its} <= NONE, f"{command}: {name}"


def test_movies_have_the_size_of_the_command() -> None:
    assert (usual_page((), ("gif",)).width, usual_page((), ("gif",)).height) == (960, 720)
    assert usual_page(("coverage",), ("gif",)) == usual_page((), ()) == Page()


@pytest.fixture(scope="module")
def result() -> mw.Result:
    return mw.wind(DATA / "tank.ply", paths=4, revolutions=0.3, particles=51)


def test_export_takes_a_result_and_a_folder(result: mw.Result, tmp_path: Path) -> None:
    with pytest.raises(mw.BadInputError, match="give out"):
        mw.export(result, "fibers")
    first = mw.export(result, ["fibers", "frames"], formats="ply", out=tmp_path / "a")
    result.write(tmp_path / "run", render=False)
    second = mw.export(mw.load(tmp_path / "run"), ["fibers", "frames"], formats=["ply"], out=tmp_path / "b")
    third = mw.export(tmp_path / "run", ["fibers", "frames"], formats=("ply",), out=tmp_path / "c")
    names = [file.relative_to(tmp_path / "a") for file in first.files]
    assert len(names) > 10
    for done, folder in ((second, "b"), (third, "c")):
        assert [file.relative_to(tmp_path / folder) for file in done.files] == names
        assert all((tmp_path / "a" / name).read_bytes() == (tmp_path / folder / name).read_bytes() for name in names)
    assert mw.export(mw.load(tmp_path / "run"), "fibers").files[0].parent == tmp_path / "run"


def test_check_takes_what_wind_takes(result: mw.Result) -> None:
    found = mw.check(DATA / "tank.ply")
    same = mw.check(result.mesh.to_trimesh(), units="mm")
    assert found.problem == same.problem == ""
    assert same.annulus_faces == found.annulus_faces
    assert mw.check(DATA / "tank.ply", ends="loops 0 1").problem != ""


def test_sweep_takes_what_a_file_would_hold(tmp_path: Path) -> None:
    study = {"mesh": DATA / "tank.ply", "paths": 3, "particles": 51, "revolutions": (0.2, 0.3), "band_width": 4.0}
    swept = mw.sweep(study, tmp_path / "out", processes=1)
    assert swept.settled and [row["revolutions"] for row in swept.rows] == [0.2, 0.3]
    table = swept.to_dataframe()
    assert table["band_width"].tolist() == [4.0, 4.0] and table["case"].is_unique
    with pytest.raises(mw.BadInputError, match="'turns' is no option"):
        mw.sweep({"mesh": DATA / "tank.ply", "turns": 1}, tmp_path / "other")


def shown() -> list[tuple[str, Any]]:
    """All public functions and classes, and the methods of these."""
    found: list[tuple[str, Any]] = []
    for name in mw.__all__:
        public = getattr(mw, name)
        if inspect.ismodule(public):
            found += [(f"{name}.{key}", each) for key, each in vars(public).items() if inspect.isfunction(each)]
        else:
            found.append((name, public))
        for kind in public.__mro__ if inspect.isclass(public) else ():
            if kind.__module__.startswith("meshwind"):
                found += [(f"{name}.{key}", each) for key, each in vars(kind).items() if inspect.isfunction(each)]
    return [(name, each) for name, each in found if not name.rpartition(".")[2].startswith("_") and callable(each)]


def test_signatures_name_types_as_people_do() -> None:
    """`ArrayLike` and `Floats`, not what they stand for, which fills five lines of an editor's hint."""
    names = dict(shown())
    assert {"solve", "Surface.points", "shapes.cone", "Result"} <= set(names)
    for name, each in names.items():
        if isinstance(each, type) and issubclass(each, Exception | int):
            continue
        said = str(inspect.signature(each))
        assert not any(word in said for word in ("numpy.", "Union[", "typing.", "meshwind.")), f"{name}{said}"
