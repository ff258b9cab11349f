"""Materials of shell decks: shipped ones by name, each figure with its source, or one's own from a file."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import isfinite
from pathlib import Path
from typing import Any

from meshwind.core.errors import BadInputError
from meshwind.core.parsing import nearest, read_toml
from meshwind.core.shipped import Shipped
from meshwind.core.units import millimetres

DEFAULT = "t700-epoxy"
"""Material of a deck that is asked for none."""
_SHIPPED = Shipped(__package__, "materials", "material")
_STIFF = "e1", "e2", "nu12", "nu23", "g12", "density"
STRENGTHS = "xt", "xc", "yt", "yc", "s"
"""Strengths along the fibre in tension and compression, across it, and in shear."""
INTERACTION = "interaction"
_USUAL = -0.5
"""F12 of the criterion of Tsai and Wu over sqrt(F11 F22), where no test in two directions says better.

With it the criterion of an isotropic material as strong in tension as in compression is that of von Mises.
"""
_KG_M3 = 1e-12
"""A kilogram per cubic metre in t/mm3."""


@dataclass(frozen=True)
class Material:
    """A transversely isotropic layer, fibres along 1: moduli and strengths in MPa (N/mm2), density in t/mm3.

    words: what it is; strengths: those of `STRENGTHS` that are known, as compression's above 0; sources: where each
    figure is from, by its name; interaction: F12 of the criterion of Tsai and Wu over sqrt(F11 F22).
    """

    name: str
    e1: float
    e2: float
    nu12: float
    nu23: float
    g12: float
    density: float
    words: str = ""
    strengths: Mapping[str, float] = field(default_factory=dict)
    sources: Mapping[str, str] = field(default_factory=dict)
    interaction: float = _USUAL

    @property
    def g23(self) -> float:
        """Shear modulus of the isotropic plane across the fibres, e2 / (2 (1 + nu23))."""
        return self.e2 / (2.0 * (1.0 + self.nu23))

    def moduli(self, units: str) -> tuple[float, ...]:
        """E1, E2, E3, nu12, nu13, nu23, G12, G13, G23; moduli in N over the unit of length squared."""
        scale = millimetres(units) ** 2
        stiff = self.e1, self.e2, self.e2
        shear = self.g12, self.g12, self.g23
        return (*(scale * e for e in stiff), self.nu12, self.nu12, self.nu23, *(scale * g for g in shear))

    def mass(self, units: str) -> float:
        """Density in N s2 over the unit of length to the fourth: consistent with newtons and that unit."""
        return self.density * millimetres(units) ** 4


def material_names() -> list[str]:
    """Names of the materials that are shipped."""
    return _SHIPPED.names


def read_material(name: str = DEFAULT) -> Material:
    """Read a material by its name or from a TOML file; raises BadInputError where it is not one."""
    file = _SHIPPED.file(name)
    return _material_of(read_toml(file, "material"), file)


def _material_of(table: dict[str, Any], file: Path) -> Material:
    """A material from the table of its file, with the density in kg/m3 there."""
    where, known = f"material {file}", (*_STIFF, *STRENGTHS, INTERACTION)
    for key in table:
        if key not in (*known, "words", "sources"):
            raise BadInputError(f"{where} has no {key!r}; {nearest(key, known)}")
    lacking = [key for key in _STIFF if key not in table]
    if lacking:
        raise BadInputError(f"{where} has no {lacking[0]}; give {', '.join(_STIFF)}")
    values = {key: _number(table[key], key, where) for key in known if key in table}
    found = {key: values[key] for key in STRENGTHS if key in values}
    if found and len(found) < len(STRENGTHS):
        lacking = [key for key in STRENGTHS if key not in found]
        raise BadInputError(f"{where} has no {lacking[0]}; give all of {', '.join(STRENGTHS)}, or none")
    words, sources = table.get("words", ""), table.get("sources", {})
    if not isinstance(words, str):
        raise BadInputError(f"words of {where} is {words!r}; give text in quotes")
    if not (isinstance(sources, dict) and all(isinstance(each, str) for each in sources.values())):
        raise BadInputError(f"sources of {where} is no table of texts; give [sources] with a text for each figure")
    stiff = {key: values[key] for key in _STIFF}
    stiff["density"] *= _KG_M3
    made = Material(
        _name(file.stem), **stiff, words=words, strengths=found, sources=sources,
        interaction=values.get(INTERACTION, _USUAL),
    )  # fmt: skip
    _check(made, where)
    return made


def _number(value: Any, key: str, where: str) -> float:
    if not isinstance(value, int | float) or isinstance(value, bool) or not isfinite(value):
        raise BadInputError(f"{key} of {where} is {value!r}; give a number")
    if value <= 0.0 and not (key.startswith("nu") or key == INTERACTION):
        raise BadInputError(f"{key} of {where} is {value:g}; give a number above 0")
    return float(value)


def _name(stem: str) -> str:
    """Name for the deck: letters, digits and underscores, a letter first, as solvers take it."""
    plain = "".join(each if each.isascii() and each.isalnum() else "_" for each in stem.upper())[:70]
    return plain if plain[:1].isalpha() else f"M_{plain}"


def _check(material: Material, where: str) -> None:
    """Raise BadInputError where a deformation of the material would cost no energy, or it would bear any stress."""
    if not -1.0 < material.interaction < 1.0:
        raise BadInputError(f"{INTERACTION} of {where} is {material.interaction:g}; give a number between -1 and 1")
    cross = material.nu12**2 * material.e2 / material.e1
    if not -1.0 < material.nu23 < 1.0 - 2.0 * cross:
        raise BadInputError(
            f"{where} is not stable: nu23 is {material.nu23:g}; give one above -1 and below 1 - 2 nu12^2 e2 / e1, "
            f"{1.0 - 2.0 * cross:.3g}"
        )
