"""The chart as an image: a surface to pixels and back, and files that hold it."""

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import meshwind as mw
from meshwind.core.cast import Floats
from meshwind.results.image_files import read_image, write_chart_image, write_image

UV = np.random.default_rng(4).random((5000, 2))


def bean(u: Floats, v: Floats) -> Floats:
    """No symmetry, far from the origin."""
    t, r = 2 * np.pi * u, 1 + 0.2 * np.sin(3 * v + 1)
    return np.stack([r * np.cos(t) + 0.3 * v**2 + 50, 0.7 * r * np.sin(t + 0.4 * v), 2 * v - 0.1 * np.cos(t)], -1)


@pytest.fixture(scope="module")
def surface() -> mw.Surface:
    return mw.shapes.parametric(bean, (96, 64))


def extent(image: Floats) -> Floats:
    return np.asarray(np.ptp(image, axis=(0, 1)))


def test_pixels_are_points_of_the_surface(surface: mw.Surface) -> None:
    image = mw.surface_image(surface, 20, 11)
    assert image.shape == (11, 20, 3)
    u, v = np.meshgrid(np.arange(20) / 20, np.arange(11) / 10)
    np.testing.assert_allclose(image, bean(u, v), rtol=0, atol=1e-6)


def test_the_image_surface_goes_through_its_pixels() -> None:
    image = np.random.default_rng(0).random((9, 13, 3))
    np.testing.assert_allclose(mw.surface_image(mw.from_image(image), 13, 9), image, rtol=0, atol=1e-13)


def test_a_shape_comes_back_with_fourth_order() -> None:
    exact = bean(*UV.T)

    def error(n: int) -> float:
        u, v = np.meshgrid(np.arange(n) / n, np.linspace(0, 1, n))
        return float(np.abs(mw.from_image(bean(u, v)).points(UV) - exact).max())

    errors = [error(n) for n in (32, 64, 128)]
    assert np.log2(errors[0] / errors[2]) / 2 > 3.7
    assert errors[2] < 1e-7


def test_normals_stay_outward_and_paths_the_same(surface: mw.Surface) -> None:
    again = mw.from_image(mw.surface_image(surface, 256, 193))
    assert (surface.normals(UV) * again.normals(UV)).sum(axis=1).min() > 1 - 1e-9
    points = [mw.solve(s, [(0, 0)], [(0.3, 1)], particles=101).points for s in (surface, again)]
    assert np.abs(points[1] - points[0]).max() < 1e-6


def test_npz_is_exact(surface: mw.Surface, tmp_path: Path) -> None:
    image = mw.surface_image(surface, 40, 30)
    write_image(tmp_path / "chart.npz", image)
    with np.load(tmp_path / "chart.npz") as held:
        assert (held["image"] == image).all()
    assert (read_image(tmp_path / "chart.npz").control_points == mw.from_image(image).control_points).all()


def test_png_holds_each_coordinate_to_half_a_level(surface: mw.Surface, tmp_path: Path) -> None:
    image = mw.surface_image(surface, 40, 30)
    write_image(tmp_path / "chart.png", image)
    again = mw.surface_image(read_image(tmp_path / "chart.png"), 40, 30)
    assert (np.abs(again - image) <= extent(image) / 65535 / 2 * (1 + 1e-6)).all()


def test_a_run_s_picture_gives_its_surface_to_a_level(surface: mw.Surface, tmp_path: Path) -> None:
    write_chart_image(tmp_path / "chart.png", surface)
    again = read_image(tmp_path / "chart.png")
    assert (np.abs(again.points(UV) - surface.points(UV)) <= extent(mw.surface_image(surface, 256, 256)) / 65535).all()


def test_any_viewer_shows_the_rows_from_the_top(surface: mw.Surface, tmp_path: Path) -> None:
    """Read by another library: 8 bits of each channel, the first row is v = 0, the text gives the range."""
    image = mw.surface_image(surface, 40, 30)
    write_image(tmp_path / "chart.png", image)
    with Image.open(tmp_path / "chart.png") as picture:
        pixels, texts = np.asarray(picture), picture.info
    low, high = (np.array([float(x) for x in texts[f"meshwind XYZ {end}"].split()]) for end in ("min", "max"))
    assert (low == image.min(axis=(0, 1))).all()
    assert (high == image.max(axis=(0, 1))).all()
    assert (np.abs(low + pixels / 255 * (high - low) - image) <= extent(image) / 255).all()


def test_a_flat_channel_keeps_its_value(tmp_path: Path) -> None:
    image = np.random.default_rng(0).random((5, 6, 3))
    image[..., 1] = -7.25
    write_image(tmp_path / "flat.png", image)
    assert (np.abs(mw.surface_image(read_image(tmp_path / "flat.png"), 6, 5)[..., 1] + 7.25) < 1e-14).all()


@pytest.mark.parametrize("kept", [0, 8, 60, 3000, -10])
def test_a_png_cut_short_is_refused(surface: mw.Surface, tmp_path: Path, kept: int) -> None:
    write_chart_image(tmp_path / "chart.png", surface)
    (tmp_path / "cut.png").write_bytes((tmp_path / "chart.png").read_bytes()[:kept])
    with pytest.raises(mw.BadInputError, match=r"cut\.png: is damaged or no PNG"):
        read_image(tmp_path / "cut.png")


def test_damaged_bytes_are_refused(surface: mw.Surface, tmp_path: Path) -> None:
    write_image(tmp_path / "chart.png", mw.surface_image(surface, 16, 16))
    whole = (tmp_path / "chart.png").read_bytes()
    for position in range(0, len(whole) - 4, 23):  # the sum of the end mark, which is empty, is not looked at
        broken = bytearray(whole)
        broken[position] ^= 255
        (tmp_path / "broken.png").write_bytes(broken)
        with pytest.raises(mw.BadInputError, match=r"broken\.png"):
            read_image(tmp_path / "broken.png")


def test_other_files_are_refused(tmp_path: Path) -> None:
    Image.new("RGB", (8, 8)).save(tmp_path / "eight.png")
    Image.new("I;16", (8, 8)).save(tmp_path / "grey.png")
    np.savez(tmp_path / "other.npz", points=np.zeros((8, 8, 3)))
    (tmp_path / "no.npz").write_bytes(b"not a zip")
    for name, why in {"eight.png": "16 bits", "grey.png": "16 bits", "other.npz": "no array 'image'",
                      "no.npz": "no array 'image'", "absent.png": "no such file"}.items():  # fmt: skip
        with pytest.raises(mw.BadInputError, match=why):
            read_image(tmp_path / name)
    (tmp_path / "a.tif").touch()
    with pytest.raises(mw.BadInputError, match=r"ends in \.png or \.npz"):
        read_image(tmp_path / "a.tif")


def test_images_that_make_no_surface_are_refused(surface: mw.Surface) -> None:
    with pytest.raises(mw.BadInputError, match="too few"):
        mw.surface_image(surface, 3, 10)
    with pytest.raises(mw.BadInputError, match="too small"):
        mw.from_image(np.zeros((3, 8, 3)))
    with pytest.raises(mw.BadInputError, match="shape"):
        mw.from_image(np.zeros((8, 8, 4)))
    with pytest.raises(mw.BadInputError, match="NaN"):
        mw.from_image(np.full((8, 8, 3), np.nan))
    with pytest.raises(mw.BadInputError, match="periodic"):
        mw.surface_image(mw.Surface(np.random.default_rng(0).random((5, 5, 3)), periodic=False), 8, 8)
