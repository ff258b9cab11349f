"""Parts with a wall: each skin is found whole, in any pose, scale and order; handles are closed or refused."""

import re
from collections.abc import Callable

import numpy as np
import pytest
from mesh_shapes import ball, moved, pear, rotation, shuffled
from walled_shapes import (
    GRID,
    INNER,
    OUTER,
    Grid,
    Walled,
    bent,
    blob,
    bottle,
    chamfered,
    filleted,
    flanged,
    nozzle,
    pipe,
    slanted,
    squared,
    stepped,
    tunnelled,
    vessel,
)

import meshwind as mw
from meshwind.core.cast import Floats, Ints
from meshwind.mesh import check, mesh_from
from meshwind.mesh.geometry.areas_and_volumes import areas, loop_area, volume
from meshwind.mesh.walls.handles import genus, without_small_handles

Shape = Callable[[Grid], Walled]

OPEN: dict[str, Shape] = {
    "pipe": lambda grid: pipe(grid=grid),
    "pipe with a thin wall": lambda grid: pipe(wall=0.5, grid=grid),
    "pipe with a thick wall": lambda grid: pipe(wall=12.0, grid=grid),
    "ring": lambda grid: pipe(wall=2.0, height=20.0, grid=grid),
    "slanted pipe": lambda grid: pipe(grid=grid).moved(slanted(20.0, -30.0, 120.0)),
    "chamfered pipe": lambda grid: chamfered(grid=grid),
    "flanged pipe": lambda grid: flanged(grid=grid),
    "bobbin": lambda grid: flanged(wall=10.0, width=40.0, grid=grid),
    "stepped tube": lambda grid: stepped(grid=grid),
    "elbow": lambda grid: pipe(grid=grid).moved(bent(80.0)),
    "chamfered elbow": lambda grid: chamfered(grid=grid).moved(bent(80.0)),
    "flanged elbow": lambda grid: flanged(grid=grid).moved(bent(90.0)),
    "duct": lambda grid: pipe(grid=grid).moved(squared),
    "bent duct": lambda grid: pipe(grid=grid).moved(squared).moved(bent(80.0)),
}
"""Parts of which both skins are open at both ends and meet their rims at creases."""
HARD: dict[str, Shape] = {
    "U bend": lambda grid: pipe(radius=20.0, wall=2.0, height=60.0 * np.pi, grid=grid).moved(bent(60.0)),
    "funnel": lambda grid: pipe(grid=grid).moved(lambda points: points * (1.0 - points[:, 2:] / 160.0) ** [1, 1, 0]),
    "nozzle": lambda grid: nozzle(grid=grid),
    "vessel": lambda grid: vessel(grid=grid),
    "thin vessel": lambda grid: vessel(0.5, grid),
}
"""The same with walls of uneven thickness, narrow mouths, or with one end beside the other."""
SIDES = {"outer": OUTER, "inner": INNER}
MEDIUM, COARSE, UNEVEN, FACETS = Grid(32, 6.0), Grid(24, 8.0), Grid(40, 5.0, 0.4), Grid(32, 1e9)
"""Other meshes: FACETS as from CAD, with no vertex between the creases of a straight part."""


def mesh_of(part: Walled | tuple[Floats, Ints]) -> mw.Mesh:
    return mesh_from(part.vertices, part.faces) if isinstance(part, Walled) else mesh_from(*part)


def corners(vertices: Floats, faces: Ints) -> set[tuple[tuple[float, ...], ...]]:
    """The triangles as sets of corners, whatever the order."""
    return {tuple(sorted(map(tuple, triangle))) for triangle in vertices[faces].tolist()}


def skin_of(part: Walled, side: str) -> set[tuple[tuple[float, ...], ...]]:
    return corners(part.vertices, part.faces[part.skin == SIDES[side]])


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("name", OPEN | HARD)
def test_each_skin_is_found_face_by_face(name: str, side: str) -> None:
    part = (OPEN | HARD)[name](MEDIUM)
    found = mw.annulus(mesh_of(part), side=side)
    assert corners(found.vertices, found.faces) == skin_of(part, side)
    assert found.wall is not None and found.wall.side == side
    assert volume(found.vertices, found.faces) > 0.0  # of the inner skin, too: it is that of a mandrel
    assert len(found.notes) == 1 and f"wound on its {'outside' if side == 'outer' else 'inside'}" in found.notes[0]


@pytest.mark.parametrize("grid", [COARSE, UNEVEN], ids=["coarse", "uneven"])
@pytest.mark.parametrize("name", OPEN)
def test_skins_do_not_depend_on_the_mesh(name: str, grid: Grid) -> None:
    part = OPEN[name](grid)
    for side in SIDES:
        found = mw.annulus(mesh_of(part), side=side)
        assert corners(found.vertices, found.faces) == skin_of(part, side)


@pytest.mark.parametrize("name", ["pipe", "chamfered pipe", "flanged pipe", "stepped tube", "duct", "bobbin"])
def test_skins_of_parts_with_long_facets(name: str) -> None:
    part = OPEN[name](FACETS)
    for side in SIDES:
        found = mw.annulus(mesh_of(part), side=side)
        assert areas(found.vertices, found.faces).sum() == pytest.approx(part.area(SIDES[side]), rel=1e-9)


@pytest.mark.parametrize("name", ["ring", "chamfered pipe", "bobbin", "stepped tube", "elbow", "flanged elbow", "duct"])
def test_skins_do_not_depend_on_pose_scale_order_and_turned_faces(name: str) -> None:
    part = OPEN[name](COARSE)
    for seed, side in enumerate(SIDES):
        wall = mw.annulus(mesh_of(part), side=side).wall
        matrix, scale = rotation(seed), 10.0 ** (3 * seed - 2)
        vertices, faces = shuffled(moved((part.vertices, part.faces), matrix, 5.0 * matrix[0], scale), seed)
        for turned in (faces, faces[:, ::-1]):
            found = mw.annulus(mesh_from(vertices, turned), side=side)
            area = areas(found.vertices, found.faces).sum() / scale**2
            assert area == pytest.approx(part.area(SIDES[side]), rel=1e-9)
            assert found.wall is not None and wall is not None
            assert found.wall.thickness / scale == pytest.approx(wall.thickness, rel=1e-6)


@pytest.mark.parametrize(("side", "radius"), [("outer", 30.0), ("inner", 27.0)])
def test_area_rims_and_wall_of_a_pipe_are_exact(side: str, radius: float) -> None:
    around = GRID.around
    found = mw.annulus(mesh_of(pipe()), side=side)
    chord = 2.0 * radius * np.sin(np.pi / around)
    assert areas(found.vertices, found.faces).sum() == pytest.approx(120.0 * around * chord, rel=1e-12)
    polygon = 0.5 * around * radius**2 * np.sin(2.0 * np.pi / around)
    for rim in found.rims:
        assert loop_area(found.vertices, rim) == pytest.approx(polygon, rel=1e-12)
    assert found.wall is not None
    assert found.wall.thickness == pytest.approx(3.0 * np.cos(np.pi / around), rel=1e-9)  # between flat facets


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("around", [24, 48])
def test_a_bottle_is_opened_at_its_bottom_and_ends_at_its_mouth(side: str, around: int) -> None:
    part = bottle(grid=Grid(around))
    found = mw.annulus(mesh_of(part), side=side, opening=10.0)
    disc = np.pi * 10.0**2
    assert areas(found.vertices, found.faces).sum() == pytest.approx(part.area(SIDES[side]) - disc, rel=2e-4)
    heights = sorted(float(found.vertices[rim, 2].mean()) for rim in found.rims)
    assert heights == pytest.approx([0.0 if side == "outer" else 2.0, 130.0], abs=1e-9)
    assert found.wall is not None and found.wall.thickness == pytest.approx(2.0, rel=0.01)


@pytest.mark.parametrize("grid", [GRID, COARSE, UNEVEN], ids=["fine", "coarse", "uneven"])
def test_a_skin_ends_within_a_fillet(grid: Grid) -> None:
    part = filleted(grid=grid)
    for side, radius in (("outer", 30.0), ("inner", 24.0)):
        found = mw.annulus(mesh_of(part), side=side)
        quarter = 0.5 * np.pi * 2.0 * 2.0 * np.pi * radius
        area = areas(found.vertices, found.faces).sum()
        whole = part.area(SIDES[side])
        assert whole * 0.99 < area < whole + 1.5 * quarter  # none, or up to three quarters, of both fillets


def test_a_rough_part_is_cut_straight_just_below_its_rims() -> None:
    part = pipe()
    rough = part.vertices + np.random.default_rng(0).normal(size=part.vertices.shape) * 0.1
    found = mw.annulus(mesh_from(rough, part.faces))
    assert areas(found.vertices, found.faces).sum() == pytest.approx(part.area(OUTER), rel=0.04)
    for rim in found.rims:
        middle = found.vertices[rim] - found.vertices[rim].mean(axis=0)
        assert np.linalg.svd(middle)[1][2] < 1e-9 * 30.0


def test_parts_without_a_wall_are_wound_as_they_are() -> None:
    for part in (pear(), ball()):
        found = mw.annulus(mesh_from(*part))
        assert found.wall is None and not any("wall" in note for note in found.notes)
    with pytest.raises(mw.BadInputError, match="no wall, and so no inner skin"):
        mw.annulus(mesh_from(*pear()), side="inner")
    with pytest.raises(mw.BadInputError, match="give outer or inner"):
        mw.annulus(mesh_from(*pear()), side="left")


def test_check_lists_the_rims_of_the_wound_skin() -> None:
    part = flanged(grid=COARSE)
    for side, radius in (("outer", 45.0), ("inner", 27.0)):
        findings = check(mesh_of(part), side=side)
        assert findings.closed and findings.genus == 1 and findings.problem == ""
        assert findings.side == side and findings.wall == pytest.approx(3.0, rel=0.01)
        assert [rim.use for rim in findings.rims] in (["start", "end"], ["end", "start"])
        length = 2.0 * COARSE.around * radius * np.sin(np.pi / COARSE.around)
        assert [rim.length for rim in findings.rims] == pytest.approx([length, length], rel=1e-9)
        numbered = mw.annulus(mesh_of(part), ends="loops 1 0", side=side)
        assert numbered.vertices[numbered.rims[0], 2].mean() == pytest.approx(findings.rims[1].place[2])


def test_a_small_handle_is_closed_and_counted() -> None:
    part = tunnelled(blob(), 60.0, 1.0)
    assert genus(part.faces) == 1
    mesh = mesh_of(part)
    closed = [act for act in mesh.repairs if "small handle" in act]
    assert len(closed) == 1 and closed[0].startswith("closed 1 small handle, up to ")
    assert genus(mesh.faces) == 0 and mw.annulus(mesh).wall is None
    whole = blob()
    assert volume(mesh.vertices, mesh.faces) == pytest.approx(volume(whole.vertices, whole.faces), rel=2e-3)


def test_several_small_handles_are_closed_at_once() -> None:
    part = blob()
    for height, turn in ((20.0, 0.0), (60.0, np.pi / 4), (90.0, -np.pi / 3)):
        part = tunnelled(part, height, 1.0, turn)
    assert genus(part.faces) == 3
    vertices, faces, done = without_small_handles(part.vertices, part.faces)
    assert len(done) == 3 and genus(faces) == 0
    whole = blob()
    assert volume(vertices, faces) == pytest.approx(volume(whole.vertices, whole.faces), rel=5e-3)


@pytest.mark.parametrize("height", [50.0, 80.0])
def test_a_large_handle_is_refused_with_its_place_and_size(height: float) -> None:
    mesh = mesh_of(tunnelled(blob(), height, 12.0))
    assert not any("handle" in act for act in mesh.repairs)
    with pytest.raises(mw.BadInputError, match="cut the part open or fill the hole") as caught:
        mw.annulus(mesh)
    found = re.search(r"genus 1 .*: ([\d.]+) round at \((\S+), (\S+), (\S+)\)", str(caught.value))
    assert found is not None
    girth, *place = map(float, found.groups())
    assert girth == pytest.approx(4 * 12.0, rel=0.1)  # round the tunnel: shorter than any way through it
    assert place[2] == pytest.approx(height, abs=4.0) and abs(place[1]) < 2.0
