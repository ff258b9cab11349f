"""Sections of a shell deck: element sets, axes of the layers, and layers from the inside out."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.core.vectors import unit
from meshwind.exporting.plies import Plies, Ply
from meshwind.exporting.shell_groups import Groups, split


def listed(numbers: Ints) -> Iterator[str]:
    """Numbers in lines of at most twelve."""
    each = [str(number) for number in numbers]
    for first in range(0, len(each), 12):
        yield ", ".join(each[first : first + 12]) + ","


@dataclass(frozen=True)
class Sections:
    """The sections of a deck with the plies on its elements and the name of their material.

    along (k, 3): unit vectors along the part, which the angles are from.
    """

    groups: Groups
    plies: Plies
    along: Floats
    material: str

    def turned(self) -> "Sections":
        """The same where axes are fixed in space: elements of a section have nearly the same."""
        axes = np.concatenate([self.along, self.plies.normal], axis=1)
        return Sections(split(self.groups, axes), self.plies, self.along, self.material)

    def fixed(self) -> Iterator[str]:
        """Lines for CalculiX, which knows axes of layers as fixed in space alone."""
        along, around = self._axes()
        for g, name, members in self._sets():
            for ply, angle, thickness in self._families(g):
                if thickness > 0.0:
                    across = -np.sin(angle) * along[g] + np.cos(angle) * around[g]
                    direction = np.cos(angle) * along[g] + np.sin(angle) * around[g]
                    yield f"*ORIENTATION, NAME={_axes(ply, g + 1)}, SYSTEM=RECTANGULAR"
                    # 2 is square to 1 about the outward normal, which from along to around is turned about inwards
                    yield ", ".join(f"{value:.9g}" for value in (*direction, *-across))
                    yield "3, 0."
            yield f"*ELSET, ELSET={name}"
            yield from listed(members + 1)
            yield f"*SHELL SECTION, ELSET={name}, COMPOSITE"
            for which, share in self._stack():
                if (thickness := self.groups.thickness[which, g]) > 0.0:
                    axes = _axes(self.plies.families[which], g + 1)
                    yield f"{share * thickness:.9g}, 3, {self.material}, {axes}"

    def distributed(self) -> Iterator[str]:
        """Lines for Abaqus, where elements have axes of their own and layers an angle from them about the normal."""
        yield "*DISTRIBUTION TABLE, NAME=AXES_TABLE"
        yield "COORD3D, COORD3D"
        yield "*DISTRIBUTION, NAME=AXES, LOCATION=ELEMENT, TABLE=AXES_TABLE"
        yield ", 1., 0., 0., 0., 1., 0."
        across = np.cross(self.plies.normal, self.along)
        for e, (a, b) in enumerate(zip(self.along, across, strict=True), 1):
            yield f"{e}, " + ", ".join(f"{value:.9g}" for value in (*a, *b))
        yield "*ORIENTATION, NAME=ALONG, SYSTEM=RECTANGULAR"
        yield "AXES"
        yield "3, 0."
        for g, name, members in self._sets():
            yield f"*ELSET, ELSET={name}"
            yield from listed(members + 1)
            yield f"*SHELL SECTION, ELSET={name}, ORIENTATION=ALONG, COMPOSITE"
            for ply, share in self._stack():
                if (thickness := self.groups.thickness[ply, g]) > 0.0:
                    # about the outward normal, while angles of plies are positive towards s_u, the other way
                    angle = -np.degrees(self.groups.angle[ply, g])
                    axes = _axes(self.plies.families[ply], g + 1)
                    yield f"{share * thickness:.9g}, 3, {self.material}, {angle:.9g}, {axes}"

    def _sets(self) -> Iterator[tuple[int, str, Ints]]:
        order = np.argsort(self.groups.number, kind="stable")
        counts = np.bincount(self.groups.number, minlength=len(self.groups))
        for g, members in enumerate(np.split(order, np.cumsum(counts)[:-1])):
            yield g, f"E{g + 1}", members

    def _families(self, g: int) -> Iterator[tuple[Ply, float, float]]:
        yield from zip(self.plies.families, self.groups.angle[:, g], self.groups.thickness[:, g], strict=True)

    def _axes(self) -> tuple[Floats, Floats]:
        """Mean unit vectors (g, 3) along and around the part, of each section."""
        count = len(self.groups)

        def mean(vectors: Floats) -> Floats:
            return np.stack([np.bincount(self.groups.number, each, count) for each in vectors.T], axis=1)

        normal = unit(mean(self.plies.normal))
        along = mean(self.along)
        along = unit(along - (along * normal).sum(axis=1)[:, None] * normal)
        return along, np.cross(along, normal)

    def _stack(self) -> Iterator[tuple[int, float]]:
        """Families of all layers from the inside out, by number, each with its share of the family's thickness."""
        for layer in self.plies.stacks:
            if len(layer) < 2:
                yield layer[0], 1.0
            else:
                yield from ((layer[0], 0.5), (layer[1], 1.0), (layer[0], 0.5))


def _axes(ply: Ply, section: int) -> str:
    """Name of the axes of a family in a section; of the first layer it has no number."""
    layer = f"L{ply.layer}" if ply.layer > 1 else ""
    return f"{layer}{'P' if ply.family > 0 else 'M'}{section}"
