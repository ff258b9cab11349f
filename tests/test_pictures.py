"""Pictures from a results folder: all of them, each readable, none where this machine cannot draw."""

import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from command import meshwind
from export_results import leave
from layup_shapes import bridged, cylinder, helices
from PIL import Image

from meshwind.core.cast import Floats, frozen
from meshwind.core.errors import BadInputError
from meshwind.mesh.geometry.mesh import Mesh
from meshwind.path.lengths import lengths
from meshwind.path.paths import Paths
from meshwind.pictures import driver
from meshwind.pictures.animation_scene import laid_before, turning
from meshwind.pictures.drawings import Drawing
from meshwind.pictures.gallery import layout
from meshwind.pictures.layup_scenes import slip_scene
from meshwind.pictures.map_scene import spread_out
from meshwind.pictures.movie import encoder
from meshwind.pictures.page import Page, parse_size
from meshwind.pictures.redesign_scene import draw_redesign
from meshwind.pictures.render import render
from meshwind.pictures.slip_picture import runs
from meshwind.pictures.subject import subject_of
from meshwind.pictures.winding_scene import winding_scene
from meshwind.results.reading import read_results
from meshwind.results.schema import PICTURES
from meshwind.results.write import surface_maps, write_files
from meshwind.surface.grid import grid

OF_ANY = tuple(name for name in PICTURES if name not in ("filament", "laminate"))
"""Pictures of any winding, be it continuous or not, and without layers."""

SMALL = Page(480, 360)


def left(folder: Path, paths: Paths) -> Path:
    """A results folder with the fit's error in its maps."""
    results = leave(folder, paths)
    on = grid(paths.surface)
    triangles = np.concatenate([on.quads[:, [0, 1, 2]], on.quads[:, [0, 2, 3]]])
    write_files(folder, results.layup, surface_maps(results.layup, Mesh(1.001 * on.points, triangles, "part.stl")))
    return folder


def slipping() -> Paths:
    """The waist's fibres with friction 0.2, half of which they need."""
    paths = bridged()
    slip = np.where(np.isfinite(paths.slip), 0.1, np.nan)
    return replace(paths, slip=frozen(slip), friction=0.2)


@pytest.fixture(scope="module")
def waist(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return left(tmp_path_factory.mktemp("waist"), slipping())


def pixels(picture: Path) -> Floats:
    with Image.open(picture) as opened:
        return np.asarray(opened, dtype=float)


@pytest.fixture(scope="module")
def drawn(waist: Path, tmp_path_factory: pytest.TempPathFactory, opengl: None) -> Path:  # noqa: ARG001
    out = tmp_path_factory.mktemp("drawn")
    render(waist, page=SMALL, out=out)
    return out


def test_a_folder_alone_gives_every_picture(drawn: Path) -> None:
    assert {file.name for file in drawn.iterdir()} == {f"{name}.png" for name in (*OF_ANY, "sheet")}
    assert pixels(drawn / "sheet.png").shape == (4 * 360, 3 * 480, 3)


@pytest.mark.parametrize("name", OF_ANY)
def test_pictures_are_full_and_cut_nothing_off(drawn: Path, name: str) -> None:
    image = pixels(drawn / f"{name}.png")
    assert image.shape == (360, 480, 3)
    paper = (image == 255.0).all(axis=2)
    assert paper[0].all() and paper[-1].all() and paper[:, 0].all() and paper[:, -1].all()
    part = ~paper[46:320, 18:390]
    assert part.mean() > 0.1
    assert name in ("unrolled", "angles") or not (part[:, 0].any() or part[:, -1].any())


@pytest.fixture(scope="module")
def pages(waist: Path, tmp_path_factory: pytest.TempPathFactory, opengl: None) -> Path:  # noqa: ARG001
    """The winding on pages of all kinds, by one process."""
    out = tmp_path_factory.mktemp("pages")
    kinds = {
        "bare": replace(SMALL, scale_bar=False),
        "deep": replace(SMALL, perspective=True, view="iso"),
        "deep-ruled": replace(SMALL, perspective=True, scale_bar=True),
        "clear": replace(SMALL, transparent=True),
        "tall": Page(300, 700),
    }
    results = read_results(waist)
    drawings = {name: Drawing(winding_scene(subject_of(results, page.view)), page) for name, page in kinds.items()}
    assert driver.paint({out / f"{name}.png": drawing for name, drawing in drawings.items()}) == ""
    return out


@pytest.mark.parametrize("name", ["deep", "deep-ruled", "tall"])
def test_perspective_and_other_shapes_cut_nothing_off(pages: Path, name: str) -> None:
    paper = (pixels(pages / f"{name}.png") == 255.0).all(axis=2)
    height, width = paper.shape
    unit = min(width / 1600, height / 1200)
    top, right = round(124 * unit), width - round(286 * unit)
    assert paper[top : round(146 * unit), :right].all()
    assert paper[round(150 * unit) : height - round(120 * unit), : round(50 * unit)].all()
    assert 0.05 < (~paper[round(150 * unit) :, :right]).mean() < 0.8


def test_paper_may_be_left_out(pages: Path) -> None:
    image = pixels(pages / "clear.png")
    assert image.shape == (360, 480, 4)
    assert (image[0, :, 3] == 0.0).all()
    assert image[180, 109, 3] == 255.0  # in the view from the front


def test_a_scale_bar_comes_and_goes(drawn: Path, pages: Path) -> None:
    def ruled(picture: Path) -> bool:
        return bool((pixels(picture)[335:, :120, :3] < 100.0).any())

    assert ruled(drawn / "winding.png") and ruled(pages / "deep-ruled.png")
    assert not ruled(pages / "bare.png") and not ruled(pages / "deep.png")


def test_slip_off_the_surface_is_no_number(waist: Path) -> None:
    of = subject_of(read_results(waist))
    seen = slip_scene(of)
    off = ~of.paths.on_surface[:, of.kept]
    assert np.isnan(seen.shares[off]).all()
    assert np.isnan(seen.shares[:, [0, -1]]).all()
    known = seen.shares[np.isfinite(seen.shares)]
    assert known == pytest.approx(0.5)
    wanted = np.isfinite(seen.shares[:, 1:]) & np.isfinite(seen.shares[:, :-1])
    lines = runs(seen.fibres.points, seen.shares, wanted)
    assert np.isfinite(lines.point_data["share"]).all()
    assert lines.n_lines == 2 * len(of.paths)  # below and above the waist


def test_the_histogram_of_slip_is_by_length_of_what_touches(waist: Path) -> None:
    of = subject_of(read_results(waist))
    seen = slip_scene(of)
    # all of it needs 0.1, half of the friction: one bar, of all, below a line at the end of the scale
    assert seen.bins[len(seen.bins) // 2] == pytest.approx(1.0) and np.count_nonzero(seen.bins) == 1
    assert seen.limit == 1.0
    # a quarter of the way of a path is a quarter of the fibre, however many points it has
    slip = np.array(of.paths.slip)
    known = np.isfinite(slip)
    length = lengths(of.paths).arc_length
    early = known & (length < 0.25 * length[:, -1:])
    slip[early] = 0.022
    seen = slip_scene(replace(of, layup=replace(of.layup, paths=replace(of.paths, slip=frozen(slip)))))
    mine = np.gradient(length, axis=1)
    share = mine[early].sum() / mine[known].sum()
    assert seen.bins[2] == pytest.approx(share) and seen.bins.sum() == pytest.approx(1.0)


def test_without_friction_slip_needs_no_scale(tmp_path: Path) -> None:
    seen = slip_scene(subject_of(read_results(left(tmp_path, helices(4, 0.5, 41, cylinder(64))))))
    assert not seen.needed
    assert "no friction needed" in seen.frame.subtitle
    assert not seen.bridges


@pytest.mark.parametrize(("given", "says"), [
    ({"only": ["wings"]}, "picture 'wings' is not known; give winding, crossings"),
    ({"only": ["redesign"]}, "holds nothing to draw redesign from"),
    ({"animate": ["avi"]}, "movie 'avi' is not known; give gif, mp4"),
    ({"animate": ["gif"], "seconds": 0.1}, "seconds is 0.1; give a number from 1 to 120"),
    ({"page": Page(view="left")}, "view 'left' is not known; give auto, x, -x"),
])  # fmt: skip
def test_what_cannot_be_drawn_is_refused(waist: Path, tmp_path: Path, given: dict[str, object], says: str) -> None:
    with pytest.raises(BadInputError, match=says):
        render(waist, out=tmp_path / "out", **given)  # type: ignore[arg-type]
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("text", ["wide", "800", "800x", "-5x600", "100x100", "800x90000"])
def test_sizes_that_cannot_be_drawn_are_refused(text: str) -> None:
    with pytest.raises(BadInputError, match="size is "):
        Page(*parse_size(text))
    assert parse_size("1920x1080") == parse_size("1920 × 1080") == (1920, 1080)


def test_without_a_driver_nothing_is_written(waist: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    driver.stop()
    monkeypatch.setenv("__EGL_VENDOR_LIBRARY_DIRS", str(tmp_path))
    monkeypatch.setenv("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")
    with pytest.raises(BadInputError, match="libegl1 libgl1-mesa-dri"):
        render(waist, out=tmp_path / "out")
    assert not (tmp_path / "out").exists()


@pytest.mark.usefixtures("opengl")
def test_the_movie_lays_all_fibre(waist: Path, tmp_path: Path) -> None:
    counted: list[tuple[int, int]] = []
    done = render(
        waist, page=Page(320, 240), animate=["gif", "mp4"], seconds=1.0, out=tmp_path,
        progress=lambda _what, made, total: counted.append((made, total)),
    )  # fmt: skip
    assert [file.name for file in done.files] == ["winding.gif", "winding.mp4"]
    assert counted[-1] == (26, 26)
    with Image.open(tmp_path / "winding.gif") as movie:
        frames = []
        for k in range(movie.n_frames):
            movie.seek(k)
            frames.append(np.asarray(movie.convert("RGB"), dtype=float))
    assert len(frames) == 25
    coloured = [float((np.ptp(frame[30:210, :240], axis=2) > 60.0).mean()) for frame in frames]
    assert coloured[0] == 0.0 < coloured[8] < coloured[-1]
    command = [encoder(), "-i", str(tmp_path / "winding.mp4"), "-f", "framemd5", "-"]
    decoded = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    shown = [line for line in decoded.splitlines() if not line.startswith("#")]
    assert len(shown) == 25 + round(1.5 * 25)
    assert len({line.split(",")[-1] for line in shown}) > 20


def test_the_families_take_turns() -> None:
    family, length = np.array([1, 1, 1, -1, -1]), np.array([1.0, 2.0, 3.0, 10.0, 20.0])
    assert laid_before(family, length).tolist() == [0.0, 11.0, 33.0, 1.0, 13.0]


def test_a_turning_part_stays_on_the_picture() -> None:
    points = np.random.default_rng(0).normal(size=(200, 3)) * [1.0, 2.0, 5.0]
    right, up = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.6, 0.8])
    spin, centre, extent = turning(points, points[:0], up, right)
    axis = np.array([[0.0, -spin[2], spin[1]], [spin[2], 0.0, -spin[0]], [-spin[1], spin[0], 0.0]])
    worst = np.zeros(2)
    for angle in np.linspace(0.0, 2.0 * np.pi, 181):
        turn = np.eye(3) + np.sin(angle) * axis + (1.0 - np.cos(angle)) * axis @ axis
        seen = (points - centre) @ turn.T @ np.stack([right, up], axis=1)
        worst = np.maximum(worst, 2.0 * np.abs(seen).max(axis=0))
    assert (worst <= extent * (1.0 + 1e-12)).all()
    assert worst == pytest.approx(extent, rel=1e-3)


def test_fans_keep_apart_and_leave_no_gap() -> None:
    points = np.random.default_rng(1).uniform(size=(2000, 3))
    chosen = points[spread_out(points, 0.2)]
    apart = np.linalg.norm(chosen[:, None] - chosen[None], axis=2) + np.eye(len(chosen))
    assert apart.min() > 0.2
    assert np.linalg.norm(points[:, None] - chosen[None], axis=2).min(axis=1).max() <= 0.2


@pytest.mark.parametrize("count", range(1, 14))
def test_a_sheet_has_a_cell_for_each_picture(count: int) -> None:
    columns, rows = layout(count)
    assert columns * (rows - 1) < count <= columns * rows


@pytest.mark.usefixtures("opengl")
def test_a_redesign_shows_what_moved(tmp_path: Path) -> None:
    on = grid(cylinder(64))
    faces = np.concatenate([on.quads[:, [0, 1, 2]], on.quads[:, [0, 2, 3]]])
    outward = on.points * [1.0, 1.0, 0.0]
    moves = 0.3 * np.exp(-((on.points[:, 2:] - 2.0) ** 2) - (on.points[:, :1] - 1.0) ** 2) * outward
    assert draw_redesign(tmp_path / "redesign.png", on.points, moves, faces, "tube", "mm", SMALL) == ""
    image = pixels(tmp_path / "redesign.png")
    red = (image[..., 0] > image[..., 2] + 60.0)[46:320, :390]
    assert red[:, 200:].mean() > 0.01
    assert 0.0 < red[:, :190].mean() < 0.2 * red[:, 200:].mean()  # the part as it was, with arrows
    with pytest.raises(BadInputError, match="moves has shape"):
        draw_redesign(tmp_path / "redesign.png", on.points, moves[1:], faces, "tube")


@pytest.mark.usefixtures("opengl")
def test_the_command_line(waist: Path, tmp_path: Path) -> None:
    def run(*more: str) -> subprocess.CompletedProcess[str]:
        return meshwind("render", waist, "--out", tmp_path / "o", *more)

    done = run("--only", "winding, slip", "--size", "400x300", "--view", "-X")
    assert done.returncode == 0
    assert [Path(line.split()[1]).name for line in done.stdout.splitlines()] == ["slip.png", "winding.png"]
    assert done.stderr == "drawing ...\n"
    assert pixels(tmp_path / "o" / "slip.png").shape == (300, 400, 3)
    bad = run("--size", "big")
    assert bad.returncode == 2
    assert bad.stdout == ""
    assert bad.stderr == "meshwind: error: size is 'big'; give width and height in pixels, as in 1920x1080\n"


def test_help_names_every_picture() -> None:
    words = " ".join(meshwind("render", "--help").stdout.split())
    assert all(name in words for name in (*PICTURES, "redesign", "sheet"))
