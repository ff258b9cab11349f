"""From a mesh to its annulus: ends, openings, rims, and what is refused."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import trimesh
from mesh_shapes import Part, assert_annulus, ball, box, cone, cup, joined, moved, pear, rotation, shuffled, tube

from meshwind.core.cast import Floats
from meshwind.core.errors import BadInputError
from meshwind.mesh import Annulus, annulus, mesh_from, read
from meshwind.mesh.geometry.areas_and_volumes import areas, perimeter, volume
from meshwind.mesh.geometry.topology import loops

DATA = Path(__file__).parents[1] / "data"


def trim(part: Part, ends: str = "auto", opening: float | None = None) -> Annulus:
    found = annulus(mesh_from(*part, name="part.stl"), ends, opening)
    assert_annulus(found)
    return found


def rim_points(found: Annulus) -> tuple[Floats, Floats]:
    return found.vertices[found.rims[0]], found.vertices[found.rims[1]]


def capsule() -> Part:
    """Radius 1 about z, domes about z = -0.5 and 0.5, its vertices exact."""
    mesh = trimesh.creation.capsule(height=1.0, radius=1.0, count=[60, 60])
    return np.asarray(mesh.vertices) - [0, 0, np.asarray(mesh.vertices)[:, 2].mean()], np.asarray(mesh.faces)


def dome() -> Part:
    """Half a ball below z = 0, open above, with its pole at z = -1."""
    vertices, faces = ball(4)
    centre = vertices[faces].mean(axis=1)
    return vertices, faces[centre[:, 2] < 0]


def punctured(part: Part, *faces: int) -> Part:
    return part[0], np.delete(part[1], faces, axis=0)


def without_patch(part: Part, centre: list[float], radius: float) -> Part:
    """The part with a hole of about the given radius."""
    near = np.linalg.norm(part[0][part[1]].mean(axis=1) - centre, axis=1) < radius
    return part[0], part[1][~near]


PARTS: dict[str, Callable[[], Part]] = {
    "pear": pear, "ball": ball, "cone": cone, "capsule": capsule, "dome": dome, "cup": cup,
    "box": lambda: box(size=(1, 1, 4)), "cylinder": lambda: tube(lambda z: 1 + 0 * z),
    "disc": lambda: moved(ball(), np.diag([3.0, 3.0, 0.5]), np.zeros(3), 1.0),
    "punctured tube": lambda: punctured(cone(), 200, 150, 438),
    "three holes": lambda: without_patch(cone(around=48, along=36), [0.8, 0, 1.5], 0.3),
}  # fmt: skip


@pytest.mark.parametrize("ends", ["auto", "z", "0,0,-9 0,0,9"])
@pytest.mark.parametrize("name", PARTS)
def test_every_part_gives_an_annulus_with_rims_in_the_sense_of_growing_u(name: str, ends: str) -> None:
    part = PARTS[name]()
    trim(part, ends)
    trim(moved(part, np.eye(3), np.zeros(3), 1e-6), ends.replace("9", "9e-6"))


@pytest.mark.parametrize("name", sorted(path.name for path in DATA.glob("*.*") if path.suffix != ".py"))
def test_sample_parts_give_an_annulus(name: str) -> None:
    assert_annulus(annulus(read(DATA / name)))


def test_start_rim_turns_so_that_u_times_v_points_outward() -> None:
    found = trim(cone(), "z")
    for rim in rim_points(found):
        step = np.roll(rim, -1, axis=0) - rim
        outward = np.cross(step, [0.0, 0.0, 1.0])
        assert (np.einsum("ij,ij->i", outward, rim) > 0).all()


def test_open_part_is_kept_as_it_is() -> None:
    vertices, faces = cone()
    found = trim((vertices, faces))
    assert np.array_equal(found.vertices, vertices) and np.array_equal(found.faces, faces)
    assert found.trusted.all()
    assert found.mesh.repairs == ()


def test_the_longer_rim_is_the_start_and_an_axis_starts_below() -> None:
    vertices, faces = cone()
    upside_down = vertices * [1, -1, -1], faces
    assert rim_points(trim((vertices, faces)))[0][:, 2].max() == 0.0
    assert rim_points(trim(upside_down))[0][:, 2].max() == 0.0
    assert rim_points(trim(upside_down, "z"))[0][:, 2].max() == -3.0
    assert rim_points(trim((vertices, faces), "0,0,3 0,0,0"))[0][:, 2].min() == 3.0


def test_alike_rims_start_at_the_fuller_end() -> None:
    vertices, faces = tube(lambda z: 1.0 + 0.4 * z * (3 - z) ** 2 / 4)
    for sign in (1, -1):
        assert rim_points(trim((vertices * [1, sign, sign], faces)))[0][:, 2].max() == 0.0
    straight = tube(lambda z: 1.0 + 0 * z)
    assert rim_points(trim(straight))[0][:, 2].max() == 0.0


def test_capsule_has_its_poles_on_the_axis_and_its_rims_on_the_true_dome() -> None:
    found = trim(capsule(), opening=0.25)
    made = found.vertices[~found.trusted]
    assert np.abs(np.linalg.norm(made - [0, 0, 0.5] * np.sign(made), axis=1) - 1).max() < 1e-5
    for rim, pole in zip(rim_points(found), (-1.5, 1.5), strict=True):
        radius = np.linalg.norm(rim - [0, 0, pole], axis=1)
        assert np.abs(radius - 0.25).max() < 1e-14


@pytest.mark.parametrize("radius", [0.1, 0.2, 0.5, 0.9])
def test_rims_lie_at_the_opening_radius_to_round_off(radius: float) -> None:
    part = pear()
    tips = [part[0][pick(part[0][:, 2])] for pick in (np.argmin, np.argmax)]
    found = trim(part, " ".join(",".join(repr(float(x)) for x in tip) for tip in tips), radius)
    for rim, pole in zip(rim_points(found), tips, strict=True):
        assert np.abs(np.linalg.norm(rim - pole, axis=1) - radius).max() < 1e-14
        assert len(rim) >= 10


def test_new_vertices_lie_nearer_to_the_true_surface_than_the_facets() -> None:
    errors = []
    for subdivisions in (2, 3, 4):
        found = trim(ball(subdivisions), "0,0,-1 0,0,1", 0.4)
        made = found.vertices[~found.trusted]
        sagitta = 1 - np.cos(1.107 / 2**subdivisions / 2)
        errors.append(np.abs(np.linalg.norm(made, axis=1) - 1).max())
        assert len(made) > 8 and errors[-1] < 0.03 * sagitta
    assert min(errors[0] / errors[1], errors[1] / errors[2]) > 12  # fourth order is 16


def test_flat_ends_stay_flat_and_creases_unbent() -> None:
    part = trimesh.creation.cylinder(radius=1.0, height=4.0, sections=40)
    found = trim((np.asarray(part.vertices), np.asarray(part.faces)))
    for rim, z in zip(rim_points(found), (-2.0, 2.0), strict=True):
        assert np.abs(rim[:, 2] - z).max() < 1e-15 and len(rim) >= 24
        assert np.ptp(np.linalg.norm(rim[:, :2], axis=1)) < 1e-14
    bevel = trimesh.creation.cone(radius=1.0, height=0.4, sections=40)  # 22 degrees: a mild crease at the base
    rim = rim_points(trim((np.asarray(bevel.vertices), np.asarray(bevel.faces)), "z", 0.3))[0]
    assert np.abs(rim[:, 2]).max() < 1e-15


def test_a_box_of_twelve_triangles_gets_round_openings() -> None:
    found = trim(box(size=(1, 1, 4)), opening=0.2)
    for rim, z in zip(rim_points(found), (0.0, 4.0), strict=True):
        assert len(rim) >= 12
        assert np.abs(np.linalg.norm(rim - [0.5, 0.5, z], axis=1) - 0.2).max() < 1e-14


def test_only_vertices_that_trimming_made_are_untrusted() -> None:
    vertices, faces = pear()
    found = trim((vertices, faces))
    given = {tuple(point) for point in vertices}
    assert all((tuple(point) in given) == kept for point, kept in zip(found.vertices, found.trusted, strict=True))
    assert (~found.trusted).sum() < 0.2 * len(vertices)


def test_cut_leaves_no_slivers() -> None:
    found = trim(ball(4), opening=0.3)
    new = ~found.trusted[found.faces].all(axis=1)
    edge = np.linalg.norm(found.vertices[found.faces] - np.roll(found.vertices[found.faces], 1, axis=1), axis=2)
    assert new.sum() > 40 and edge[new].min() > 0.02 * edge.mean()


def test_dome_has_its_open_rim_and_its_pole() -> None:
    found = trim(dome())
    start, end = rim_points(found)
    assert np.abs(start[:, 2]).max() < 0.06 and end[:, 2].max() < -0.9
    assert np.linalg.norm(end.mean(axis=0)[:2]) < 5e-3
    assert rim_points(trim(dome(), "z"))[0][:, 2].max() < -0.9
    assert "the open rim" in found.ends


def test_disc_shaped_part_is_wound_about_its_short_axis() -> None:
    turn = rotation(3)
    found = trim(moved(ball(), turn @ np.diag([3.0, 3.0, 0.5]), np.zeros(3), 1.0))
    axis = rim_points(found)[1].mean(axis=0) - rim_points(found)[0].mean(axis=0)
    assert abs(axis @ turn[:, 2]) / np.linalg.norm(axis) > 1 - 1e-6


def test_an_opening_keeps_clear_of_the_other_end() -> None:
    thin = moved(ball(), np.diag([3.0, 3.0, 0.05]), np.zeros(3), 1.0)
    found = trim(thin)
    assert [rim[:, 2].mean() > 0 for rim in rim_points(found)] == [False, True]
    with pytest.raises(BadInputError, match=r"opening 0\.9 is too large"):
        trim(pear(), "0,-1,0 0.5,-1,0", 0.9)


def test_ragged_cup_is_cut_below_its_lip() -> None:
    vertices, faces = cup()
    found = trim((vertices + np.random.default_rng(1).normal(size=vertices.shape) * [0.01, 0.01, 0.02], faces))
    lip = next(rim for rim in rim_points(found) if rim[:, 2].min() > 1)
    assert lip[:, 2].min() > 0.9 * 3.0 and np.ptp(lip @ lip_normal(lip)) < 1e-9


def lip_normal(rim: Floats) -> Floats:
    """Unit normal of the plane through a rim."""
    return np.asarray(np.linalg.svd(rim - rim.mean(axis=0))[2][2])


def test_cup_ends_at_its_lip_without_its_lining() -> None:
    found = trim(cup())
    assert np.linalg.norm(found.vertices[:, :2], axis=1).max() == pytest.approx(1.0, abs=1e-12)
    side = found.vertices[:, 2] > 1e-9
    assert np.linalg.norm(found.vertices[side][:, :2], axis=1).min() > 0.95
    lip = next(rim for rim in rim_points(found) if rim[:, 2].min() > 1)
    ring = cup()[0][(cup()[0][:, 2] == 3.0) & (np.linalg.norm(cup()[0][:, :2], axis=1) > 0.95)]
    assert set(map(tuple, lip.tolist())) == set(map(tuple, ring.tolist()))  # the outer skin's own rim
    assert found.wall is not None and found.wall.thickness == pytest.approx(0.1, rel=0.02)


def test_holes_that_are_not_ends_are_filled_and_reported() -> None:
    whole = trim(cone())
    pinholes = trim(punctured(cone(), 200, 150, 438))
    assert "filled 1 hole of missing faces" in pinholes.ends and "filled 1 other open rim" in pinholes.ends
    assert (~pinholes.trusted).sum() == 1  # a missing face comes back as it was
    big = trim(without_patch(cone(around=48, along=36), [0.8, 0, 1.5], 0.3))
    assert "filled 1 other open rim" in big.ends and len(loops(big.mesh.faces)) == 3
    for found in (pinholes, big):
        area = areas(found.vertices, found.faces).sum()
        assert area == pytest.approx(areas(whole.vertices, whole.faces).sum(), rel=0.02)


def test_points_choose_among_three_rims() -> None:
    part = without_patch(cone(around=48, along=36), [0.85, 0, 1.5], 0.3)
    start, end = rim_points(trim(part, "1,0,1.5 0,0,3"))
    assert start[:, 0].min() > 0.4 and end[:, 2].min() == 3.0


def test_missing_face_of_a_closed_part_is_not_an_end() -> None:
    found = trim(punctured(pear(), 640))
    assert "filled 1 hole" in found.ends and "poles on" in found.ends


@pytest.mark.parametrize("name", ["pear", "cone", "dome", "cup"])
def test_the_same_annulus_in_any_pose_scale_and_order(name: str) -> None:
    part = PARTS[name]()
    part = part[0] + 1e-3 * np.sin(3 * part[0][:, [1, 2, 0]] + 1), part[1]  # no part has an exact symmetry
    first = trim(part)
    for seed in range(3):
        matrix, shift, scale = rotation(seed), np.array([3.0, -7.0, 2.0]) * seed, 10.0 ** (seed - 1)
        second = trim(shuffled(moved(part, matrix, shift, scale), seed))
        assert (len(second.vertices), len(second.faces)) == (len(first.vertices), len(first.faces))
        back = (second.vertices - shift) @ matrix / scale
        for one, two in zip(first.rims, second.rims, strict=True):
            assert perimeter(back, two) == pytest.approx(perimeter(first.vertices, one), rel=1e-6)
            assert np.abs(back[two].mean(axis=0) - first.vertices[one].mean(axis=0)).max() < 1e-6
        assert volume(back, second.faces) == pytest.approx(volume(first.vertices, first.faces), rel=1e-6)


def test_runs_are_identical() -> None:
    first, second = (trim(pear()) for _ in range(2))
    assert np.array_equal(first.vertices, second.vertices) and np.array_equal(first.faces, second.faces)
    assert not first.vertices.flags.writeable and not first.rims[0].flags.writeable
    assert first.ends == second.ends


def torus() -> Part:
    mesh = trimesh.creation.torus(major_radius=2.0, minor_radius=0.5)
    return np.asarray(mesh.vertices), np.asarray(mesh.faces)


def sheet() -> Part:
    x, y = np.meshgrid(np.arange(5.0), np.arange(5.0))
    low = (np.arange(4)[:, None] * 5 + np.arange(4)).ravel()
    faces = [np.column_stack([low, low + 1, low + 6]), np.column_stack([low, low + 6, low + 5])]
    return np.column_stack([x.ravel(), y.ravel(), 0 * x.ravel()]), np.concatenate(faces)


REFUSED: dict[str, tuple[Callable[[], Part], str, float | None, str]] = {
    "torus": (torus, "auto", None, r"part.stl: genus 1 \(a handle or a hole right through\): .*; cut the part open"),
    "open torus": (lambda: without_patch(torus(), [2.5, 0, 0], 0.4), "auto", None, "genus 1 .*; cut the part open"),
    "triangle": (lambda: (np.eye(3), np.array([[0, 1, 2]])), "auto", None, r"is flat \(1 triangle .*; give the whole"),
    "sheet": (sheet, "auto", None, "is flat .*; give the whole surface"),
    "word": (pear, "up", None, "ends 'up': give auto, x, y, z or two points"),
    "empty": (pear, "", None, "ends '': give auto"),
    "one point": (pear, "0,0,0", None, "give auto, x, y, z or two points"),
    "four numbers": (pear, "0,0,0,1 0,0,1,1", None, "give auto, x, y, z or two points"),
    "nan": (pear, "0,0,0 0,nan,1", None, "give auto, x, y, z or two points"),
    "same point": (pear, "0,0,1 0,0,1", None, "the two points are the same; give one at each end"),
    "one nearest point": (pear, "0,0,30 0,0,40", None, "both ends are at the same point, .*; give ends further apart"),
    "no radius": (pear, "auto", 0.0, "opening 0.0: give the radius"),
    "negative": (pear, "auto", -1.0, "opening -1.0: give the radius"),
    "nan radius": (pear, "auto", float("nan"), "opening nan: give the radius"),
    "small": (pear, "auto", 1e-4, r"opening 0.0001 is too small at \(.*\); give a radius between [\d.]+ and [\d.]+"),
    "large": (pear, "auto", 2.6, r"opening 2.6 is too large at \(.*\); give a radius between [\d.]+ and [\d.]+"),
    "beyond": (pear, "auto", 1e9, r"opening 1e\+09 is too large at \(.*\); give a radius between"),
    "over the rim": (dome, "auto", 1.5, "opening 1.5 is too large"),
}  # fmt: skip


@pytest.mark.parametrize("case", REFUSED)
def test_what_cannot_be_trimmed_is_refused_in_one_line(case: str) -> None:
    part, ends, opening, words = REFUSED[case]
    mesh = mesh_from(*part(), name="part.stl")
    with pytest.raises(BadInputError, match=words) as caught:
        annulus(mesh, ends, opening)
    assert "\n" not in str(caught.value)


def test_the_range_in_a_refusal_is_allowed() -> None:
    part = pear()
    with pytest.raises(BadInputError) as caught:
        trim(part, opening=9.0)
    low, high = (float(word) for word in str(caught.value).split("between ")[1].split(" and "))
    for radius in (1.01 * low, 0.97 * high):
        trim(part, opening=radius)


def test_genus_two_is_counted() -> None:
    ring = torus()[0], torus()[1]
    cut = without_patch(ring, [2.5, 0, 0], 0.4)
    other = without_patch(moved(ring, np.diag([-1.0, -1.0, 1.0]), np.array([6.0, 0, 0]), 1.0), [3.5, 0, 0], 0.4)
    first, second = (loops(mesh_from(*part).faces)[0] for part in (cut, other))
    one, two = mesh_from(*cut), mesh_from(*other)
    vertices, faces = joined((one.vertices, one.faces), (two.vertices, two.faces))
    bridge = np.stack([first, np.roll(second[::-1] + len(one.vertices), 0)])
    assert len(first) == len(second)
    a, b = bridge
    wall = [np.column_stack([np.roll(a, -1), a, b]), np.column_stack([np.roll(a, -1), b, np.roll(b, -1)])]
    with pytest.raises(BadInputError, match="genus 2"):
        annulus(mesh_from(vertices, np.concatenate([faces, *wall])))


NEARLY: dict[str, Callable[[], Part]] = {
    "nearly round": lambda: moved(ball(), np.diag([1.0, 1.003, 1.008]), np.zeros(3), 1.0),
    "hardly fuller below": lambda: tube(lambda z: 1.0 - 1e-4 * z),
    "as long, flared above": lambda: tube(lambda z: 1.0 + 1e-4 * np.sin(2 * np.pi * z / 3.0)),
}


@pytest.mark.parametrize("name", NEARLY)
def test_a_slight_asymmetry_of_the_part_outweighs_its_pose(name: str) -> None:
    part = NEARLY[name]()
    if name == "nearly round":  # a ball of one axis has no fuller end
        part = part[0] * (1 + 0.002 * part[0][:, [2]]), part[1]
    first = [rim.mean(axis=0) for rim in rim_points(trim(part))]
    for seed in range(4):
        matrix, shift = rotation(seed), np.array([3.0, -7.0, 2.0]) * seed
        second = [(rim.mean(axis=0) - shift) @ matrix for rim in rim_points(trim(moved(part, matrix, shift, 1.0)))]
        assert np.abs(np.array(first) - second).max() < 1e-3
