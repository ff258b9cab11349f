"""What a run is to do: its options, checked as a whole before anything is read.

The record `Options` is the one place that defines the options, their defaults and their meaning: the command line with
its help, configuration files, studies, `meshwind.wind` and meshwind.toml take them from it.
"""

from dataclasses import dataclass, field, fields
from math import isfinite
from numbers import Integral, Real

from meshwind.core.defaults import FIT_TOLERANCE, OPENED_BY, PARTICLES, PATHS, SIDES, STEPS_PER_TURN, TURNAROUNDS
from meshwind.core.errors import BadInputError
from meshwind.core.option import option
from meshwind.core.parsing import AUTO, count, paths, shortened, turns
from meshwind.core.units import ASSUMED, MILLIMETRES, check_units

FIELD = "field:"
"""Before the name of a scalar field in a mesh file."""
MEMORY = 4e9
"""Most bytes that a run may take."""
_BYTES_PER_PARTICLE, _BYTES_PER_CROSSING = 350, 1500
"""Peak memory of a run, measured from 3e5 to 1.6e6 particles and 2e4 to 5e5 crossings."""
_STEEPEST = 89.0
"""Degrees of the steepest helix: past them it is a hoop."""
_MOST_CHOSEN = 1601
"""Particles per path that memory is checked for where their number is left open."""

PART, FIBRES, SURFACE = "The part", "The fibres", "The surface"
"""Groups of the options."""
IN_MESH_UNITS = "in the mesh's units"
OVER_DIAGONAL = "over the part's diagonal"


@dataclass(frozen=True)
class Options:
    """Options of a run; raises BadInputError for one that cannot be used, with its value and what it may be.

    The fields say what each option means; `particles` is None where their number is to be chosen.
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
    revolutions: float | str = field(
        default=0.5,
        metadata=option(
            "Turns of a path from end to end, as in 0.5 or 5/12; auto picks the value with stable paths and least "
            "bridging",
            FIBRES,
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
    linear_density: float | None = field(
        default=None,
        metadata=option("Mass of the fibre per unit of its length, from which its mass is computed", FIBRES),
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

    def __post_init__(self) -> None:
        from meshwind.mesh.opening.choose_ends import parse_ends  # late: help shows these fields without loading NumPy

        set_ = object.__setattr__
        if self.paths is not None:
            set_(self, "paths", _whole(self.paths, "paths", 1))
        elif self.band_width is None or self.pins is not None or self.spacing is not None:
            raise BadInputError(
                "paths that are to cover the part need band_width (--band-width), no pins and no spacing"
            )
        if self.particles is not None:
            set_(self, "particles", _whole(self.particles, "particles", 3))
        if self.revolutions != AUTO:
            set_(self, "revolutions", _number(self.revolutions, "revolutions", 0.0))
        _check_resolution(self.revolutions, self.particles or _MOST_CHOSEN)
        set_(self, "friction", _friction(self.friction))
        if self.component is not None:
            set_(self, "component", _whole(self.component, "component", 0))
        parse_ends(self.ends)
        _check_word(self.side, "side", SIDES)
        _check_word(self.opening_by, "opening_by", OPENED_BY)
        set_(self, "tolerance", _number(self.tolerance, "tolerance", 1e-12, 1.0))
        if self.threshold is not None:
            set_(self, "threshold", _number(self.threshold, "threshold", 0.0))
        set_(self, "worst_fit", _number(self.worst_fit, "worst_fit", 0.0, above=True))
        if self.units is not None:
            check_units(self.units)
        for name in ("opening", "spacing", "band_width", "linear_density"):
            if getattr(self, name) is not None:
                set_(self, name, _number(getattr(self, name), name, 0.0, above=True))
        if self.pins is not None and not (isinstance(self.pins, str) and self.pins.strip()):
            raise BadInputError(f"pins is {_text(self.pins)}; give the path of a CSV file of the paths' ends")
        _check_turns(self)
        _check_angle(self)
        if self.pins is not None and self.spacing is not None:
            raise BadInputError("pins say where all paths end, and spacing adds paths between them; give one of both")
        turned = 1.0 if isinstance(self.revolutions, str) else self.revolutions
        _check_memory(self.paths or PATHS, self.particles or _MOST_CHOSEN, turned)

    def written(self) -> dict[str, object]:
        """The options by name, as they stand in files: "auto" for a number of particles that is to be chosen."""
        values = {each.name: getattr(self, each.name) for each in fields(self)}
        return values | {name: AUTO for name in ("paths", "particles") if getattr(self, name) is None}


def _check_angle(options: Options) -> None:
    """Raise BadInputError for an angle that no helix has, or beside what sets it already."""
    if options.angle is None:
        if options.angle_at is not None:
            raise BadInputError(f"angle_at is {_text(options.angle_at)} without an angle; give angle as well")
        return
    object.__setattr__(options, "angle", _number(options.angle, "angle", 0.0, _STEEPEST))
    if options.revolutions != Options.revolutions or options.pins is not None:
        raise BadInputError("angle sets the revolutions, and so do revolutions and pins; give one of them")


def _check_turns(options: Options) -> None:
    """Raise BadInputError for turnarounds without a filament, and for what cannot be wound as one."""
    for name in ("turn_start", "turn_end"):
        _check_word(getattr(options, name), name, (AUTO, *TURNAROUNDS))
        if getattr(options, name) != AUTO and not options.continuous:
            raise BadInputError(f"{name} is given without continuous; set continuous (--continuous) as well")
    for name in ("spacing", "pins"):
        if options.continuous and getattr(options, name) is not None:
            raise BadInputError(
                f"continuous needs paths that are spread evenly over the rims, and {name} sets others; give paths"
            )


def _check_resolution(revolutions: float | str, particles: int) -> None:
    """Raise BadInputError for more revolutions than the particles of a path can follow."""
    most = (particles - 1) / STEPS_PER_TURN
    if not isinstance(revolutions, str) and revolutions > most:
        raise BadInputError(
            f"revolutions is {_text(revolutions)}; give a number from 0 to {most:g}, the most that "
            f"{particles} particles per path can follow, or more particles"
        )


def _friction(value: object) -> float | str:
    """The coefficient, or the name of a field."""
    if not isinstance(value, str):
        return _number(value, "friction", 0.0, 10.0)
    if value.startswith(FIELD) and value.removeprefix(FIELD).strip():
        return value
    try:
        number = float(value)
    except ValueError:
        raise BadInputError(
            f"friction is {value!r}; give a coefficient such as 0.2, or {FIELD}NAME for a scalar of the mesh file"
        ) from None
    return _number(number, "friction", 0.0, 10.0)


def _whole(value: object, name: str, least: int) -> int:
    if isinstance(value, bool) or not isinstance(value, Integral) or value < least:
        raise BadInputError(f"{name} is {_text(value)}; give a whole number from {least} up")
    return int(value)


def _number(value: object, name: str, low: float, high: float | None = None, above: bool = False) -> float:
    """A finite number from low (or, with `above`, above low) to high."""
    number = float(value) if isinstance(value, Real) and not isinstance(value, bool) else float("nan")
    inside = isfinite(number) and (number > low if above else number >= low) and (high is None or number <= high)
    if inside:
        return number
    allowed = f"above {low:g}" if above else f"from {low:g} up" if high is None else f"from {low:g} to {high:g}"
    raise BadInputError(f"{name} is {_text(value)}; give a number {allowed}")


def _check_word(value: object, name: str, words: tuple[str, ...]) -> None:
    if value not in words:
        raise BadInputError(f"{name} is {_text(value)}; give {', '.join(words[:-1])} or {words[-1]}")


def _text(value: object) -> str:
    """A value as a few characters of text."""
    text = f"{float(value):g}" if isinstance(value, Real) and not isinstance(value, bool) else repr(value)
    return shortened(text)


def _check_memory(paths: int, particles: int, revolutions: float) -> None:
    crossings = 2.0 * revolutions * float(paths) ** 2
    needed = 2.0 * paths * particles * _BYTES_PER_PARTICLE + crossings * _BYTES_PER_CROSSING
    if needed > MEMORY:
        raise BadInputError(
            f"{paths} paths per family of {particles} particles and {revolutions:g} revolutions would need about "
            f"{needed / 1e9:,.0f} GB of memory, and {MEMORY / 1e9:.0f} are allowed; give fewer paths"
        )
