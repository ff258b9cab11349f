"""A simple material with stated numbers, in whatever unit of length the part has."""

from dataclasses import dataclass

from meshwind.core.units import millimetres


@dataclass(frozen=True)
class Material:
    """A transversely isotropic layer, fibres along 1: moduli in MPa (N/mm2), density in t/mm3.

    By default carbon fibre of standard modulus in epoxy, 60 % of fibre by volume, from data sheets' common range.
    """

    name: str = "CARBON_EPOXY"
    e1: float = 135000.0
    e2: float = 9000.0
    nu12: float = 0.3
    nu23: float = 0.4
    g12: float = 4800.0
    density: float = 1.6e-9

    @property
    def g23(self) -> float:
        """Shear modulus across the fibres: that of the isotropic plane, e2 / (2 (1 + nu23))."""
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
