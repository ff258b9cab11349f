"""Frames for robots: read back from the CSV files, against the exact helix and the limits."""

from pathlib import Path

import numpy as np
import pytest
from export_results import leave, plain_results, waisted_results
from layup_shapes import cylinder, helices

from meshwind.core.cast import Floats
from meshwind.core.errors import BadInputError
from meshwind.exporting.frames import HEADER, frames, write_frames
from meshwind.results.reading import Results

Table = dict[str, Floats]


def table(path: Path) -> Table:
    """The columns of a file, those of a vector together."""
    names = path.read_text().splitlines()[0].split(",")
    rows = np.loadtxt(path, delimiter=",", skiprows=1)
    column = {name: rows[:, k] for k, name in enumerate(names)}
    threes = {"": "xyz", "t": "xyz", "n": "xyz", "s": "xyz", "left_": "xyz", "right_": "xyz"}
    return column | {f"{key}*": np.stack([column[key + axis] for axis in axes], 1) for key, axes in threes.items()}


@pytest.fixture(scope="module", params=["plain", "waisted"])
def written(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[Results, Path]:
    """Helices on a cylinder, and fibres that bridge a waist and leave it with a kink."""
    out = tmp_path_factory.mktemp(request.param)
    results = (plain_results if request.param == "plain" else waisted_results)(out)
    write_frames(out, results, step=0.2, angle=4.0)
    return results, out / "frames"


def test_every_path_has_its_file_and_all_are_in_one(written: tuple[Results, Path]) -> None:
    results, folder = written
    files = sorted(folder.glob("path_*.csv"))
    assert [file.name for file in files] == [f"path_{k:03d}.csv" for k in range(len(results.paths))]
    assert {file.read_text().splitlines()[0] for file in files} == {HEADER}
    every = np.loadtxt(folder / "all.csv", delimiter=",", skiprows=1)
    each = [np.loadtxt(file, delimiter=",", skiprows=1) for file in files]
    assert np.array_equal(every[:, 2:], np.concatenate(each))
    assert np.array_equal(every[:, 0], np.repeat(np.arange(len(files)), [len(rows) for rows in each]))
    assert np.array_equal(every[:, 1], results.paths.family[every[:, 0].astype(int)])


def test_frames_are_orthonormal_and_right_handed(written: tuple[Results, Path]) -> None:
    for file in written[1].glob("path_*.csv"):
        read = table(file)
        axes = np.stack([read["t*"], read["s*"], read["n*"]], axis=1)
        assert np.abs(axes @ axes.transpose(0, 2, 1) - np.eye(3)).max() < 1e-9
        assert np.abs(np.linalg.det(axes) - 1.0).max() < 1e-9
        assert (np.einsum("ij,ij->i", read["n*"][:, :2], read["*"][:, :2]) > 0.0).all()


def test_edges_are_half_a_band_away(written: tuple[Results, Path]) -> None:
    width = written[0].band_width
    assert width is not None
    for file in written[1].glob("path_*.csv"):
        read = table(file)
        assert np.allclose(read["width"], width, rtol=1e-12)
        assert np.allclose(read["left_*"] - read["*"], 0.5 * read["width"][:, None] * read["s*"], atol=1e-12)
        assert np.allclose(read["right_*"] - read["*"], -0.5 * read["width"][:, None] * read["s*"], atol=1e-12)


def test_arc_length_is_that_of_the_path(written: tuple[Results, Path]) -> None:
    results, folder = written
    lengths = np.linalg.norm(np.diff(results.paths.points, axis=1), axis=2).sum(axis=1)
    for k, length in enumerate(lengths):
        read = table(folder / f"path_{k:03d}.csv")
        assert read["arc_length"][0] == 0.0
        assert read["arc_length"][-1] == pytest.approx(length, rel=1e-12)
        assert np.allclose(read["parameter_s"], read["arc_length"] / length, rtol=0, atol=1e-12)
        assert np.array_equal(read["index"], np.arange(len(read["index"])))
        assert np.allclose(read["*"][[0, -1]], results.paths.points[k, [0, -1]], rtol=0, atol=1e-13)


def test_limits_hold_with_few_frames(written: tuple[Results, Path], tmp_path: Path) -> None:
    results, folder = written
    sharp = 0
    for file in folder.glob("path_*.csv"):
        read = table(file)
        steps = np.diff(read["arc_length"])
        assert steps.max() <= 0.2 * (1.0 + 1e-9)
        assert steps.min() > 0.2 / 60.0
        assert len(steps) < 120
        turn = np.max([np.linalg.norm(np.diff(read[axis], axis=0), axis=1) for axis in ("t*", "n*")], axis=0)
        sharp += int((turn > np.radians(4.0)).sum())
    notes = write_frames(tmp_path, results, step=0.2, angle=4.0)
    assert notes == ([f"frames: {sharp} steps turn by more than the limit, as no step is made tiny for a sharp edge"]
                     if sharp else [])  # fmt: skip
    assert (sharp > 0) == bool((results.paths.gap > 0.0).any())


def test_a_smooth_path_keeps_the_turn_with_few_particles(tmp_path: Path) -> None:
    """Particles 4 degrees apart and a limit of 5: stations fall between particles, and still no step is too sharp."""
    results = leave(tmp_path, helices(3, 1.0, 91, cylinder()))
    assert write_frames(tmp_path, results, step=2.0, angle=5.0) == []
    assert len(table(tmp_path / "frames" / "path_000.csv")["x"]) == 74


@pytest.mark.parametrize("step", [0.3, 0.003])
def test_a_helix_is_exact(tmp_path: Path, step: float) -> None:
    """Points, tangents and arc length at every row, thinned and refined, against the formula."""
    results = leave(tmp_path, helices(3, 0.5, 401, cylinder()))
    write_frames(tmp_path, results, step=step, angle=30.0)
    read = table(tmp_path / "frames" / "path_000.csv")
    v = read["z"] / 4.0
    length = np.hypot(np.pi, 4.0)
    turn = np.pi * v
    assert np.abs(read["arc_length"] - v * length).max() < 1e-6 * length
    assert np.abs(read["*"][:, :2] - np.stack([np.cos(turn), np.sin(turn)], 1)).max() < 1e-6
    exact = np.stack([-np.pi * np.sin(turn), np.pi * np.cos(turn), np.full_like(v, 4.0)], 1) / length
    assert np.abs(read["t*"] - exact).max() < 1e-4


def test_metres_become_millimetres(tmp_path: Path) -> None:
    (tmp_path / "m").mkdir()
    results = plain_results(tmp_path, "m")
    write_frames(tmp_path, results)
    read = table(tmp_path / "frames" / "path_000.csv")
    assert read["z"][-1] == pytest.approx(4000.0)
    assert results.band_width is not None
    assert read["width"][0] == pytest.approx(1000.0 * results.band_width)


def test_particles_on_one_another_are_one() -> None:
    line = np.linspace(0.0, 1.0, 11)[:, None] * [1.0, 0.0, 0.0]
    doubled = np.repeat(line, 2, axis=0)
    found = frames(doubled, np.broadcast_to([0.0, 0.0, 1.0], doubled.shape), 0.1, 0.25, 0.1)
    assert np.allclose(found.arc_length, [0.0, 0.25, 0.5, 0.75, 1.0])
    assert np.allclose(found.side, [0.0, 1.0, 0.0])


@pytest.mark.parametrize(("given", "says"), [({"step": 0.0}, "step is 0"), ({"angle": -1.0}, "angle is -1"),
                                             ({"width": float("nan")}, "band width is nan")])  # fmt: skip
def test_limits_that_are_none_are_refused(tmp_path: Path, given: dict[str, float], says: str) -> None:
    results = plain_results(tmp_path)
    with pytest.raises(BadInputError, match=says):
        write_frames(tmp_path, results, **given)
    assert not (tmp_path / "frames").exists()
