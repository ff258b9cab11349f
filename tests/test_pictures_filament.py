"""Pictures of a filament: ribbons of true width, what the turnarounds stand on, and angles along the part."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image
from scipy.spatial import cKDTree

import meshwind as mw
from meshwind.appearance.ribbons import Line, evened, ribbons
from meshwind.core.cast import Floats, Ints
from meshwind.filament.course import Course, Kind
from meshwind.filament.filament import Filament, filaments_of
from meshwind.filament.levels import levels
from meshwind.pictures.angles_scene import angles_scene
from meshwind.pictures.animation_scene import reel_scene
from meshwind.pictures.filament_scene import bands_scene, filament_scene
from meshwind.pictures.gallery import scenes_of
from meshwind.pictures.page import Page
from meshwind.pictures.reel_picture import said
from meshwind.pictures.render import render
from meshwind.pictures.subject import Subject, subject_of
from meshwind.results.filament_file import read_filaments
from meshwind.results.reading import read_results
from meshwind.results.schema import FILAMENT, OF_FILAMENT, OF_LAMINATE


@pytest.fixture(scope="module")
def wound(tmp_path_factory: pytest.TempPathFactory) -> tuple[mw.Result, Path]:
    out = tmp_path_factory.mktemp("filament") / "out"
    result = mw.wind("data/tank.ply", paths=5, particles=101, band_width=9.0, continuous=True, turn_end="shaft",
                     out=out, render=False)  # fmt: skip
    return result, out


@pytest.fixture(scope="module")
def of(wound: tuple[mw.Result, Path]) -> Subject:
    return subject_of(read_results(wound[1]))


def test_a_filament_is_read_as_it_was_written(wound: tuple[mw.Result, Path]) -> None:
    result, out = wound
    assert result.closed is not None
    (written,), (read,) = filaments_of(result.closed), read_filaments(out / FILAMENT)
    for name in written.course.__dataclass_fields__:
        ours, theirs = (getattr(each.course, name) for each in (written, read))
        assert np.allclose(ours, theirs, rtol=0.0, atol=1e-12, equal_nan=True), name
    assert (read.layer == 0).all()


def test_ribbons_are_as_wide_as_the_band(of: Subject) -> None:
    scene = filament_scene(of)
    ribbons, course = scene.ribbons, of.filaments[0].course
    across = np.linalg.norm(np.diff(ribbons.points, axis=1), axis=2).sum(axis=1)
    assert across.max() <= 9.0 * (1.0 + 1e-9)
    assert across[ribbons.kind == Kind.LAID].min() > 8.5  # chords of the arc, which is as wide as the band
    assert (np.diff(ribbons.laid) >= 0.0).all()
    assert ribbons.laid[-1] == pytest.approx(float(course.arc_length[-1]), rel=1e-12)
    assert (scene.gear.base_words, scene.gear.held_words) == ("ring of the pins", "pins and shaft")
    start = (ribbons.kind == Kind.DWELL) & (ribbons.passed % 2 == 1)  # pins gather the band
    assert across[start] == pytest.approx(of.turned[0].pin, rel=0.01)
    seen = (ribbons.normals[:, 3] * course.normal[_nearest(ribbons.points[:, 3], course.points)]).sum(axis=1)
    assert seen[ribbons.kind == Kind.LAID].min() > 0.0  # outwards
    corner = ribbons.points.reshape(-1, 3)[ribbons.quads]
    facet = np.cross(corner[:, 2] - corner[:, 0], corner[:, 3] - corner[:, 1])
    assert ((facet * ribbons.normals.reshape(-1, 3)[ribbons.quads[:, 0]]).sum(axis=1) > 0.0).mean() > 0.99
    middle = scene.ribbons.points[:, scene.ribbons.points.shape[1] // 2]
    off = np.sqrt(((middle[:, None] - of.filaments[0].course.points[None]) ** 2).sum(axis=2)).min(axis=1)
    assert off.max() < 0.01 * of.paths.surface.size  # lifted, no more
    assert bands_scene(of).scale is None


def _nearest(points: Floats, among: Floats) -> Ints:
    return np.asarray(cKDTree(among).query(points)[1])


def test_a_shaft_and_pins_stand_where_the_fibre_is(of: Subject) -> None:
    scene, course = filament_scene(of), of.filaments[0].course
    tree = cKDTree(scene.gear.points[np.unique(scene.gear.held)])
    shaft = (course.kind == Kind.DWELL) & (course.passed % 2 == 0)
    off = np.linalg.norm(course.points[shaft, :2], axis=1) - of.turned[1].radius  # the tank's axis is z
    assert np.abs(off).max() < 0.05
    top = float(scene.gear.points[:, 2].max())
    assert top > course.points[shaft, 2].max() + 2.0 * of.turned[1].radius  # it goes on to the machine
    before = np.flatnonzero((course.kind[1:] == Kind.DWELL) & (course.kind[:-1] == Kind.TURN) & ~shaft[1:])
    assert tree.query(course.points[before])[0].max() < 2.5 * of.turned[0].pin


def helix(radius: float, tall: float, turns: float, air: tuple[int, int]) -> Filament:
    """201 points of a helix on a cylinder about z, a stretch of which is straight and in the air, with its angle."""
    share = np.linspace(0.0, 1.0, 201)
    turn = 2.0 * np.pi * turns * share
    normal = np.stack([np.cos(turn), np.sin(turn), 0.0 * turn], axis=1)
    points = radius * normal + tall * share[:, None] * [0.0, 0.0, 1.0]
    kind = np.full(201, Kind.LAID)
    first, last = air
    chord = np.linspace(0.0, 1.0, last - first + 1)[:, None]
    points[first : last + 1] = (1.0 - chord) * points[first] + chord * points[last]
    kind[first + 1 : last] = Kind.BRIDGE
    angle = np.full(201, np.arctan2(2.0 * np.pi * turns * radius, tall))
    zero = np.zeros(201, dtype=np.int64)
    return Filament(Course(points, normal, angle, 0.0 * angle, kind, zero, zero, zero - 1), zero, 0.0 * angle)


def test_bands_are_bent_as_the_part_and_ruled_in_the_air() -> None:
    tube = mw.shapes.cylinder(radius=50.0, length=200.0)
    one = helix(52.0, 200.0, 0.7, (60, 80))  # raised off the part by 2, as on layers below
    made = ribbons([one], tube, [12.0])
    lift = tube.size * (1e-3 + 4e-3 * made.laid / made.laid[-1])
    inside = np.s_[10:50]
    off = np.linalg.norm(made.points[inside, :, :2], axis=2) - (52.0 + lift[inside])[:, None]
    # the middle is on the helix; an edge 6 away would be 0.3 above a band that is not bent
    assert np.abs(off[:, 3]).max() < 1e-9
    assert np.abs(off).max() < 0.02
    arc = made.laid[60:81]
    share = ((arc - arc[0]) / (arc[-1] - arc[0]))[:, None, None]
    straight = (1.0 - share) * made.points[60] + share * made.points[80]
    assert np.abs(made.points[60:81] - straight).max() < 1e-9
    assert np.linalg.norm(made.points[60:81, -1] - made.points[60:81, 0], axis=1).max() < 12.0


@settings(max_examples=40, deadline=None, derandomize=True, database=None)
@given(st.floats(0.0, 1.0))
def test_a_band_grows_along_the_filament(share: float) -> None:
    tube = mw.shapes.cylinder(radius=50.0, length=200.0)
    whole = ribbons([helix(50.0, 200.0, 0.3, (60, 80)), helix(50.0, 200.0, 0.6, (60, 80))], tube, [12.0])
    done = share * float(whole.laid[-1])
    laid = whole.until(done)
    assert laid.laid[-1] == pytest.approx(done, abs=1e-9)
    kept = len(laid.laid) - 1
    assert np.array_equal(laid.points[:kept], whole.points[:kept])
    assert int(laid.sizes.sum()) == len(laid.points) == len(laid.kind)
    eye = np.array([0.6, -0.8, 0.0])
    moved = whole.before(eye, 10.0, 1.0).points - whole.points
    assert np.abs(np.cross(moved, eye)).max() < 1e-12  # only nearer: the picture is the same
    nearer = moved[:, 3] @ eye
    assert nearer.min() >= 0.0 and nearer.max() > 1.0


def test_the_movie_says_where_the_fibre_is(of: Subject) -> None:
    scene = reel_scene(of, 2.0, [Path("winding.gif")])
    whole, course = scene.filament.ribbons, of.filaments[0].course
    assert scene.motion.total == pytest.approx(float(course.arc_length[-1]))
    assert scene.motion.frames == 50
    at = int(np.flatnonzero((course.passed == 3) & (course.kind == Kind.LAID))[50])
    words = said(whole.until(float(course.arc_length[at])))
    assert words == ["circuit 2, pass back", f"{np.degrees(course.angle[at]):.1f}°", "on the part"]
    # the part turns against the fibre: the fibre goes round the spin's axis backwards
    off = course.points[:-1] - of.points.mean(axis=0)
    turned = np.cross(off, np.diff(course.points, axis=0)).sum(axis=0) @ scene.motion.spin
    assert turned < 0.0


@pytest.mark.usefixtures("opengl")
def test_the_movie_lays_the_filament(wound: tuple[mw.Result, Path], tmp_path: Path) -> None:
    render(wound[1], page=Page(320, 240), animate=["gif"], seconds=1.0, out=tmp_path)
    with Image.open(tmp_path / "winding.gif") as movie:
        frames = []
        for k in (0, 8, movie.n_frames - 1):
            movie.seek(k)
            frames.append(np.asarray(movie.convert("RGB"), dtype=float)[30:210, :240])
    coloured = [float((np.ptp(frame, axis=2) > 60.0).mean()) for frame in frames]
    assert coloured[0] < 2e-3 < coloured[1] < coloured[2]


def test_the_angles_are_those_of_the_paths(of: Subject) -> None:
    scene = angles_scene(of)
    low, median, high = scene.angles
    assert (low <= median).all() and (median <= high).all()
    # on a part of revolution the radius times the sine is the same all along, but for round-off and the mesh
    lines = levels(of.paths.surface)
    radius = np.interp(scene.stations, lines.mean, lines.length)
    constant = radius * np.sin(np.radians(median))
    assert constant == pytest.approx(float(np.median(constant)), rel=5e-3)
    assert scene.cover is not None and scene.cover.min() > 0.0


def test_only_a_filament_has_its_pictures(of: Subject) -> None:
    assert set(OF_FILAMENT) <= set(scenes_of(of))
    assert {*OF_FILAMENT, *OF_LAMINATE} & set(scenes_of(replace(of, filaments=()))) == {"bands"}


def test_bands_of_single_paths_have_their_width_and_family(of: Subject) -> None:
    scene = bands_scene(replace(of, filaments=()))
    made, groups, paths = scene.ribbons, scene.groups, of.paths
    assert groups is not None and groups.names == ("family +1", "family −1")
    assert len(made.sizes) == len(paths)
    across = np.linalg.norm(np.diff(made.points, axis=1), axis=2).sum(axis=1)
    assert np.median(across) == pytest.approx(of.widths[0], rel=0.01)
    first = np.cumsum(made.sizes) - made.sizes
    assert np.array_equal(groups.of_rows[first], (paths.family < 0).astype(np.int64))
    # each lies along its path, lifted by little
    middle = made.points[first, made.points.shape[1] // 2]
    assert np.abs(middle - paths.points[:, 0]).max() < 0.006 * paths.surface.size
    assert not len(scene.gear.base) and not len(scene.gear.held)


@pytest.mark.usefixtures("opengl")
def test_a_continuous_run_draws_its_filament(tmp_path: Path) -> None:
    mw.wind("data/elbow.obj", paths=3, particles=51, continuous=True, out=tmp_path / "out")
    for name in OF_FILAMENT:
        assert (tmp_path / "out" / f"{name}.png").stat().st_size > 10_000


@pytest.mark.parametrize(("wave", "least", "most"), [(np.inf, 1.0, 1.0), (200.0, 0.95, 1.0), (4.0, 0.0, 0.07)])
def test_a_band_bends_as_the_part_does_on_its_own_scale(wave: float, least: float, most: float) -> None:
    """Ribs narrower than a band are levelled, what is wider stays; a turnaround keeps its own bend."""
    z = np.linspace(0.0, 100.0, 1001)
    points = np.stack([0.0 * z, 0.0 * z, z], axis=1)
    kind = np.where(z > 90.0, int(Kind.TURN), int(Kind.LAID))
    none, zero = np.full(len(z), np.nan), np.zeros(len(z), dtype=np.int64)
    course = Course(points, np.tile([1.0, 0.0, 0.0], (len(z), 1)), none, none, kind, zero, zero, zero)
    across = np.where(z > 90.0, 3.0, 0.1 * np.cos(2.0 * np.pi * z / wave))
    line = Line(Filament(course, zero, none), np.arange(len(z)), across)
    found = evened(line, np.full(len(z), 20.0))
    inner = (z > 10.0) & (z < 80.0)
    assert least - 1e-9 <= np.abs(found[inner]).max() / np.abs(across[inner]).max() <= most + 1e-9
    assert (found[z > 90.0] == 3.0).all()
