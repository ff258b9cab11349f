"""What a run is to do: its options, checked as a whole before anything is read.

The record `Options` is the one place that defines the options, their defaults and their meaning: the command line with
its help, configuration files, studies, `meshwind.wind` and meshwind.toml take them from it.
"""

from dataclasses import dataclass, field, fields

from meshwind.core.brief import brief
from meshwind.core.checks import check_switch, check_word, number, text, whole
from meshwind.core.defaults import FIT_TOLERANCE, OPENED_BY, PARTICLES, PATHS, REVOLUTIONS, SIDES, TURNAROUNDS
from meshwind.core.errors import BadInputError
from meshwind.core.option import option
from meshwind.core.parsing import AUTO, count, paths, turns
from meshwind.core.spoken import argument
from meshwind.core.units import ASSUMED, MILLIMETRES, check_units
from meshwind.workflow.option_checks import FIELD, check_memory, check_resolution, read_friction

_STEEPEST = 89.0
"""Degrees of the steepest helix: past them it is a hoop."""
_MOST_CHOSEN = 1601
"""Particles per path that memory is checked for where their number is left open."""

_ABOVE_NOTHING = ("opening", "spacing", "band_width", "band_thickness", "tex", "fibre_density", "resin_density")
"""Options that are numbers above 0."""
PART, FIBRES, SURFACE = "The part", "The fibres", "The surface"
"""Groups of the options."""
IN_MESH_UNITS = "in the mesh's units"
OVER_DIAGONAL = "over the part's diagonal"


@dataclass(frozen=True)
class Options:
    """Options of a run; raises BadInputError for one that cannot be used, with its value and what it may be.

    The fields say what each option means; `particles` is None where their number is to be chosen, and `revolutions`
    where they are left to the default or to the angle, so that both given can be told from one.
    """

    paths: int | None = field(
        default=PATHS,
        metadata=option(
            "Number of paths per family; auto takes as many as cover the part with bands of the width given",
            FIBRES,
            metavar="COUNT",
            words=(AUTO,),
            read=paths,
        ),
    )
    revolutions: float | str | None = field(
        default=None,
        metadata=option(
            "Turns of a path from end to end, as in 0.5 or 5/12; auto picks the value with stable paths and least "
            "bridging",
            FIBRES,
            otherwise=f"{REVOLUTIONS:g}, or those of the angle",
            metavar="TURNS",
            words=(AUTO,),
            read=turns,
        ),
    )
    particles: int | None = field(
        default=PARTICLES,
        metadata=option(
            "Number of particles per path; auto picks as many as an error of the lengths of 1e-5 needs",
            FIBRES,
            metavar="COUNT",
            words=(AUTO,),
            read=count,
        ),
    )
    friction: float | str = field(
        default=0.0,
        metadata=option(
            f"Coefficient of friction between fibre and part, or {FIELD}NAME for a scalar of the mesh file",
            FIBRES,
            metavar="MU",
            read=str,
        ),
    )
    component: int | None = field(
        default=None,
        metadata=option(
            "Piece of the mesh file to take, by decreasing area; 0 is the largest", PART, otherwise="the largest"
        ),
    )
    ends: str = field(
        default=AUTO,
        metadata=option(
            'Where the ends are: auto, x, y, z, two points "x,y,z x,y,z", or two rims "loops 0 1"',
            PART,
            metavar="ENDS",
            words=(AUTO, "x", "y", "z", "loops"),
        ),
    )
    opening: float | None = field(
        default=None,
        metadata=option("Radius of the opening at a closed end", PART, unit=IN_MESH_UNITS, otherwise="from the part"),
    )
    side: str = field(
        default=SIDES[0],
        metadata=option("Skin of a part with a wall: outer or inner", PART, metavar="SIDE", words=SIDES),
    )
    opening_by: str = field(
        default=AUTO,
        metadata=option(
            "How a closed end is opened: along a level line of the distance to its pole, by a plane square to the "
            "axis, or auto, by the plane if the level line's rim is far less even",
            PART,
            metavar="HOW",
            words=OPENED_BY,
        ),
    )
    tolerance: float = field(
        default=FIT_TOLERANCE,
        metadata=option("Largest distance of a mesh vertex from the fitted surface", SURFACE, unit=OVER_DIAGONAL),
    )
    threshold: float | None = field(
        default=None,
        metadata=option(
            "Largest gap between fibre and surface that is no bridge; 0 counts every gap",
            FIBRES,
            unit=IN_MESH_UNITS,
            otherwise="the surface's uncertainty",
        ),
    )
    worst_fit: float = field(
        default=0.1,
        metadata=option(
            "Largest distance between surface and mesh that is accepted at all", SURFACE, unit=OVER_DIAGONAL
        ),
    )
    units: str | None = field(
        default=None,
        metadata=option(
            "Unit of the mesh: mm, cm, m, um, in, ft; nothing is converted",
            PART,
            otherwise=f"that of the file, or {ASSUMED}",
            metavar="UNIT",
            words=tuple(MILLIMETRES),
        ),
    )
    spacing: float | None = field(
        default=None,
        metadata=option(
            "Largest distance between neighbouring paths: paths are added until it is kept", FIBRES, unit=IN_MESH_UNITS
        ),
    )
    band_width: float | None = field(
        default=None,
        metadata=option("Width of the fibre band", FIBRES, unit=IN_MESH_UNITS, otherwise="one layer per family"),
    )
    band_thickness: float | None = field(
        default=None,
        metadata=option(
            "Mean thickness of the band", FIBRES, unit=IN_MESH_UNITS, otherwise="from the tex, where that is given"
        ),
    )
    tex: float | None = field(
        default=None,
        metadata=option(
            "Mass of one tow, in g/km: masses follow from it, and the band's thickness from it and the width", FIBRES
        ),
    )
    tows: int | None = field(
        default=None, metadata=option("Tows side by side in the band", FIBRES, metavar="COUNT", otherwise="1")
    )
    fibre_density: float | None = field(
        default=None, metadata=option("Density of the fibre in g/cm3", FIBRES, otherwise="1.8, that of carbon")
    )
    resin_density: float | None = field(
        default=None, metadata=option("Density of the resin in g/cm3", FIBRES, otherwise="1.2")
    )
    fibre_volume: float | None = field(
        default=None, metadata=option("Share of the fibre in the laminate's volume", FIBRES, otherwise="0.6")
    )
    pins: str | None = field(
        default=None,
        metadata=option(
            "CSV file of the paths' ends, with the columns u0,v0,u1,v1 or x0,y0,z0,x1,y1,z1", FIBRES, is_file=True
        ),
    )

    angle: float | None = field(
        default=None,
        metadata=option(
            "Winding angle from the direction along the part, in degrees, instead of the revolutions: the median over "
            "the paths",
            FIBRES,
            otherwise="that of the revolutions",
        ),
    )
    angle_at: str | None = field(
        default=None,
        metadata=option(
            "Where the angle is to be: v=0.5, z=120 along the axis, or fraction=0.5 of the length",
            FIBRES,
            metavar="PLACE",
            otherwise="the widest place",
        ),
    )
    continuous: bool = field(
        default=False,
        metadata=option("Wind each layer as one closed filament, with its turnarounds at both ends", FIBRES),
    )
    turn_start: str = field(
        default=AUTO,
        metadata=option(
            "Turnaround at the start: collar, pins, shaft, cap (a closed end, whose opening sets the angle), or auto, "
            "a collar where friction holds on a short one and pins elsewhere",
            FIBRES,
            metavar="KIND",
            words=(AUTO, *TURNAROUNDS),
        ),
    )
    turn_end: str = field(
        default=AUTO,
        metadata=option("Turnaround at the end, likewise", FIBRES, metavar="KIND", words=(AUTO, *TURNAROUNDS)),
    )

    __repr__ = brief

    def __post_init__(self) -> None:
        from meshwind.mesh.opening.choose_ends import parse_ends  # late: help shows these fields without loading NumPy

        set_ = object.__setattr__
        if self.paths is not None:
            set_(self, "paths", whole(self.paths, "paths", 1))
        elif self.band_width is None or self.pins is not None or self.spacing is not None:
            raise BadInputError(
                f"paths that are to cover the part need {argument('band_width')}, no pins and no spacing"
            )
        if self.particles is not None:
            set_(self, "particles", whole(self.particles, "particles", 3))
        if isinstance(self.revolutions, str):
            set_(self, "revolutions", turns(self.revolutions))
        if self.revolutions is not None and self.revolutions != AUTO:
            set_(self, "revolutions", number(self.revolutions, "revolutions", 0.0))
        check_resolution(self.turns, self.particles or _MOST_CHOSEN)
        set_(self, "friction", read_friction(self.friction))
        if self.component is not None:
            set_(self, "component", whole(self.component, "component", 0))
        set_(self, "ends", parse_ends(self.ends).text)  # scripts may give two points
        check_word(self.side, "side", SIDES)
        check_word(self.opening_by, "opening_by", OPENED_BY)
        set_(self, "tolerance", number(self.tolerance, "tolerance", 1e-12, 1.0))
        if self.threshold is not None:
            set_(self, "threshold", number(self.threshold, "threshold", 0.0))
        set_(self, "worst_fit", number(self.worst_fit, "worst_fit", 0.0, above=True))
        if self.units is not None:
            check_units(self.units)
        for name in _ABOVE_NOTHING:
            if getattr(self, name) is not None:
                set_(self, name, number(getattr(self, name), name, 0.0, above=True))
        if self.tows is not None:
            set_(self, "tows", whole(self.tows, "tows", 1))
        if self.fibre_volume is not None:
            set_(self, "fibre_volume", number(self.fibre_volume, "fibre_volume", 0.0, 1.0, above=True))
        if self.pins is not None and not (isinstance(self.pins, str) and self.pins.strip()):
            raise BadInputError(f"pins is {text(self.pins)}; give the path of a CSV file of the paths' ends")
        check_switch(self.continuous, "continuous")
        _check_turns(self)
        _check_angle(self)
        if self.pins is not None and self.spacing is not None:
            raise BadInputError("pins say where all paths end, and spacing adds paths between them; give one of both")
        turned = 1.0 if isinstance(self.turns, str) else self.turns
        check_memory(self.paths or PATHS, self.particles or _MOST_CHOSEN, turned)

    @property
    def turns(self) -> float | str:
        """Revolutions that are given, or else the default."""
        return REVOLUTIONS if self.revolutions is None else self.revolutions

    def written(self) -> dict[str, object]:
        """The options by name, as they stand in files: "auto" for a number of particles that is to be chosen."""
        values = {each.name: getattr(self, each.name) for each in fields(self)}
        return values | {name: AUTO for name in ("paths", "particles") if getattr(self, name) is None}


def _check_angle(options: Options) -> None:
    """Raise BadInputError for an angle that no helix has, or beside what sets it already."""
    if options.angle is None:
        if options.angle_at is not None:
            raise BadInputError(f"angle_at is {text(options.angle_at)} without an angle; give angle as well")
        return
    object.__setattr__(options, "angle", number(options.angle, "angle", 0.0, _STEEPEST))
    if options.revolutions is not None or options.pins is not None:
        raise BadInputError("angle sets the revolutions, and so do revolutions and pins; give one of them")


def _check_turns(options: Options) -> None:
    """Raise BadInputError for turnarounds without a filament, and for what cannot be wound as one."""
    for name in ("turn_start", "turn_end"):
        check_word(getattr(options, name), name, (AUTO, *TURNAROUNDS))
        if getattr(options, name) != AUTO and not options.continuous:
            raise BadInputError(f"{name} is given without continuous; set {argument('continuous')} as well")
    for name in ("spacing", "pins"):
        if options.continuous and getattr(options, name) is not None:
            raise BadInputError(
                f"continuous needs paths that are spread evenly over the rims, and {name} sets others; give paths"
            )
