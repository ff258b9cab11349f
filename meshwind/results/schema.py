"""The files of a run's folder: their names, their fields, and each field's unit and type.

All other modules take these names from here; the keys of report.json are in `report_types`.  Importing this module
loads nothing else, as the process that draws and the help of the command line need the names, too.
"""

import re
from typing import NamedTuple

LENGTHS = "{u}"
"""Unit of a length; "{u}" is replaced by the name of the mesh's unit."""
DEGREES = "degrees"


class Field(str):
    """Name of an array in a file, with the unit and the type of its values and their number per point or cell."""

    unit: str
    dtype: str
    columns: int

    def __new__(cls, name: str, unit: str = "", dtype: str = "float64", columns: int = 1) -> "Field":
        """Make a field; `unit` may contain "{u}" for the mesh's unit of length."""
        field = super().__new__(cls, name)
        field.unit, field.dtype, field.columns = unit, dtype, columns
        return field

    def unit_in(self, units: str) -> str:
        """Unit of the field if lengths are in `units`; "" for plain numbers, and if `units` is ""."""
        return self.unit.format(u=units) if units or LENGTHS not in self.unit else ""


class File(str):
    """Name of a file, with the fields of its points and of its cells in the order of the file."""

    point_data: tuple[Field, ...]
    cell_data: tuple[Field, ...]

    def __new__(cls, name: str, point_data: tuple[Field, ...] = (), cell_data: tuple[Field, ...] = ()) -> "File":
        """Make a file name with the fields of the file."""
        file = super().__new__(cls, name)
        file.point_data, file.cell_data = point_data, cell_data
        return file

    @property
    def stem(self) -> str:
        """The name without its extension."""
        return self.rpartition(".")[0]


# fields of several files

UV = Field("uv", columns=2)
ON_SURFACE = Field("on_surface", dtype="uint8")
GAP = Field("gap", LENGTHS)
NORMAL = Field("normal", columns=3)
PATH = Field("path", dtype="int64")
LENGTH = Field("length", LENGTHS)
"""Length of the polyline through the particles."""
MAX_GAP = Field("max_gap", LENGTHS)
ANGLE = Field("angle", DEGREES)
"""At a crossing the angle between the families, on the surface the winding angle of family +1."""

# the fibres

WINDING_ANGLE = Field("angle", DEGREES)
"""From the direction along the part: 0 along it, 90 for a hoop."""
KIND = Field("kind", dtype="uint8")
"""0 laid on the part, 1 bridge, 2 turnaround, 3 dwell, 4 join between layers."""
LAYER, CIRCUIT, PASS = (Field(name, dtype="int64") for name in ("layer", "circuit", "pass"))
FILAMENT_ID = Field("filament", dtype="int64")
SLIP = Field("slip")
"""Required friction |kg| / kn: geodesic over normal curvature."""
ARC_LENGTH = Field("arc_length", LENGTHS)
FAMILY = Field("family", dtype="int64")
FIBRE_LENGTH = Field("fibre_length", LENGTHS)
BRIDGED_LENGTH = Field("bridged_length", LENGTHS)
MAX_SLIP = Field("max_slip")
STATUS = Field("status", dtype="int64")
RESIDUAL = Field("residual")
PATHS = File(
    "paths.vtp",
    point_data=(UV, ON_SURFACE, GAP, NORMAL, SLIP, ARC_LENGTH),
    cell_data=(PATH, FAMILY, LENGTH, FIBRE_LENGTH, BRIDGED_LENGTH, MAX_GAP, MAX_SLIP, STATUS, RESIDUAL),
)
RESOLVED = Field("resolved", dtype="uint8")
"""Whether a bridge lies further off the surface somewhere than the threshold, or than this may lie off the part."""
BRIDGES = File("bridges.vtp", point_data=(GAP,), cell_data=(PATH, LENGTH, MAX_GAP, RESOLVED))

THICKNESS = Field("thickness", LENGTHS)
FILAMENT = File(
    "filament.vtp",
    point_data=(KIND, LAYER, CIRCUIT, PASS, PATH, ARC_LENGTH, WINDING_ANGLE, SLIP, NORMAL, THICKNESS),
    cell_data=(FILAMENT_ID, LENGTH),
)
"""Present where the winding is continuous."""

PATH_A = Field("path_a", dtype="int64")
PATH_B = Field("path_b", dtype="int64")
QUALITY = Field("quality")
CROSSINGS = File("crossings.vtp", point_data=(PATH_A, PATH_B, ANGLE, QUALITY, UV, ON_SURFACE))

QUADS = File("quads.vtu", point_data=(UV, ON_SURFACE))
QUADS_OBJ = File("quads.obj")

# the fitted surface

GAUSSIAN_CURVATURE = Field("gaussian_curvature", "1/{u}2")
MEAN_CURVATURE = Field("mean_curvature", "1/{u}")
WINDABILITY = Field("windability")
CLASS = Field("class", dtype="int64")
PRESS_DIRECTION = Field("press_direction", columns=3)
PRESS_REACH = Field("press_reach", DEGREES)
COVERAGE = Field("coverage")
LAYERS = Field("layers", dtype="int64")
STRETCH = Field("stretch")
FIT_ERROR = Field("fit_error", LENGTHS)
"""Only where the mesh is known."""
UNCERTAINTY = Field("uncertainty", LENGTHS)
"""Only of a surface that was fitted; on cells in surface.npz, at points in surface.vtu."""
SURFACE = File(
    "surface.vtu",
    point_data=(
        UV, NORMAL, GAUSSIAN_CURVATURE, MEAN_CURVATURE, WINDABILITY, CLASS, PRESS_DIRECTION, PRESS_REACH, ANGLE,
        COVERAGE, LAYERS, STRETCH, UNCERTAINTY, FIT_ERROR,
    ),
)  # fmt: skip

CONTROL_POINTS = Field("control_points", LENGTHS, columns=3)
KNOTS_U, KNOTS_V = Field("knots_u"), Field("knots_v")
DEGREE = Field("degree", dtype="int64")
PERIODIC_U = Field("periodic_u", dtype="bool")
UNITS = Field("units", dtype="str")
THRESHOLD = Field("threshold", LENGTHS)
"""Only where the run was given one."""
SPLINE = File(
    "surface.npz",
    point_data=(CONTROL_POINTS, KNOTS_U, KNOTS_V, DEGREE, PERIODIC_U, UNITS, UNCERTAINTY, THRESHOLD),
)
CHART = File("chart.png")

# layers on layers

LAYER = Field("layer", dtype="int64")
STATIONS, STATIONS_LEGEND = File("laminate.csv"), File("laminate_columns.csv")
LAYER_FIBRES = File("layers.vtp", point_data=(UV, NORMAL), cell_data=(LAYER, FAMILY))
LAYER_SURFACES = File("laminate.npz", point_data=(CONTROL_POINTS, UNITS))
"""The control points (layers + 1, nu, nv, 3) of the surfaces below each layer and above the last."""

# a redesign

DISPLACEMENT = Field("displacement", LENGTHS, columns=3)
MOVED = Field("moved", LENGTHS)
"""Magnitude of the displacement."""
DX, DY, DZ = Field("dx", LENGTHS), Field("dy", LENGTHS), Field("dz", LENGTHS)
EDITED = File("edited.vtu", point_data=(DISPLACEMENT, MOVED))
"""Present in the folder of a redesign only."""
EDITED_PLY = File("edited.ply", point_data=(DX, DY, DZ, MOVED))

# figures and options

REPORT = File("report.json")
CONFIG = File("meshwind.toml")

# pictures

WINDING, FIT, REDESIGN, SHEET = "winding", "fit", "redesign", "sheet"
FILAMENTS, BANDS, LAMINATE_PICTURE = "filament", "bands", "laminate"
LAYERS_PICTURE = "layers"
OF_FILAMENT = FILAMENTS, BANDS
"""Pictures that are first of a continuous winding, ..."""
OF_LAMINATE = BANDS, LAMINATE_PICTURE
"""... and of layers one on another; any winding has BANDS."""
PICTURES = (
    WINDING, "crossings", "coverage", LAYERS_PICTURE, "windability", "slip", FIT, "unrolled", "quads", "angles",
    FILAMENTS, BANDS, LAMINATE_PICTURE,
)  # fmt: skip
"""The pictures of a winding; REDESIGN is that of a redesign, SHEET shows all of a folder on one page."""
MOVIES = "gif", "mp4"


def picture(name: str) -> File:
    """The file of a picture."""
    return File(f"{name}.png")


def movie(kind: str) -> File:
    """The file of the animation, by kind."""
    return File(f"{WINDING}.{kind}")


def program_movie(kind: str) -> File:
    """The file of the movie of a program, by kind."""
    return File(f"{PROGRAM_CSV.stem}.{kind}")


FIT_PICTURE, REVOLUTIONS_PICTURE = picture("fit_error"), picture("revolutions")
BEFORE, AFTER, SLICE, ROUNDS = picture("before"), picture("after"), picture("slice"), picture("rounds")

# exports

EDITED_STEP = File("edited.step")
VIEWER = File("viewer.html")
SHELL, SHELL_S4R, SHELL_ABOUT = File("shell.inp"), File("shell_s4r.inp"), File("shell.json")
"""Decks, and what a deck for CalculiX does not hold: run, unit of length, strengths."""
MPA = "MPa"
EXPOSURE, TSAI_WU = Field("exposure"), Field("tsai_wu")
"""Of an element's point nearest to failure: the load over that which makes it fail, and the criterion's value."""
WORST_PLY, WORST_LAYER, WORST_FAMILY = (Field(f"worst_{name}", dtype="int64") for name in ("ply", "layer", "family"))
SOLVED = File("solved.vtu", (DISPLACEMENT,), (EXPOSURE, TSAI_WU, WORST_PLY, WORST_LAYER, WORST_FAMILY, NORMAL))
"""What CalculiX makes of the deck, beside thickness and the fields of each ply."""
SOLVED_FIGURES, SOLVED_PICTURE = File("solved.json"), picture("solved")
OF_SOLVED = SOLVED, SOLVED_FIGURES, SOLVED_PICTURE
OF_SHELL = SHELL, SHELL_S4R, SHELL_ABOUT, *OF_SOLVED
STEP = File("surface.step")
PROGRAM_CSV, PROGRAM_JSON, POSES = File("program.csv"), File("program.json"), File("poses.csv")
PROGRAM_LEGEND = File("program_columns.csv")
PROGRAM_PAGE, AXES_PICTURE, HITS_PICTURE = File("program.html"), picture("axes"), picture("hits")
"""The program of a machine; that in the words of a machine has the same stem and another ending."""


class FamilyFields(NamedTuple):
    """The fields of one family in the files of the fibre field; `alias` is a second name of the direction."""

    direction: Field
    alias: Field
    angle: Field
    layers: Field
    thickness: Field


def family_fields(family: int) -> FamilyFields:
    """The fields of family +1, which are numbered 1, or of family -1, numbered 2."""
    number = 1 if family > 0 else 2
    return FamilyFields(
        Field(f"fibre_{number}", columns=3),
        Field(f"FIB_DIR{number}", columns=3),
        Field(f"angle_{number}", DEGREES),
        Field(f"layers_{number}"),
        Field(f"thickness_{number}", LENGTHS),
    )


class LayerFamilyFields(NamedTuple):
    """The fields of one family of a layer in the files of the fibre field."""

    direction: Field
    angle: Field


def layer_family_fields(layer: int, family: int) -> LayerFamilyFields:
    """The fields of a layer, the first being number 1, and of its family, +1 numbered 1 and -1 numbered 2."""
    number = 1 if family > 0 else 2
    return LayerFamilyFields(
        Field(f"fibre_{layer}_{number}", columns=3), Field(f"angle_{layer}_{number}", DEGREES)
    )  # fmt: skip


class PlyFields(NamedTuple):
    """The fields of a layer's family in the file of a solved deck; stress and strain are those 11, 22, 12."""

    direction: Field
    stress: Field
    strain: Field


def ply_fields(layer: int, family: int) -> PlyFields:
    """The fields of a layer, the first being number 1, and of its family, +1 numbered 1 and -1 numbered 2."""
    names = layer_family_fields(layer, family)
    ends = names.direction.removeprefix("fibre")
    return PlyFields(names.direction, Field(f"stress{ends}", MPA, columns=3), Field(f"strain{ends}", columns=3))


U, V = Field("u"), Field("v")
LAMINATE = File("laminate.vtu", point_data=(UV, THICKNESS))
"""Beside the fields of each layer."""


class LayerFields(NamedTuple):
    """The fields of a layer in the file of the laminate."""

    thickness: Field
    angle: Field


def layer_fields(number: int) -> LayerFields:
    """The fields of a layer, the first being number 1."""
    return LayerFields(Field(f"thickness_{number}", LENGTHS), Field(f"angle_{number}", DEGREES))


_FIBRE_FIELD = (*family_fields(1), *family_fields(-1), THICKNESS, NORMAL)
FIBERS, FIBERS_LEGACY = (File(name, point_data=(U, V), cell_data=_FIBRE_FIELD) for name in ("fibers.vtu", "fibers.vtk"))
"""Fields of families that the run does not have are missing; a laminate has those of its layers instead."""

FRAMES_FOLDER, ALL_FRAMES, FILAMENT_FRAMES, FRAMES_LEGEND = "frames", "all.csv", "filament.csv", "columns.csv"
"""A folder, and in it the frames of all paths, those of the filament in the order of winding, and their legend."""


def frames_of(path: int) -> str:
    """Name of the file of a path's frames, in the folder FRAMES_FOLDER."""
    return f"path_{path:03d}.csv"


def layer_frames(layer: int) -> str:
    """Name of the file of a layer's frames, the first being number 0, in the folder FRAMES_FOLDER."""
    return f"layer_{layer:03d}.csv"


FORMATS_FOLDER = "formats"
"""A folder, with the files CONVERTED in other mesh formats."""
CONVERTED = SURFACE, QUADS, PATHS, BRIDGES, CROSSINGS
SUFFIXES = {
    "vtu": ("vtu",), "vtk": ("vtk",), "xdmf": ("xdmf", "h5"), "ply": ("ply",), "obj": ("obj",), "gmsh": ("msh",),
}  # fmt: skip
"""Endings of a mesh format's files, by its name."""

EXPORT_FOLDERS = FRAMES_FOLDER, FORMATS_FOLDER
_ENDINGS = "|".join(sum(SUFFIXES.values(), ("raw",)))  # XDMF of 0.2.0 had its numbers in a file of that name
EXPORTS = re.compile(
    "|".join(re.escape(name) for name in (*OF_SHELL, FIBERS, FIBERS_LEGACY, STEP, POSES, AXES_PICTURE, HITS_PICTURE))
    + rf"|{PROGRAM_CSV.stem}(_\w+)?\.\w+"
    + rf"|{FRAMES_FOLDER}/(path_\d{{3,}}\.csv|layer_\d{{3,}}\.csv|{re.escape(ALL_FRAMES)}|{re.escape(FILAMENT_FRAMES)}"
    + rf"|{re.escape(FRAMES_LEGEND)})"
    + rf"|{FORMATS_FOLDER}/({'|'.join(file.stem for file in CONVERTED)})\.({_ENDINGS})"
)
"""Names of exported files except VIEWER; they are removed when the run is replaced."""

RESULTS = frozenset(
    (PATHS, BRIDGES, FILAMENT, CROSSINGS, QUADS, QUADS_OBJ, SURFACE, SPLINE, CHART, EDITED, EDITED_PLY, REPORT)
    + (
        CONFIG,
        VIEWER,
        FIT_PICTURE,
        REVOLUTIONS_PICTURE,
        BEFORE,
        AFTER,
        STATIONS,
        STATIONS_LEGEND,
        LAYER_FIBRES,
        LAYER_SURFACES,
    )
    + (LAMINATE, SLICE, ROUNDS, EDITED_STEP)
    + tuple(picture(name) for name in (*PICTURES, REDESIGN, SHEET))
    + tuple(movie(kind) for kind in MOVIES)
)
"""All files of a run or a redesign, their pictures included."""
