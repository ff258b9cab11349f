"""Reading of 3MF files, packages of XML for 3D printers: the core specification with the production extension.

The 3MF Consortium's own library, lib3mf (2.5), keeps coordinates in single precision, and does not open packages that
are in UTF-16 or lack some of their relationships.
"""

from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.core.errors import BadInputError
from meshwind.core.units import BY_FILE, OF_3MF
from meshwind.mesh.io.file_mesh import FileMesh
from meshwind.mesh.io.threemf.model import ModelPart, Solid, Use, read_model
from meshwind.mesh.io.threemf.package import Package, open_archive
from meshwind.mesh.io.threemf.slicers import not_printed, painted

_Parts = list[tuple[Floats, Ints]]
_UNITS = {"micron": "um", "millimeter": "mm", "centimeter": "cm", "inch": "in", "foot": "ft", "meter": "m"}
"""Units of the core specification, clause 3.4; millimeter is its default."""
_READ = ("/3dmanufacturing/core/", "/production/", "/material/", "/trianglesets/")
"""Extensions that are read, or that say nothing of the shape, by a part of their namespace."""
_NAMES = {
    "beamlattice": "beam lattices", "slice": "slices", "volumetric": "volumetric design", "implicit": "implicit shapes",
    "displacement": "displaced meshes", "booleanoperations": "Boolean operations", "securecontent": "encrypted content",
}  # fmt: skip
"""What other extensions are for, by a part of their namespace."""
_NOT_THE_PART = {"support": "supports", "solidsupport": "supports", "other": "of the type 'other'"}
"""Types of objects that are left out: supports, and what "MUST NOT be referenced in the Build section", clause 4.1."""
_MAX_DEPTH = 64
"""Levels of objects within objects."""
_MAX_USES = 20_000
"""Uses of objects by others: a few objects that contain each other many times would take forever."""
_MAX_ROWS = 50_000_000
"""Triangles or vertices of all uses together."""


def read_3mf(path: Path) -> FileMesh:
    """Vertices and triangles of all objects in the build but supports, in the file's unit."""
    with open_archive(path) as archive:
        build = _Build(Package(path, archive))
        parts = build.parts()
        among = painted(build.package)
    warnings = build.warnings()
    if among:
        warnings += (f"volumes of modifiers and the like, which its program does not print, are read: {among}",)
    if not parts:
        found = f" ({'; '.join(warnings)})" if warnings else ""
        raise BadInputError(f"{path.name}: nothing in its build is a mesh of the part{found}; export the part's mesh")
    starts = np.cumsum([0] + [len(points) for points, _ in parts[:-1]])
    faces = [triangles + start for (_, triangles), start in zip(parts, starts, strict=True)]
    points = np.concatenate([points for points, _ in parts])
    return FileMesh(
        points, np.concatenate(faces), _UNITS[build.unit], warnings, BY_FILE if build.names_unit else OF_3MF
    )


class _Build:
    """The objects of the root part's build, and a count of what is left out of it."""

    def __init__(self, package: Package) -> None:
        self.package, self.uses, self.rows = package, 0, 0
        self.models: dict[str, ModelPart] = {}
        self.used: set[int] = set()
        self.left_out: Counter[str] = Counter()
        self.unread: Counter[str] = Counter()
        self.not_printed = not_printed(package)
        self.root = package.root()
        self.unit, self.names_unit = self._model(self.root).unit, self._model(self.root).names_unit

    def parts(self) -> _Parts:
        """Meshes of all items of the build."""
        items = self._model(self.root).build
        printed = [item for item in items if item.is_printed]
        if not items:
            count = len(self._model(self.root).objects)
            raise BadInputError(
                f"{self.package.file}: its build is empty, so that none of its {count} objects is the part; "
                "export it with the part on the build plate"
            )
        if printed and len(printed) < len(items):
            self.left_out["marked as not to be printed"] += len(items) - len(printed)
        return [part for item in printed or items for part in self._used(item, self.root, ())]

    def warnings(self) -> tuple[str, ...]:
        """What is left out, and how much of it."""
        words = [f"objects {why} are left out: {count}" for why, count in sorted(self.left_out.items())]
        words += [
            f"objects of the build that hold a {name[:40]!r}, which is not read: {count}"
            for name, count in sorted(self.unread.items())
        ]
        meshes = [solid for model in self.models.values() for solid in model.objects.values() if len(solid.faces)]
        idle = sum(id(solid) not in self.used for solid in meshes)
        if idle:
            words.append(f"meshes that are not in the build are left out: {idle} of {len(meshes)}")
        return tuple(words)

    def _model(self, name: str) -> ModelPart:
        """A model part, checked for its unit and for what it requires."""
        if name not in self.models:
            with self.package.open(name) as part:
                model = read_model(part, name)
            self._check(model, name)
            self.models[name] = model
        return self.models[name]

    def _check(self, model: ModelPart, name: str) -> None:
        for space in model.required:
            if not any(part in space for part in _READ):
                what = next((words for part, words in _NAMES.items() if f"/{part}/" in space), "unknown content")
                raise BadInputError(
                    f"{self.package.file}: requires the extension {space[:80]} ({what}), which is not read; "
                    "export it as a plain mesh"
                )
        if model.unit not in _UNITS:
            raise BadInputError(
                f"{self.package.file}: its unit is {model.unit[:40]!r}, which 3MF does not know; "
                f"export it in {', '.join(_UNITS)}"
            )
        if self.models and model.unit != self.unit:
            raise BadInputError(
                f"{self.package.file}: {self.root[:60]} is in {self.unit}, but {name[:60]} in {model.unit}; "
                "export it in one unit"
            )

    def _used(self, use: Use, part: str, outer: tuple[tuple[str, str], ...]) -> _Parts:
        """Meshes of the object that is used in a part, moved by that use's transform; outer are those around it."""
        part = use.part or part
        solid = self._model(part).objects.get(use.object_id)
        key = (part, use.object_id)
        if solid is None:
            raise ValueError(f"object {use.object_id[:20]!r} is not in {part[:60]}")
        if key in outer:
            raise ValueError(f"object {use.object_id[:20]!r} contains itself")
        self.uses += 1
        if self.uses > _MAX_USES or len(outer) > _MAX_DEPTH:
            raise ValueError(f"it uses objects more than {_MAX_USES} times, or on more than {_MAX_DEPTH} levels")
        self.used.add(id(solid))
        if outer and (purpose := self.not_printed.get((outer[-1][1], use.object_id))):
            self.left_out[f"that its program does not print ({purpose[:40]})"] += 1
            return []
        if solid.resolution != "fullres":
            return self._stand_in(solid, use, part, (*outer, key))
        if solid.components:  # "The object type is ignored on objects that contain components", chapter 4
            parts = [each for inner in solid.components for each in self._used(inner, part, (*outer, key))]
        else:
            parts = self._mesh(solid)
        return [_moved(each, use.transform) for each in parts] if use.transform else parts

    def _stand_in(self, solid: Solid, use: Use, part: str, outer: tuple[tuple[str, str], ...]) -> _Parts:
        """Meshes of the full shape that an object stands for."""
        if not solid.alternatives:
            raise BadInputError(
                f"{self.package.file}: object {use.object_id[:20]!r} is a stand-in ({solid.resolution[:20]}) for a "
                "shape that is not read; export the part as a mesh of full resolution"
            )
        full = solid.alternatives[0]
        return self._used(replace(full, transform=use.transform), part, outer)

    def _mesh(self, solid: Solid) -> _Parts:
        """The mesh of an object, none if it is not the part."""
        if solid.type in _NOT_THE_PART:
            self.left_out[f"of the build that are {_NOT_THE_PART[solid.type]}"] += 1
            return []
        self.unread.update(set(solid.unread))
        if len(solid.faces) == 0:
            if not solid.unread:
                self.left_out["without triangles"] += 1
            return []
        self.rows += max(len(solid.faces), len(solid.vertices))
        if self.rows > _MAX_ROWS:
            raise ValueError(f"its build has more than {_MAX_ROWS} triangles or vertices")
        return [(solid.vertices, solid.faces)]


def _moved(part: tuple[Floats, Ints], transform: str) -> tuple[Floats, Ints]:
    """A mesh moved by a transform of twelve numbers; one that mirrors turns the triangles."""
    numbers = np.array(transform.split(), dtype=np.float64)
    if len(numbers) != 12 or not np.isfinite(numbers).all():
        raise ValueError(f"a transform is {transform[:60]!r}, where twelve numbers are needed")
    matrix = numbers.reshape(4, 3)
    points, faces = part
    return points @ matrix[:3] + matrix[3], faces[:, ::-1] if np.linalg.det(matrix[:3]) < 0.0 else faces
