"""Paths on layers on layers: how far their lengths are off the exact ones on a part that was raised by the volume."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import matplotlib.pyplot as plt
import numpy as np
from comparison.attempt import OURS
from comparison.problem import TURN
from numpy.polynomial import Chebyshev
from scipy.optimize import brentq

import meshwind as mw
from charts.maps import Row, key, paint, settled, worst_of
from charts.record import Results
from charts.style import save
from meshwind.core.cast import Floats
from meshwind.core.errors import BadInputError
from meshwind.filament.laminate import Ply, helical_layer
from meshwind.filament.levels import levels
from meshwind.filament.thickness import Laying
from meshwind.path import Status
from meshwind.surface import Surface, shapes

LENGTH, WIDTH = 300.0, 8.0
"""Of the parts from rim to rim, and of the band, in mm."""
PATHS, PARTICLES, TURNS = 33, 101, 0.6
"""Of each of the two families of every layer; on the tube so many bands lie edge to edge."""
LAYERS = (1, 2, 4)
"""Layers below the paths that are measured."""
THICKNESS = (0.1, 0.25, 0.5, 1.0)
"""Of the band, in mm."""
SHARE = 0.1
"""Of what the layers below add to the length: what a path on them may be off, as a layer states no error."""
DEGREE, POINTS, STEPS = 16, 200, 8
"""Of a profile's polynomials, points of its integrals, and Newton's steps to a height."""
SHARES = np.linspace(0.0, 1.0, 201)
"""Points of a profile through which the next one goes."""
NEAR = 1e-9
"""How near to the least radius the constant of Clairaut is looked for, relative."""


def straight(z: Floats) -> Floats:
    """Radius of a tube."""
    return np.full_like(z, 50.0)


def bulged(z: Floats) -> Floats:
    """Radius of a barrel."""
    return np.asarray(40.0 + 20.0 * (1.0 - (2.0 * z / LENGTH - 1.0) ** 2))


PARTS: dict[str, Callable[[Floats], Floats]] = {"tube": straight, "barrel": bulged}


class Course(NamedTuple):
    """A geodesic from rim to rim: its length, and its constant of Clairaut."""

    length: float
    constant: float


@dataclass(frozen=True)
class Profile:
    """A part of revolution: z and r along its profile, polynomials over 0 to 1."""

    z: Chebyshev
    r: Chebyshev

    @classmethod
    def through(cls, z: Floats, r: Floats) -> "Profile":
        """Through points (n,) at even shares."""
        return cls(*(Chebyshev.fit(SHARES, of, DEGREE, [0.0, 1.0]) for of in (z, r)))

    @classmethod
    def of(cls, radius: Callable[[Floats], Floats]) -> "Profile":
        """That of a part."""
        return cls.through(LENGTH * SHARES, radius(LENGTH * SHARES))

    def course(self, twist: float) -> Course:
        """The geodesic with a twist from rim to rim, in radians, by Clairaut."""
        share, weight = np.polynomial.legendre.leggauss(POINTS)
        share = 0.5 * (share + 1.0)
        r, step = self.r(share), 0.5 * weight * np.hypot(self.z.deriv()(share), self.r.deriv()(share))

        def over(c: float) -> Floats:
            return np.asarray(step / np.sqrt(r**2 - c**2))

        c = float(brentq(lambda c: float((c / r * over(c)).sum()) - twist, 0.0, float(r.min()) * (1.0 - NEAR)))
        return Course(float((r * over(c)).sum()), c)

    def raised(self, thickness: float) -> "Profile":
        """The profile above a layer whose geodesics deposit their volume evenly around."""
        c = self.course(TURN * TURNS).constant
        z, r, dz, dr = (each(SHARES) for each in (self.z, self.r, self.z.deriv(), self.r.deriv()))
        deposit = PATHS * WIDTH * thickness / (np.pi * np.sqrt(r**2 - c**2))
        speed = np.hypot(dz, dr)
        around = dz / speed / r
        along = -(dz * self.r.deriv(2)(SHARES) - dr * self.z.deriv(2)(SHARES)) / speed**3
        height = deposit
        for _ in range(STEPS):  # a height h has the volume h + (k1 + k2) h^2 / 2 + k1 k2 h^3 / 3 an area
            h = height
            over = h + 0.5 * (around + along) * h**2 + around * along * h**3 / 3.0 - deposit
            height = h - over / (1.0 + (around + along) * h + around * along * h**2)
        return Profile.through(z - height * dr / speed, r + height * dz / speed)


def stack(name: str, thickness: float, layers: tuple[int, ...]) -> list[Row]:
    """A row for each number of layers below."""
    profile = Profile.of(PARTS[name])
    bare = profile.course(TURN * TURNS).length
    surface: Surface = shapes.revolution(PARTS[name], 0.0, LENGTH, (48, 48))
    rows: list[Row] = []
    for below in range(max(layers) + 1):
        ends = mw.families(surface, PATHS, TURNS)
        paths = mw.solve(surface, ends.start, ends.end, family=ends.family, particles=PARTICLES)
        exact = profile.course(TURN * TURNS).length
        if below in layers:
            off, added = float(np.abs(paths.length - exact).max()), exact - bare
            bound = float(paths.length_error.max()) + SHARE * abs(added)
            results = [settled(status, off <= bound) for status in paths.status]
            rows.append(dict(method=OURS, part=name, thickness=thickness, layers=below, result=worst_of(results),
                             why=Status(int(paths.status.max())).name, length=exact, added=added, error=off,
                             allowed=bound))  # fmt: skip
        if below == max(layers):
            break
        try:
            surface = helical_layer(paths, Ply(Laying(WIDTH, thickness)), levels(surface)).raised.surface
        except BadInputError as refusal:
            about = dict(method=OURS, part=name, thickness=thickness, result="refused", why=str(refusal))
            return rows + [about | dict(layers=more) for more in layers if more > below]
        profile = profile.raised(thickness)
    return rows


def draw(results: Results, quick: bool) -> None:
    """A map for each part, over the layers below and the thickness of their band."""
    layers, thickness = (LAYERS[::2], THICKNESS[::2]) if quick else (LAYERS, THICKNESS)
    figure, grid = plt.subplots(1, len(PARTS), figsize=(6.8 * len(PARTS), 4.8), sharey=True)
    rows: list[Row] = []
    for name, axes in zip(PARTS, grid, strict=True):
        found = [stack(name, each, layers) for each in thickness]
        rows += [row for line in found for row in line]
        for j, line in enumerate(found):
            for i, row in enumerate(line):
                if "error" not in row:
                    continue
                words = f"{100.0 * row['error'] / abs(row['added']):.2g} %\n{row['added']:.2g} mm"
                axes.text(i, j - 0.25, words, ha="center", va="center", fontsize=7)
        classes = [[row["result"] for row in line] for line in found]
        places = [float(k) for k in range(len(layers))]
        paint(axes, places, [float(k) for k in range(len(thickness))], classes)
        axes.set_xticks(places, [str(each) for each in layers])
        axes.set_yticks(range(len(thickness)), [f"{each:g}" for each in thickness])
        axes.set_xlabel("layers below")
        axes.set_title(f"{name} of radius {PARTS[name](np.zeros(1))[0]:g} to {PARTS[name](np.array([150.0]))[0]:g} mm")
        key(axes, classes)
    grid[0].set_ylabel("thickness of the band [mm]")
    figure.suptitle(
        f"meshwind on layers on layers: {2 * PATHS} paths of {TURNS:g} revolutions a layer, {LENGTH:g} mm long, band"
        f" {WIDTH:g} mm wide; right: lengths within {SHARE:.0%} of what the\nlayers below add, by Clairaut on a profile"
        " raised by the same volume (numbers: how far off in % of that, and what they add)"
    )
    figure.tight_layout()
    save(figure, results.folder, "rough_layers")
    results.table("rough_layers", rows)
