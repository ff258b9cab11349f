"""Abaqus and CalculiX decks are read as written: blocks, parts, instances, coordinates, elements, and lines."""

from itertools import product
from pathlib import Path

import numpy as np
import pytest

import meshwind as mw
from meshwind.core.errors import BadInputError
from meshwind.mesh.geometry.areas_and_volumes import areas, volume
from meshwind.mesh.io.deck.blocks import blocks
from meshwind.mesh.io.deck.deck import read_deck
from meshwind.mesh.io.deck.elements import SECTION, cell_kind, cells_of

AROUND, RINGS = 8, 6
_HEIGHT = np.repeat(np.linspace(0.0, 90.0, RINGS), AROUND)
_TURN = np.tile(np.arange(AROUND) * 360.0 / AROUND, RINGS)
_RADIUS = 20.0 + 5.0 * np.sin(np.pi * _HEIGHT / 90.0)
POINTS = np.column_stack([_RADIUS * np.cos(np.radians(_TURN)), _RADIUS * np.sin(np.radians(_TURN)), _HEIGHT])
_FIRST, _NEXT = np.arange(AROUND), (np.arange(AROUND) + 1) % AROUND
_RING = np.column_stack([_FIRST, _NEXT, _NEXT + AROUND, _FIRST + AROUND])
QUADS = np.concatenate([_RING + ring * AROUND for ring in range(RINGS - 1)])
FACES = np.concatenate([QUADS[:, :3], QUADS[:, [0, 2, 3]]])
AREA = float(areas(POINTS, FACES).sum())


def rows(table: np.ndarray, first: int = 1, ids: np.ndarray | None = None) -> str:
    """Lines of data: numbers from `first` on, or those given, and the table."""
    numbers = np.arange(first, first + len(table)) if ids is None else ids
    return "".join(
        f"{k}, " + ", ".join(f"{value:.17g}" for value in row) + "\n" for k, row in zip(numbers, table, strict=True)
    )


NODES = "*Node\n" + rows(POINTS)
QUAD_ROWS = rows(QUADS + 1)
BARREL = NODES + "*Element, type=S4R\n" + QUAD_ROWS


def deck(folder: Path, text: str | bytes) -> Path:
    path = folder / "part.inp"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def refusal(folder: Path, text: str | bytes) -> str:
    with pytest.raises(BadInputError) as caught:
        mw.read(deck(folder, text))
    words = str(caught.value)
    assert words.startswith("part.inp: ") and "\n" not in words and "; " in words and len(words) < 400
    return words


def check_barrel(path: Path, units: str = "") -> None:
    mesh = mw.read(path)
    assert len(mesh.faces) == len(FACES) and mesh.warnings == () and mesh.units == units
    assert areas(mesh.vertices, mesh.faces).sum() == pytest.approx(AREA, rel=1e-12)
    assert np.ptp(mesh.vertices, axis=0) == pytest.approx(np.ptp(POINTS, axis=0), rel=1e-12)


def _tabbed(text: str) -> str:
    return "".join("\t" + line.replace(", ", "\t,\t") + " \t\n" for line in text.splitlines())


def _remarked(text: str) -> str:
    return "".join(f"** remark, 1, 2\n{line}\n\n   \n" for line in text.splitlines())


def _wrapped(text: str) -> str:
    """Elements over two lines, and keywords that go on."""
    lines = text.replace("*Element, ", "*Element,\n  ").splitlines()
    at = next(k for k, line in enumerate(lines) if "type" in line.lower())
    return "\n".join(lines[: at + 1] + [",\n".join(line.rsplit(", ", 2)[:2]) + f", {line.rsplit(', ', 1)[1]}"
                                        for line in lines[at + 1 :]]) + "\n"  # fmt: skip


WAYS = {
    "plain": BARREL,
    "two blocks of nodes": f"*Node, nset=A\n{rows(POINTS[:20])}*NODE, NSET=B\n{rows(POINTS[20:], 21)}"
                           f"*Element, type=S4R\n{QUAD_ROWS}",
    "two blocks of elements": f"{NODES}*Element, type=S4\n{rows(QUADS[:9] + 1)}*ELEMENT,TYPE=S4R5,ELSET=x\n"
                              f"{rows(QUADS[9:] + 1, 10)}",
    "elements before nodes": f"*Element, type=S4R\n{QUAD_ROWS}{NODES}",
    "mass": f"{BARREL}*Element, type=MASS, elset=m\n900, 1\n*Mass, elset=m\n0.5\n",
    "beams and springs": f"{BARREL}*ELEMENT, TYPE=B31\n901, 1, 2\n*ELEMENT,TYPE=SPRINGA\n902, 3, 4\n"
                         "*ELEMENT, TYPE=CONN3D2\n903, , 5\n*ELEMENT, TYPE=PIPE32\n904, 1, 2, 3\n"
                         "*ELEMENT, TYPE=ROTARYI\n905, 7\n",
    "output requests": f"{BARREL}*NODE PRINT, NSET=a\nU\n*EL PRINT, ELSET=b\nS\n*Node Output\nU, RF\n"
                       "*ELEMENT OUTPUT\nS\n*NODE FILE\nU\n",
    "generated sets": f"*NSET, NSET=a, GENERATE\n1, 48, 1\n{BARREL}*ELSET, ELSET=b, GENERATE\n1, 40\n"
                      "*Transform, nset=a\n1, 0, 0, 0, 1, 0\n",
    "capitals": BARREL.upper(),
    "lower case": BARREL.lower(),
    "shortened": BARREL.replace("*Element, type", "*ELEM, TYP"),
    "as CalculiX takes it": BARREL.replace("*Element", "*ELEMENTS").replace("*Node", "*NODES"),
    "blanks in keywords": BARREL.replace("*Node", "  * NODE ").replace("type=S4R", " Type = s4r , elset = a b"),
    "tabs": _tabbed(BARREL),
    "remarks and blank lines": _remarked(BARREL),
    "wrapped": _wrapped(BARREL),
    "a comma too many": BARREL.replace("*Node\n", "*Node,\n").replace("\n", ",\n").replace("S4R,", "S4R"),
    "other normals": f"*Node\n{rows(np.column_stack([POINTS, POINTS]))}*Element, type=S4R\n{QUAD_ROWS}",
    "empty blocks": f"*Node\n*Element, type=S4\n{BARREL}*Node\n*Element, type=C3D8\n",
    "quotes": f'*Part, name="a part, of 2"\n{BARREL}*End Part\n*Assembly, name="A"\n'
              '*Instance, name=I, part="a part, of 2"\n*End Instance\n*End Assembly\n',
    "a star in the heading": f"*Heading\n 5 * 6, not a keyword\n{BARREL}",
    "a keyword like another": f"{BARREL}*Rigid Body, elset=a, ref node=1\n*Model change, remove\n*Orientation, name=o, "
                              "system=cylindrical\n0,0,0, 0,0,1\n",
}  # fmt: skip
WAYS["exponents of Fortran"] = (
    "*Node\n"
    + "".join(
        f"{k + 1}, "
        + ", ".join(f"{value:.16e}".replace("e", mark) for value, mark in zip(point, "DdE", strict=True))
        + "\n"
        for k, point in enumerate(POINTS)
    )
    + f"*Element, type=S4R\n{QUAD_ROWS}"
)


@pytest.mark.parametrize(("way", "end"), list(product(WAYS, ("\n", "\r\n"))))
def test_one_barrel_in_many_ways(way: str, end: str, tmp_path: Path) -> None:
    check_barrel(deck(tmp_path, WAYS[way].replace("\n", end).encode()))


def test_marks_of_byte_order_and_old_line_ends(tmp_path: Path) -> None:
    for content in (b"\xef\xbb\xbf" + BARREL.encode(), BARREL.encode("utf-16"), BARREL.replace("\n", "\r").encode()):
        check_barrel(deck(tmp_path, content))


@pytest.mark.parametrize("unit", ["mm", "in"])
def test_the_unit_of_a_deck_of_meshwind(unit: str, tmp_path: Path) -> None:
    check_barrel(deck(tmp_path, f"*HEADING\nmeshwind\n** lengths in {unit}, forces in N\n{BARREL}"), unit)


def test_numbers_may_be_sparse_and_huge(tmp_path: Path) -> None:
    ids = 9_000_000_000 - 123_456_789 * np.arange(len(POINTS))
    check_barrel(deck(tmp_path, f"*NODE\n{rows(POINTS, ids=ids)}*ELEMENT, TYPE=S4\n{rows(ids[QUADS], 10**9)}"))


def test_missing_coordinates_are_zero(tmp_path: Path) -> None:
    text = "*NODE\n1\n2, 1.5-1,\n3, , 2.\n4, ,, 3.\n*ELEMENT, TYPE=C3D4\n1, 1,2,3,4\n"
    mesh = read_deck(deck(tmp_path, text))
    assert mesh.vertices == pytest.approx(np.diag([0.0, 0.15, 2.0, 3.0])[:, 1:])


CYLINDRICAL = np.column_stack([_RADIUS, np.where(_TURN > 180.0, _TURN - 360.0, _TURN), _HEIGHT])
_FAR = np.hypot(_RADIUS, _HEIGHT)
SPHERICAL = np.column_stack([_FAR, _TURN, np.degrees(np.arctan2(_HEIGHT, _RADIUS))])
_AXES = np.linalg.qr(np.array([[2.0, 1.0, 0.5], [-1.0, 3.0, 1.0], [0.3, -0.7, 2.0]]))[0]
AXES = _AXES * np.sign(np.linalg.det(_AXES))
ORIGIN = np.array([7.0, -20.0, 400.0])


def _points(*points: np.ndarray) -> str:
    return ", ".join(f"{value:.17g}" for point in points for value in point)


@pytest.mark.parametrize(("word", "given"), [
    ("C", CYLINDRICAL), ("c", CYLINDRICAL), ("Cylindrical", CYLINDRICAL), ("S", SPHERICAL), ("R", POINTS),
])  # fmt: skip
def test_coordinates_of_nodes(word: str, given: np.ndarray, tmp_path: Path) -> None:
    text = f"*NODE, NSET=a, SYSTEM={word}\n{rows(given)}*ELEMENT, TYPE=S4\n{QUAD_ROWS}"
    assert read_deck(deck(tmp_path, text)).vertices == pytest.approx(POINTS, abs=1e-12)
    text = f"*SYSTEM\n{_points(ORIGIN)}\n{text}"  # the local system acts after the node's own
    assert read_deck(deck(tmp_path, text)).vertices == pytest.approx(POINTS + ORIGIN, abs=1e-12)


def test_a_local_system_until_the_next(tmp_path: Path) -> None:
    local = (POINTS[:20] - ORIGIN) @ AXES
    on_x, in_plane = ORIGIN + 3.0 * AXES[:, 0], ORIGIN + 0.5 * AXES[:, 0] + 2.0 * AXES[:, 1]
    text = (f"*SYSTEM\n{_points(ORIGIN, on_x)}\n{_points(in_plane)}\n*NODE\n{rows(local)}*SYSTEM\n*NODE\n"
            f"{rows(POINTS[20:], 21)}*ELEMENT, TYPE=S4\n{QUAD_ROWS}")  # fmt: skip
    assert read_deck(deck(tmp_path, text)).vertices == pytest.approx(POINTS, abs=1e-9)


def test_a_local_system_of_two_points_keeps_the_z_axis(tmp_path: Path) -> None:
    text = f"*SYSTEM\n1., 2., 3., 1., 7., 9.\n*NODE\n{rows(POINTS)}*ELEMENT, TYPE=S4\n{QUAD_ROWS}"
    turned = np.column_stack([-POINTS[:, 1], POINTS[:, 0], POINTS[:, 2]]) + [1.0, 2.0, 3.0]
    assert read_deck(deck(tmp_path, text)).vertices == pytest.approx(turned, abs=1e-12)
    assert "*SYSTEM in line 1" in refusal(tmp_path, "*SYSTEM\n0,0,0, 0,0,5\n" + BARREL)


def test_a_local_system_ends_with_its_part(tmp_path: Path) -> None:
    parts = "".join(f"*PART, NAME={name}\n{system}{BARREL}*END PART\n" for name, system in
                    (("A", "*SYSTEM\n0, 0, 500\n"), ("B", "")))  # fmt: skip
    for text in (parts, parts.replace("*END PART\n", "")):
        held = read_deck(deck(tmp_path, text + assembly("part=A\n", "part=b\n")))
        assert held.vertices == pytest.approx(np.concatenate([POINTS + [0, 0, 500], POINTS]))


def assembly(*instances: str) -> str:
    uses = "".join(f"*Instance, name=I{k}, {each}*End Instance\n" for k, each in enumerate(instances))
    return f"*Assembly, name=Assembly\n{uses}*End Assembly\n"


LINER = f"*Part, name=Liner\n{BARREL}*End Part\n"
BOSS = f"*Part, name=Boss\n*Node\n{rows(POINTS * 0.3)}*Element, type=S4\n{QUAD_ROWS}*End Part\n"


def test_parts_have_numbers_of_their_own(tmp_path: Path) -> None:
    path = deck(tmp_path, LINER + BOSS + assembly("part=LINER\n", "part=boss\n0., 0., 300.\n"))
    for piece, points in enumerate((POINTS, POINTS * 0.3 + [0, 0, 300])):
        mesh = mw.read(path, piece)
        assert len(mesh.faces) == len(FACES) and mesh.warnings == ()
        assert mesh.vertices.min(axis=0) == pytest.approx(points.min(axis=0))
        assert mesh.vertices.max(axis=0) == pytest.approx(points.max(axis=0))


def test_an_instance_is_moved_then_turned(tmp_path: Path) -> None:
    turn = "part=Liner\n500., 0., 0.\n500., 0., 0., 500., 1., 0., 90.\n"  # about an axis along y
    about_y = np.column_stack([POINTS[:, 2] + 500.0, POINTS[:, 1], -POINTS[:, 0]])
    assert read_deck(deck(tmp_path, LINER + assembly(turn))).vertices == pytest.approx(about_y, abs=1e-9)
    turn = "part=Liner\n5., 0., 0.\n0., 0., 0., 0., 0., 1., 90.\n"  # an axis off the instance
    about_z = np.column_stack([-POINTS[:, 1], POINTS[:, 0] + 5.0, POINTS[:, 2]])
    assert read_deck(deck(tmp_path, LINER + assembly(turn))).vertices == pytest.approx(about_z, abs=1e-9)
    turn = "part=Liner\n0., 0., 0.\n10., 0., 0., 10., 0., -2., 120.\n"  # the axis downwards
    c, s = np.cos(np.radians(-120.0)), np.sin(np.radians(-120.0))
    x = POINTS - [10.0, 0.0, 0.0]
    about = np.column_stack([c * x[:, 0] - s * x[:, 1] + 10.0, s * x[:, 0] + c * x[:, 1], x[:, 2]])
    assert read_deck(deck(tmp_path, LINER + assembly(turn))).vertices == pytest.approx(about, abs=1e-9)


@pytest.mark.parametrize("first", ["\n", ",,\n", " 0., 0., 0.\n", "** turned only\n,\n"])
def test_an_instance_that_is_turned_only(first: str, tmp_path: Path) -> None:
    turn = f"part=Liner\n{first}0., 0., 0., 0., 1., 0., 90.\n"
    about_y = np.column_stack([POINTS[:, 2], POINTS[:, 1], -POINTS[:, 0]])
    assert read_deck(deck(tmp_path, LINER + assembly(turn))).vertices == pytest.approx(about_y, abs=1e-9)


def test_an_instance_of_one_line_that_is_no_translation_is_refused(tmp_path: Path) -> None:
    turn = "part=Liner\n0., 0., 0., 0., 1., 0., 90.\n"
    assert "has more numbers than a translation and a rotation" in refusal(tmp_path, LINER + assembly(turn))


def test_a_part_used_twice_and_nodes_of_the_assembly(tmp_path: Path) -> None:
    uses = assembly("part=Liner\n", "part=Liner\n0., 0., 200.\n").replace("*End Assembly", "*Node\n1, 9., 9., 9.\n"
                    "*Element, type=MASS\n1, 1\n*Nset, nset=s, instance=I0\n1, 2\n*End Assembly")  # fmt: skip
    held = read_deck(deck(tmp_path, LINER + uses))
    assert held.vertices == pytest.approx(np.concatenate([POINTS, POINTS + [0, 0, 200]]))
    assert areas(held.vertices, held.faces).sum() == pytest.approx(2.0 * AREA) and held.warnings == ()


def test_an_instance_with_a_mesh_of_its_own(tmp_path: Path) -> None:
    whole = f"*Part, name=P\n*End Part\n{assembly(f'part=P{chr(10)}0., 0., 50.{chr(10)}{BARREL}')}"
    assert read_deck(deck(tmp_path, whole)).vertices == pytest.approx(POINTS + [0, 0, 50])
    cells = f"*Part, name=P\n{NODES}*End Part\n" + assembly(f"part=P\n0.,0.,50.\n*Element, type=S4\n{QUAD_ROWS}")
    assert read_deck(deck(tmp_path, cells)).vertices == pytest.approx(POINTS + [0, 0, 50])


def test_parts_without_an_instance(tmp_path: Path) -> None:
    held = read_deck(deck(tmp_path, LINER + BOSS + assembly("part=boss\n")))
    assert len(held.faces) == len(FACES)
    assert held.warnings == ("parts that no instance uses are left out: Liner",)
    held = read_deck(deck(tmp_path, LINER + BOSS))
    assert len(held.faces) == 2 * len(FACES)
    assert held.warnings == ("no instance uses a part; they are read where they are written: Liner, Boss",)


def test_parts_that_are_missing_or_double(tmp_path: Path) -> None:
    assert "'CASING', which is not in the deck" in refusal(tmp_path, LINER + assembly("part=Casing\n"))
    assert "second of the name 'LINER'" in refusal(tmp_path, LINER + LINER.replace("Liner", "LINER"))
    assert "earlier analysis" in refusal(tmp_path, LINER + assembly("instance=old\n"))
    assert "axis of no length" in refusal(tmp_path, LINER + assembly("part=Liner\n0.,0.,0.\n1.,1.,1.,1.,1.,1.,5.\n"))


HEX20 = np.array([[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1], [-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1],
                  [0, -1, -1], [1, 0, -1], [0, 1, -1], [-1, 0, -1], [0, -1, 1], [1, 0, 1], [0, 1, 1], [-1, 0, 1],
                  [-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0], [0, 0, 0], [0, 0, -1], [0, 0, 1], [0, -1, 0],
                  [1, 0, 0], [0, 1, 0], [-1, 0, 0]])  # fmt: skip


@pytest.mark.parametrize(("count", "comma"), [(20, ","), (20, ""), (21, ","), (24, ","), (27, ","), (27, "")])
def test_elements_over_several_lines(count: int, comma: str, tmp_path: Path) -> None:
    name = "C3D20R" if count == 20 else "C3D27"
    first, second = np.arange(1, count + 1), np.arange(101, count + 101)
    lines = ""
    for number, nodes in ((1, first), (2, second)):
        words = [str(each) for each in (number, *nodes)]
        lines += (
            ", ".join(words[:11]) + comma + "\n" + ", ".join(words[11:16]) + comma + "\n" + ",".join(words[16:]) + "\n"
        )
    text = f"*NODE\n{rows(HEX20[:count])}{rows(HEX20[:count] + [5, 0, 0], 101)}*ELEMENT, TYPE={name}\n{lines}"
    mesh = mw.read(deck(tmp_path, text))
    assert volume(mesh.vertices, mesh.faces) == pytest.approx(8.0)
    assert mesh.vertices.max() == 1.0  # both are as large; the first is taken


def test_middle_nodes_of_a_hexahedron_are_in_the_order_of_vtk() -> None:
    line = "1, " + ", ".join(str(k + 1) for k in range(27))
    block = next(blocks(f"*ELEMENT, TYPE=C3D27\n{line}\n".encode(), "part.inp"))
    middle = HEX20[cells_of(block, "hexahedron27")[0].nodes[0, 20:] - 1]
    assert middle.tolist() == [[-1, 0, 0], [1, 0, 0], [0, -1, 0], [0, 1, 0], [0, 0, -1], [0, 0, 1], [0, 0, 0]]


SKINS = {
    "C3D4": (4, [0, 1, 3, 4], 4 / 3), "C3D8I": (8, list(range(8)), 8.0), "C3D6": (6, [0, 1, 2, 4, 5, 6], 4.0),
    "SC8R": (8, list(range(8)), 8.0), "DC3D8E": (8, list(range(8)), 8.0), "AC3D8R": (8, list(range(8)), 8.0),
}  # fmt: skip


@pytest.mark.parametrize("name", SKINS)
def test_skins_of_solids(name: str, tmp_path: Path) -> None:
    count, nodes, size = SKINS[name]
    text = f"*NODE\n{rows(HEX20[nodes])}*ELEMENT, TYPE={name}\n1, {', '.join(str(k + 1) for k in range(count))}\n"
    mesh = mw.read(deck(tmp_path, text))
    assert volume(mesh.vertices, mesh.faces) == pytest.approx(size) and mesh.warnings == ()


@pytest.mark.parametrize("name", ["CPS4", "CPE4R", "CPEG4", "M3D4R", "R3D4", "SFM3D4", "DS4", "S4RSW", "s4rt"])
def test_plane_elements_are_surfaces(name: str, tmp_path: Path) -> None:
    """Gmsh writes CPS3 and CPS4 for the elements of a surface in space."""
    check_barrel(deck(tmp_path, f"{NODES}*ELEMENT, TYPE={name}\n{QUAD_ROWS}"))


@pytest.mark.parametrize(("kind", "names"), {
    None: "U1 U99 C3D8Q C3D7 S5 S44 COH3D8P GK3D18 Z101 F3D4 XYZ CIN3D8 EC3D8R M3D5 C3D S 8R CCL12",
    SECTION: "SAX1 SAX2 CAX4 CAX4RH CAX8 MAX1 DCAX4 RAX2 CGAX4 CAXA4R1 SAXA11 MGAX1",
    "": "DCOUP3D DASHPOTA T3D3 B31OS B32R FRAME3D GK3D4L GAPCYL ELBOW31 DC1D2 AC1D3 JOINTC PD3D PC3D HEATCAP R2D2 LS6",
    "triangle6": "S6 CPS6 CPE6M", "hexahedron27": "C3D27RH", "tetra10": "AC3D10 C3D10HS C3D10MPT", "pyramid": "FC3D5",
    "wedge": "F3D6 GK3D6N", "hexahedron": "CSS8 C3D8PHT Q3D8",
}.items())  # fmt: skip
def test_types_of_elements(kind: str | None, names: str) -> None:
    assert {name: cell_kind(name) for name in names.split()} == dict.fromkeys(names.split(), kind)


def test_elements_that_are_not_read_are_named(tmp_path: Path) -> None:
    more = "*ELEMENT, TYPE=C3D8Q\n901, 1,2,3,4,\n5,6,7,8\n902, 1,2,3,4,5,6,7,8\n*ELEMENT, TYPE=SAX1\n903, 1, 2\n"
    assert read_deck(deck(tmp_path, BARREL + more)).warnings == (
        "2 elements of types that are not known (C3D8Q) are left out, of 43",
        "1 elements of an axisymmetric section (SAX1) are left out, of 43",
    )
    assert "its 40 elements are of types that are not read (U1)" in refusal(tmp_path, BARREL.replace("S4R", "U1"))
    assert "axisymmetric section (CAX4)" in refusal(tmp_path, BARREL.replace("S4R", "CAX4"))


def test_other_keywords_that_change_the_surface_are_named(tmp_path: Path) -> None:
    more = ("*Surface, type=REVOLUTION, name=s\n0,0,0, 0,0,1\nSTART, 1, 0\n*Surface, type=ELEMENT, name=t\na, SPOS\n"
            "*IMPERFECTION, FILE=buckle, STEP=1\n1, 0.1\n*ELEMENTT, TYPE=S4\n77, 1, 2, 3, 4\n")  # fmt: skip
    at = BARREL.count("\n")
    assert read_deck(deck(tmp_path, BARREL + more)).warnings == (
        f"*SURFACE in line {at + 1} is a surface given by formulas; left out",
        f"*IMPERFECTION in line {at + 6} moves nodes, which is not read; they are as listed",
        f"*ELEMENTT in line {at + 8} is not a keyword that is known; left out",
    )


@pytest.mark.parametrize("key", [
    "*INCLUDE, INPUT=a.inp", "*include,input=a", "*Incl, INPUT=a", "*NODE, INPUT=a", "*Node, nset=b, inp=a",
    "*ELEMENT, TYPE=S4, INPUT=a", "*NFILL\na, b, 4, 100", "*NCOPY, CHANGE NUMBER=9, OLD SET=a, SHIFT", "*NMAP, NSET=a",
    "*ELCOPY, OLD SET=a, ELEMENT SHIFT=9, SHIFT NODES=9", "*IMPORT, STEP=1", "*SYMMETRIC MODEL GENERATION, REVOLVE",
])  # fmt: skip
def test_what_is_made_or_lies_elsewhere_is_refused(key: str, tmp_path: Path) -> None:
    name = {"*INCL": "*INCLUDE"}.get(key.split(",")[0].upper(), key.split(",")[0].split("\n")[0].upper())
    assert f"{name} in line {BARREL.count(chr(10)) + 1} " in refusal(tmp_path, f"{BARREL}{key}\n")
    inside = f"*Part, name=P\n{BARREL}{key}\n*End Part\n{assembly('part=P' + chr(10))}"
    assert f"{name} in line {BARREL.count(chr(10)) + 2} " in refusal(tmp_path, inside)


@pytest.mark.parametrize(("old", "new", "words"), [
    ("5, 5, 6, 14", "5, 5x, 6, 14", "below *ELEMENT is not all whole numbers"), ("\n7, ", "\n7, nan, ", "not finite"),
    ("9, 10, 18", "9, I-1.10, 18", "is not all whole numbers"), ("10, 10, 11, 19", "10, 10 11, 19", "not all whole"),
    ("12, 12, 13, 21, 20", "12, 12, 13, 21", "begins an element that does not have 4 nodes"),
    ("40, 40, 33, 41, 48", "40, 40, 33, 41", "line 90, '40, 40, 33, 41', below *ELEMENT, TYPE=S4R begins"),
    ("12, 12, 13, 21, 20", "12, 12, 13, 21, 20, 5", "line 62, '12, 12, 13, 21, 20, 5'"),
    ("12, 12, 13, 21, 20", "12, 12, 13, 21, 777", "element 12 refers to node 777, which is not defined"),
    ("12, 12, 13, 21, 20", "12, 12, 13, 21, 99999999999999999999999", "not all whole numbers"),
    ("*Node\n1, ", "*Node\n1.5, ", "node whose number is not whole"),
    ("*Node\n1, 20", "*Node\n1, <r>", "angle brackets"),
    ("*Node\n1, 20", "*Node\n1, 2_0", "line 2, '1, 2_0, 0, 0', below *NODE is not all numbers"),
    ("*Node\n", "*Node, system=Q\n", "SYSTEM=Q"),
])  # fmt: skip
def test_malformed_lines_are_named(old: str, new: str, words: str, tmp_path: Path) -> None:
    assert old in BARREL
    assert words in refusal(tmp_path, BARREL.replace(old, new, 1))


def test_names_are_shown_in_one_line(tmp_path: Path) -> None:
    name = b'"a\x0bpart \xff of\xe2\x80\xa8' + 500 * b"x" + b'"'
    text = (
        b"*Part, name="
        + name
        + b"\n"
        + BARREL.encode()
        + b"*End Part\n"
        + LINER.encode()
        + assembly("part=Liner\n").encode()
    )
    (word,) = read_deck(deck(tmp_path, text)).warnings
    assert len(word.splitlines()) == 1 and word.isprintable() and len(word) < 200
    other = text.replace(b"S4R", b"\x85C3D8Q\x0c" + 500 * b"y")
    assert len(refusal(tmp_path, other).splitlines()) == 1


def test_files_that_are_no_deck(tmp_path: Path) -> None:
    assert "has no *NODE" in refusal(tmp_path, "4 1 0 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n1 1 tet 1 2 3 4\n")


def test_the_last_definition_counts(tmp_path: Path) -> None:
    """ "If any node is specified more than once, the last specification given is used", and so for elements."""
    wrong = f"*NODE\n1, 0., 0., -500.\n*ELEMENT, TYPE=S4\n40, 1, 2, 3, 4\n{BARREL}*NODE\n2, {_points(POINTS[1])}\n"
    held = read_deck(deck(tmp_path, wrong))
    assert areas(held.vertices, held.faces).sum() == pytest.approx(AREA)
    assert held.warnings == (
        "1 nodes are defined again at another place; the last definition of each counts",
        "1 elements are defined again; the last definition of each counts",
    )


def test_nodes_and_elements_that_are_made_from_others(tmp_path: Path) -> None:
    """A cylinder of 12 by 5 elements: arcs of nodes by *NGEN, one of them about a full turn, and rows by *ELGEN."""
    ends = "*NODE\n1, 10, 0, 0\n13, 10, 0, 0\n501, 10, 0, 50\n513, 10, 0, 50\n900, 0, 0, 50\n"
    arcs = "*NGEN, LINE=C\n1, 13, 1, , 0, 0, 0, 0, 0, 1\n501, 513, , 900, , , , 0, 0, 1\n"
    lines = "*NGEN\n" + "".join(f"{k}, {k + 500}, 100\n" for k in range(1, 14))
    made = "*ELEMENT, TYPE=S4R\n1, 1, 2, 102, 101\n*ELGEN, ELSET=all\n1, 12, 1, 1, 5, 100, 20\n"
    beams = "*ELEMENT, TYPE=B31\n800, 1, 2\n*ELGEN\n800, 5, 1, 1\n"
    held = read_deck(deck(tmp_path, ends + arcs + lines + made + beams))
    assert len(held.faces) == 2 * 60 and held.warnings == ()
    side = 2.0 * 10.0 * np.sin(np.pi / 12.0)
    assert areas(held.vertices, held.faces).sum() == pytest.approx(12.0 * side * 50.0, rel=1e-12)
    half = "*NGEN, LINE=C, SYSTEM=C\n1, 4, 1, , 0, 0, 0\n"  # the short way, a quarter turn
    quarter = f"*NODE\n1, 10, 0, 0\n4, 0, 10, 0\n9, 0, 0, 5\n{half}*ELEMENT, TYPE=S3\n1, 1, 2, 9\n*ELGEN\n1, 3, 1\n"
    text = quarter.replace("*ELGEN\n1, 3, 1\n", "2, 2, 3, 9\n3, 3, 4, 9\n")
    held = read_deck(deck(tmp_path, text))
    assert np.hypot(*held.vertices[:2, :2].T) == pytest.approx([10.0, 10.0])
    turn = np.degrees(np.arctan2(held.vertices[:4, 1], held.vertices[:4, 0]))
    assert turn == pytest.approx([0.0, 30.0, 60.0, 90.0])


def test_layers_and_blocks_of_elements(tmp_path: Path) -> None:
    x, y, z = (axis.ravel() for axis in np.meshgrid(range(4), range(3), range(5), indexing="ij"))
    nodes = rows(np.column_stack([x, y, z]), ids=1 + x + 10 * y + 100 * z)
    text = f"*NODE\n{nodes}*ELEMENT, TYPE=C3D8\n1, 1,2,12,11,101,102,112,111\n*ELGEN\n1, 3,1,1, 2,10,10, 4,100,100\n"
    mesh = mw.read(deck(tmp_path, text))
    assert volume(mesh.vertices, mesh.faces) == pytest.approx(24.0)
    assert len(mesh.faces) == 2 * 2 * (3 * 2 + 3 * 4 + 2 * 4)


@pytest.mark.parametrize(("key", "words"), [
    ("*NGEN\n1, 9999, 1", "*NGEN in line {} refers to node 9999"), ("*NGEN\n1, 6, 2", "goes from 1 to 6"),
    ("*NGEN\n1, 1000000000001, 1", "*NGEN in line {}"), ("*NGEN, LINE=P\n1, 5, 1, 3", "LINE=P is not read"),
    ("*NGEN, LINE=C\n1, 5, 1, , 0, 0, 0", "no normal"),
    ("*NGEN, LINE=C\n1, 3, 1, , 0, 5, 0", "not as far from its centre"), ("*ELGEN\n1, 2.5", "not up to 10 whole"),
    ("*ELGEN\n999, 5, 1, 1", "*ELGEN in line {} refers to element 999"),
    ("*ELGEN\n1, 1000000, 1, 1, 1000000", "*ELGEN in line {} makes more than"), ("*ELGEN\n1, -5", "a count below 1"),
    ("*ELEMENT, TYPE=COH3D8, OFFSET=100\n900, 1, 2, 3, 4", "OFFSET"),
])  # fmt: skip
def test_what_cannot_be_made_is_refused(key: str, words: str, tmp_path: Path) -> None:
    assert words.format(BARREL.count("\n") + 1) in refusal(tmp_path, f"{BARREL}{key}\n")


def test_too_many_instances_are_refused(tmp_path: Path) -> None:
    x, y = (axis.ravel() for axis in np.meshgrid(range(60), range(60)))
    nodes = rows(np.column_stack([x, y, 0 * x]), ids=1 + x + 60 * y)
    text = (
        f"*PART, NAME=P\n*NODE\n{nodes}*ELEMENT, TYPE=S4\n1, 1, 2, 62, 61\n*ELGEN\n1, 59, 1, 1, 59, 60, 60\n*END PART\n"
    )
    assert "make too many elements" in refusal(tmp_path, text + assembly(*["part=P\n"] * 5000))
