"""Reading of 3MF files: units, objects of every type, parts of the package, and what is refused or said."""

import zipfile
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest
from scene_barrel import area, barrel, flow, said

from meshwind.core.cast import Floats, Ints
from meshwind.mesh.io.file_mesh import FileMesh
from meshwind.mesh.io.read import load

CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
PRODUCTION = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06"
ALTERNATIVES = "http://schemas.microsoft.com/3dmanufacturing/production/alternatives/2021/04"
SLICE = "http://schemas.microsoft.com/3dmanufacturing/slice/2015/07"
LATTICE = "http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02"
BOOLEAN = "http://schemas.3mf.io/3dmanufacturing/booleanoperations/2023/07"
MATERIAL = "http://schemas.microsoft.com/3dmanufacturing/material/2015/02"
SETS = "http://schemas.microsoft.com/3dmanufacturing/trianglesets/2021/07"
POINTS, FACES = barrel()
AREA = area(POINTS, FACES)


def mesh(points: Floats = POINTS, faces: Ints = FACES, more: str = "") -> str:
    vertices = "".join(f'<vertex x="{x!r}" y="{y!r}" z="{z!r}"/>' for x, y, z in points.tolist())
    triangles = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in faces.tolist())
    return f"<mesh><vertices>{vertices}</vertices><triangles>{triangles}</triangles>{more}</mesh>"


def thing(key: int = 1, content: str | None = None, more: str = "") -> str:
    return f'<object id="{key}" {more}>{mesh() if content is None else content}</object>'


def item(key: int = 1, more: str = "") -> str:
    return f'<item objectid="{key}" {more}/>'


def model(objects: str, build: str, more: str = 'unit="millimeter"') -> str:
    spaces = f'xmlns="{CORE}" xmlns:p="{PRODUCTION}" xmlns:pa="{ALTERNATIVES}" xmlns:s="{SLICE}" xmlns:b="{LATTICE}"'
    return f"<model {spaces} {more}><resources>{objects}</resources><build>{build}</build></model>"


def relationships(*targets: str, kind: str = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel") -> str:
    space = "http://schemas.openxmlformats.org/package/2006/relationships"
    rows = "".join(f'<Relationship Id="r{k}" Type="{kind}" Target="{name}"/>' for k, name in enumerate(targets))
    return f'<Relationships xmlns="{space}">{rows}</Relationships>'


def saved(folder: Path, parts: Mapping[str, str | bytes] | str, method: int = zipfile.ZIP_DEFLATED) -> Path:
    """A package of parts; of a model alone if it is one text."""
    path = folder / "part.3mf"
    if isinstance(parts, str):
        parts = {"_rels/.rels": relationships("/3D/3dmodel.model"), "3D/3dmodel.model": parts}
    with zipfile.ZipFile(path, "w", method) as archive:
        for name, content in parts.items():
            archive.writestr(name, content)
    return path


def is_barrel(held: FileMesh, times: int = 1, sides: float = 1.0) -> bool:
    right = area(held.vertices, held.faces) == pytest.approx(times * AREA, rel=1e-12)
    return right and len(held.faces) == times * len(FACES) and np.sign(flow(held)) == sides


@pytest.mark.parametrize(("unit", "name"), [
    ("micron", "um"), ("millimeter", "mm"), ("centimeter", "cm"), ("inch", "in"), ("foot", "ft"), ("meter", "m"),
])  # fmt: skip
def test_the_unit_is_the_files(unit: str, name: str, tmp_path: Path) -> None:
    held = load(saved(tmp_path, model(thing(), item(), f'unit="{unit}"')))
    assert held.units == name and np.array_equal(held.vertices, POINTS) and held.warnings == ()


def test_a_missing_unit_is_millimetres_and_an_unknown_one_is_refused(tmp_path: Path) -> None:
    assert load(saved(tmp_path, model(thing(), item(), ""))).units == "mm"
    assert "'furlong'" in said(saved(tmp_path, model(thing(), item(), 'unit="furlong"')))


@pytest.mark.parametrize(
    ("kind", "words"), [("support", "supports"), ("solidsupport", "supports"), ("other", "of the type 'other'")]
)
def test_supports_and_others_are_not_the_part(kind: str, words: str, tmp_path: Path) -> None:
    far = mesh(POINTS + 500.0)
    objects = thing() + thing(2, far, f'type="{kind}"') + thing(3, "<components>" + 2 * '<component objectid="2"/>'
                                                                + "</components>")  # fmt: skip
    held = load(saved(tmp_path, model(objects, item() + item(2) + item(3))))
    assert is_barrel(held) and held.vertices.max() < 100.0
    assert held.warnings == (f"objects of the build that are {words} are left out: 3",)
    assert f"objects of the build that are {words} are left out: 1" in said(
        saved(tmp_path, model(thing(more=f'type="{kind}"'), item()))
    )


@pytest.mark.parametrize("kind", ["surface", "model"])
def test_surfaces_are_the_part_and_the_type_of_an_assembly_means_nothing(kind: str, tmp_path: Path) -> None:
    assembly = thing(2, '<components><component objectid="1"/></components>', 'type="support"')
    held = load(saved(tmp_path, model(thing(more=f'type="{kind}"') + assembly, item(2))))
    assert is_barrel(held) and held.warnings == ()


def test_what_is_not_in_the_build_is_left_out_with_a_word(tmp_path: Path) -> None:
    held = load(saved(tmp_path, model(thing() + thing(2, mesh(2 * POINTS)), item())))
    assert is_barrel(held) and held.warnings == ("meshes that are not in the build are left out: 1 of 2",)
    assert "its build is empty, so that none of its 2 objects" in said(saved(tmp_path, model(thing() + thing(2), "")))


def test_what_is_not_printed_is_left_out_with_a_word(tmp_path: Path) -> None:
    two = thing() + thing(2, mesh(2 * POINTS))
    held = load(saved(tmp_path, model(two, item(1, 'printable="1"') + item(2, 'printable="0"'))))
    assert is_barrel(held) and "objects marked as not to be printed are left out: 1" in held.warnings
    assert is_barrel(load(saved(tmp_path, model(thing(), item(1, 'printable="0"')))))


@pytest.mark.parametrize("where", ["item", "component"])
@pytest.mark.parametrize("name", ["/3D/Objects/object_1.model", "/3D/objets/pièce 1.model"])
def test_objects_in_model_parts_of_their_own(where: str, name: str, tmp_path: Path) -> None:
    inner = model(thing(7), "")
    use = f'p:path="{name}" objectid="7"'
    if where == "item":
        root = model("", f'<item {use} transform="1 0 0 0 1 0 0 0 1 9 0 0"/>')
    else:
        root = model(thing(7, f"<components><component {use}/></components>"),
                     item(7, 'transform="1 0 0 0 1 0 0 0 1 9 0 0"'))  # fmt: skip
    parts = {"_rels/.rels": relationships("/3D/3dmodel.model"), "3D/3dmodel.model": root, name[1:]: inner}
    held = load(saved(tmp_path, parts))
    assert is_barrel(held) and np.abs(held.vertices - POINTS - [9, 0, 0]).max() < 1e-12 and held.warnings == ()
    assert load(saved(tmp_path, parts | {name[1:]: model(thing(7), item(7))})).faces.shape == FACES.shape
    assert "is in millimeter, but" in said(saved(tmp_path, parts | {name[1:]: model(thing(7), "", 'unit="inch"')}))
    assert "does not hold" in said(saved(tmp_path, {"3D/3dmodel.model": root}))


def test_the_root_is_the_one_that_the_relationships_name(tmp_path: Path) -> None:
    good, bad = model(thing(), item()), model(thing(1, mesh(3 * POINTS)), item())
    parts: dict[str, str | bytes] = {"3D/3dmodel.model": bad, "Part/A%20b.model": good}
    for target in ("/Part/A%20b.model", "Part/A b.model", "/PART/a%20B.MODEL"):
        assert is_barrel(load(saved(tmp_path, parts | {"_rels/.rels": relationships(target)})))
    assert "2 models" in said(
        saved(tmp_path, parts | {"_rels/.rels": relationships("/3D/3dmodel.model", "/Part/A%20b.model")})
    )
    assert is_barrel(load(saved(tmp_path, {"else.model": good})))
    assert "holds 2 models" in said(saved(tmp_path, {"a.model": good, "b.model": good}))
    assert "no 3D model" in said(saved(tmp_path, {"a.xml": good}))


def test_transforms_are_nested_and_those_that_mirror_turn_the_triangles(tmp_path: Path) -> None:
    inner = thing(2, '<components><component objectid="1" transform="0 1 0 -1 0 0 0 0 1 0 0 7"/></components>')
    held = load(saved(tmp_path, model(thing() + inner, item(2, 'transform="1 0 0 0 1 0 0 0 1 5 0 0"'))))
    x, y, z = POINTS.T
    assert np.abs(held.vertices - np.column_stack([5 - y, x, z + 7])).max() < 1e-12 and is_barrel(held)
    held = load(saved(tmp_path, model(thing(), item(1, 'transform="-1 0 0 0 1 0 0 0 1 0 0 0"'))))
    assert is_barrel(held) and np.array_equal(held.vertices, POINTS * [-1, 1, 1])
    assert "twelve numbers" in said(saved(tmp_path, model(thing(), item(1, 'transform="1 0 0 0 1 0 0 0 1"'))))
    assert "twelve numbers" in said(saved(tmp_path, model(thing(), item(1, 'transform="nan 0 0 0 1 0 0 0 1 0 0 0"'))))


@pytest.mark.parametrize(("space", "words"), [
    (LATTICE, "beam lattices"), (SLICE, "slices"), (BOOLEAN, "Boolean operations"),
    ("http://schemas.microsoft.com/3dmanufacturing/securecontent/2019/04", "encrypted content"),
    ("http://schemas.3mf.io/3dmanufacturing/displacement/2023/10", "displaced meshes"),
    ("http://schemas.3mf.io/3dmanufacturing/volumetric/2022/01", "volumetric design"),
    ("http://example.com/own", "unknown content"),
])  # fmt: skip
def test_a_required_extension_that_is_not_read_is_refused_by_name(space: str, words: str, tmp_path: Path) -> None:
    more = f'xmlns:q="{space}" requiredextensions="p q"'
    text = said(saved(tmp_path, model(thing(), item(), more)))
    assert f"requires the extension {space} ({words}), which is not read" in text


def test_required_extensions_without_a_shape_are_read(tmp_path: Path) -> None:
    more = f'xmlns:m="{MATERIAL}" xmlns:t="{SETS}" requiredextensions="m p t"'
    assert is_barrel(load(saved(tmp_path, model(thing(), item(), more))))


def test_what_an_object_holds_beside_triangles_is_named(tmp_path: Path) -> None:
    lattice = mesh(
        more='<b:beamlattice radius="1" minlength="0.1"><b:beams><b:beam v1="0" v2="1"/></b:beams></b:beamlattice>'
    )
    held = load(saved(tmp_path, model(thing(1, lattice), item())))
    assert is_barrel(held) and held.warnings == (
        "objects of the build that hold a 'beamlattice', which is not read: 1",
    )
    shape = f'<q:booleanshape xmlns:q="{BOOLEAN}" objectid="1"><q:boolean objectid="1"/></q:booleanshape>'
    held = load(saved(tmp_path, model(thing() + thing(2, shape), item() + item(2))))
    assert is_barrel(held) and held.warnings == (
        "objects of the build that hold a 'booleanshape', which is not read: 1",
    )
    assert "booleanshape" in said(saved(tmp_path, model(thing() + thing(2, shape), item(2))))
    other = mesh(faces=FACES[:0], more="<b:beamlattice/>")
    assert "beamlattice" in said(saved(tmp_path, model(thing(1, other), item())))


def test_stand_ins_give_way_to_the_full_shape_or_are_refused(tmp_path: Path) -> None:
    coarse = mesh(POINTS * [1, 1, 2], FACES[::2])
    text = said(saved(tmp_path, model(thing(1, coarse, 's:meshresolution="lowres" s:slicestackid="9"'), item())))
    assert "stand-in (lowres)" in text
    full = '<pa:alternatives><pa:alternative objectid="2" modelresolution="{}"/></pa:alternatives>'
    for resolution in ("fullres", "obfuscated"):
        objects = thing(1, coarse + full.format(resolution), 'pa:modelresolution="lowres"') + thing(2)
        path = saved(tmp_path, model(objects, item()))
        if resolution == "fullres":
            assert is_barrel(load(path))
        else:
            assert "stand-in (lowres)" in said(path)


def test_encrypted_and_unusual_archives_are_refused_by_what_they_are(tmp_path: Path) -> None:
    path = saved(tmp_path, model(thing(), item()))
    data = bytearray(path.read_bytes())
    whole = bytes(data)
    for offset, value, words in ((8, 1, "is encrypted"), (10, 9, "by the method 9 of ZIP")):
        data = bytearray(whole)
        for k in range(len(data) - 4):
            if data[k : k + 4] == b"PK\x01\x02" and b"3dmodel.model" in data[k + 46 : k + 70]:
                data[k + offset] |= value
        path.write_bytes(bytes(data))
        assert words in said(path)
    path.write_bytes(bytes.fromhex("d0cf11e0a1b11ae1") + bytes(500))
    assert "encrypted" in said(path)
    kind = "http://schemas.openxmlformats.org/package/2006/relationships/encryptedfile"
    parts = {"_rels/.rels": relationships("/3D/3dmodel.model"), "3D/3dmodel.model": model(thing(), item()),
             "3D/_rels/3dmodel.model.rels": relationships("3dmodel.model", kind=kind)}  # fmt: skip
    assert "its part 3d/3dmodel.model is encrypted" in said(saved(tmp_path, dict(parts)))


@pytest.mark.parametrize("method", [zipfile.ZIP_STORED, zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA])
def test_other_methods_of_compression(method: int, tmp_path: Path) -> None:
    assert is_barrel(load(saved(tmp_path, model(thing(), item()), method)))


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "latin-1"])
def test_encodings(encoding: str, tmp_path: Path) -> None:
    name = "utf-8" if encoding == "utf-8-sig" else encoding
    text = f'<?xml version="1.0" encoding="{name}"?>\n' + model(thing(more='name="Fläche"'), item())
    assert is_barrel(load(saved(tmp_path, {"3D/3dmodel.model": text.encode(encoding)})))


def test_prefixes_and_foreign_elements(tmp_path: Path) -> None:
    """A prefix for the core, and meshes, vertices and items of other namespaces, which are not the part's."""
    text = model(thing(), item()).replace("<", "<c:").replace("<c:/", "</c:").replace('xmlns="', 'xmlns:c="')
    assert is_barrel(load(saved(tmp_path, text)))
    foreign = mesh(3 * POINTS).replace("<", "<b:").replace("<b:/", "</b:")
    hull = '<b:hull><vertex x="900" y="9" z="9"/><triangle v1="0" v2="1" v3="2"/></b:hull><vertices>'
    plain = mesh().replace("<vertices>", hull)
    held = load(saved(tmp_path, model(thing(1, foreign + plain), item() + '<b:item objectid="1"/>')))
    words = [f"objects of the build that hold a '{name}', which is not read: 1" for name in ("hull", "mesh")]
    assert is_barrel(held) and held.warnings == tuple(words)


@pytest.mark.parametrize(("objects", "build", "words"), [
    (thing(), item(5), "object '5' is not in"),
    (thing() + thing(), item(), "two objects of the id '1'"),
    (thing(1, '<components><component objectid="1"/></components>'), item(), "contains itself"),
    (thing(1, mesh(faces=FACES + 10)), item(), "refers to vertex 57 of 48"),
    (thing(1, mesh().replace('z="', 'w="', 1)), item(), "a vertex of 3d/3dmodel.model has no 'z'"),
    (thing(1, mesh().replace('v1="0"', 'v1="0.5"', 1)), item(), "has '0.5', where a number is needed"),
    (thing(1, mesh().replace('x="20.0"', 'x="20,0"', 1)), item(), "has '20,0', where a number is needed"),
    ("<object>", "", "is damaged: mismatched tag"),
])  # fmt: skip
def test_faults_are_named(objects: str, build: str, words: str, tmp_path: Path) -> None:
    assert words in said(saved(tmp_path, model(objects, build)))


def test_document_types_and_parts_held_twice_are_refused(tmp_path: Path) -> None:
    assert "document type" in said(saved(tmp_path, "<!DOCTYPE model>" + model(thing(), item())))
    path = saved(tmp_path, model(thing(), item()))
    with zipfile.ZipFile(path, "a") as archive:
        archive.writestr("/3D/3DMODEL.model", model(thing(1, mesh(2 * POINTS)), item()))
    assert "holds 3d/3dmodel.model 2 times" in said(path)


def test_volumes_that_a_slicer_does_not_print_are_named(tmp_path: Path) -> None:
    table = '<config><volume><metadata key="volume_type" value="NegativeVolume"/></volume></config>'
    parts = {"3D/3dmodel.model": model(thing(), item()), "Metadata/Slic3r_PE_model.config": table}
    held = load(saved(tmp_path, parts))
    assert is_barrel(held) and "which its program does not print, are read: 1" in held.warnings[0]


@pytest.mark.parametrize("purpose", ["modifier_part", "negative_part", "support_blocker", "support_enforcer"])
@pytest.mark.parametrize("kind", ["model", "other"])
def test_components_that_a_slicer_does_not_print_are_left_out(kind: str, purpose: str, tmp_path: Path) -> None:
    objects = thing(1) + thing(2, mesh(0.3 * POINTS), f'type="{kind}"')
    both = "<components>" + "".join(
        f'<component objectid="{key}" p:path="/3D/Objects/one.model"/>' for key in (1, 2)
    ) + "</components>"  # fmt: skip
    table = f'<config><object id="3"><part id="1" subtype="normal_part"/><part id="2" subtype="{purpose}"/></object>'
    parts = {"3D/3dmodel.model": model(thing(3, both), item(3)), "3D/Objects/one.model": model(objects, ""),
             "_rels/.rels": relationships("/3D/3dmodel.model"),
             "Metadata/model_settings.config": table + "</config>"}  # fmt: skip
    held = load(saved(tmp_path, parts))
    assert is_barrel(held)
    assert held.warnings == (f"objects that its program does not print ({purpose}) are left out: 1",)


def test_components_of_another_object_are_printed(tmp_path: Path) -> None:
    both = '<components><component objectid="1"/></components>'
    table = '<config><object id="2"><part id="1" subtype="modifier_part"/></object><object id="3"/></config>'
    parts = {"3D/3dmodel.model": model(thing() + thing(3, both), item(3)), "Metadata/model_settings.config": table,
             "_rels/.rels": relationships("/3D/3dmodel.model")}  # fmt: skip
    held = load(saved(tmp_path, parts))
    assert is_barrel(held) and held.warnings == ()
    parts["Metadata/model_settings.config"] = "<config><object"
    assert "metadata/model_settings.config is damaged" in said(saved(tmp_path, parts))
