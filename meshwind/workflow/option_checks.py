"""Checks of options against each other and the machine; each raises BadInputError with one line."""

from numbers import Real

from meshwind.core.checks import number, text
from meshwind.core.defaults import STEPS_PER_TURN
from meshwind.core.errors import BadInputError
from meshwind.core.memory import machine_memory

FIELD = "field:"
"""Before the name of a scalar field in a mesh file."""
SHARE = 0.8
"""Of the machine's memory that a run may take: the rest is the system's, and the renderer's."""
_BYTES_PER_PARTICLE, _BYTES_PER_CROSSING = 350, 1500
"""Peak memory of a run, measured from 3e5 to 1.6e6 particles and 2e4 to 5e5 crossings."""


def check_resolution(revolutions: float | str, particles: int) -> None:
    """Raise BadInputError for more revolutions than the particles of a path can follow."""
    most = (particles - 1) / STEPS_PER_TURN
    if not isinstance(revolutions, str) and revolutions > most:
        raise BadInputError(
            f"revolutions is {text(revolutions)}; give a number from 0 to {most:g}, the most that "
            f"{particles} particles per path can follow, or more particles"
        )


def check_memory(paths: int, particles: int, revolutions: float) -> None:
    """Raise BadInputError for a run that would take more memory than the machine has."""
    crossings = 2.0 * revolutions * float(paths) ** 2
    needed = 2.0 * paths * particles * _BYTES_PER_PARTICLE + crossings * _BYTES_PER_CROSSING
    allowed = SHARE * machine_memory()
    if needed > allowed:
        raise BadInputError(
            f"{paths} paths per family of {particles} particles and {revolutions:g} revolutions would need about "
            f"{needed / 1e9:,.0f} GB of memory, and this machine has {allowed / 1e9:,.3g} for a run; give fewer paths"
        )


def read_friction(value: object) -> float | str:
    """The coefficient, or the name of a field."""
    if not isinstance(value, str):
        if not isinstance(value, Real):
            raise BadInputError(
                f"friction is {text(value)}; give a number, or {FIELD}NAME for a scalar of the mesh file; "
                "tables and functions are for solve(..., friction=...)"
            )
        return number(value, "friction", 0.0, 10.0)
    if value.startswith(FIELD) and value.removeprefix(FIELD).strip():
        return value
    try:
        coefficient = float(value)
    except ValueError:
        raise BadInputError(
            f"friction is {value!r}; give a coefficient such as 0.2, or {FIELD}NAME for a scalar of the mesh file"
        ) from None
    return number(coefficient, "friction", 0.0, 10.0)
