"""What a run is asked to do, checked whole before anything is read."""

from dataclasses import dataclass
from math import isfinite
from numbers import Integral, Real

from meshwind.core.errors import BadInputError
from meshwind.core.parsing import AUTO, shortened
from meshwind.core.units import check_units
from meshwind.mesh.opening.ends import parse
from meshwind.planning.revolutions import STEPS_A_TURN

FIELD = "field:"
"""Before the name of a scalar field in a mesh file."""
MEMORY = 4e9
"""Most bytes that a run may take."""
_BYTES_A_PARTICLE, _BYTES_A_CROSSING = 350, 1500
"""Peak memory of a run, measured from 3e5 to 1.6e6 particles and 2e4 to 5e5 crossings."""
_MOST_CHOSEN = 1601
"""Particles a path that memory is checked for where their number is left open."""


@dataclass(frozen=True)
class Options:
    """Options of a run; one that cannot be used raises BadInputError with its value and what it may be.

    paths: a family; revolutions: turns from end to end, or "auto"; particles: a path, None to have them chosen;
    friction: coefficient, or "field:NAME" for a scalar of the mesh file; component: the piece of the mesh by its
    rank of area; ends: "auto", "x", "y", "z", two points "x,y,z x,y,z" or two rims "loops 0 1"; opening: radius at a
    closed end in the mesh's units; tolerance: largest distance of a vertex from the surface over the mesh's diagonal;
    worst_fit: largest distance between surface and mesh over the diagonal that is wound at all; units: the name of
    the mesh's unit, "" if unknown; spacing: largest distance between neighbours, paths are added until it is kept;
    band_width: of the fibre; linear_density: mass over length of the fibre, per unit of length; pins: a CSV file of
    the paths' ends.
    """

    paths: int = 12
    revolutions: float | str = 0.5
    particles: int | None = 401
    friction: float | str = 0.0
    component: int = 0
    ends: str = "auto"
    opening: float | None = None
    tolerance: float = 1e-5
    worst_fit: float = 0.1
    units: str = ""
    spacing: float | None = None
    band_width: float | None = None
    linear_density: float | None = None
    pins: str | None = None

    def __post_init__(self) -> None:
        set_ = object.__setattr__
        set_(self, "paths", _whole(self.paths, "paths", 1))
        if self.particles is not None:
            set_(self, "particles", _whole(self.particles, "particles", 3))
        most = ((self.particles or _MOST_CHOSEN) - 1) / STEPS_A_TURN
        if self.revolutions != AUTO:
            set_(self, "revolutions", _number(self.revolutions, "revolutions", 0.0))
        if not isinstance(self.revolutions, str) and self.revolutions > most:
            raise BadInputError(
                f"revolutions is {_told(self.revolutions)}; give a number from 0 to {most:g}, which is as many as "
                f"{self.particles or _MOST_CHOSEN} particles a path can follow, or more particles"
            )
        set_(self, "friction", _friction(self.friction))
        set_(self, "component", _whole(self.component, "component", 0))
        parse(self.ends)
        if self.opening is not None:
            set_(self, "opening", _number(self.opening, "opening", 0.0, above=True))
        set_(self, "tolerance", _number(self.tolerance, "tolerance", 1e-12, 1.0))
        set_(self, "worst_fit", _number(self.worst_fit, "worst_fit", 0.0, above=True))
        check_units(self.units)
        for name in ("spacing", "band_width", "linear_density"):
            if getattr(self, name) is not None:
                set_(self, name, _number(getattr(self, name), name, 0.0, above=True))
        if self.pins is not None and not (isinstance(self.pins, str) and self.pins.strip()):
            raise BadInputError(f"pins is {_told(self.pins)}; give the path of a CSV file of the paths' ends")
        if self.pins is not None and self.spacing is not None:
            raise BadInputError("pins say where all paths end, and spacing adds paths between them; give one of both")
        _check_memory(
            self.paths, self.particles or _MOST_CHOSEN, 1.0 if isinstance(self.revolutions, str) else self.revolutions
        )


def _friction(value: object) -> float | str:
    """A coefficient, or the name of a field."""
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
        raise BadInputError(f"{name} is {_told(value)}; give a whole number from {least} up")
    return int(value)


def _number(value: object, name: str, low: float, high: float | None = None, above: bool = False) -> float:
    """A finite number from low (or, with `above`, above low) to high."""
    number = float(value) if isinstance(value, Real) and not isinstance(value, bool) else float("nan")
    inside = isfinite(number) and (number > low if above else number >= low) and (high is None or number <= high)
    if inside:
        return number
    allowed = f"above {low:g}" if above else f"from {low:g} up" if high is None else f"from {low:g} to {high:g}"
    raise BadInputError(f"{name} is {_told(value)}; give a number {allowed}")


def _told(value: object) -> str:
    """The value as a few characters of text."""
    text = f"{float(value):g}" if isinstance(value, Real) and not isinstance(value, bool) else repr(value)
    return shortened(text)


def _check_memory(paths: int, particles: int, revolutions: float) -> None:
    crossings = 2.0 * revolutions * float(paths) ** 2
    needed = 2.0 * paths * particles * _BYTES_A_PARTICLE + crossings * _BYTES_A_CROSSING
    if needed > MEMORY:
        raise BadInputError(
            f"{paths} paths a family of {particles} particles and {revolutions:g} revolutions would need about "
            f"{needed / 1e9:,.0f} GB of memory, and {MEMORY / 1e9:.0f} are allowed; give fewer paths"
        )
