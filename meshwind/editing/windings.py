"""The windings that an edited part is to hold: numbers of revolutions, or the layers of a laminate."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.core.defaults import PATHS
from meshwind.core.errors import BadInputError
from meshwind.editing.options import WindingOptions
from meshwind.editing.stencil import pitches
from meshwind.filament.hoop import HoopPlan, hoop
from meshwind.filament.levels import levels, stretch
from meshwind.path import Paths, solve
from meshwind.planning.families import families
from meshwind.surface.surface import Surface
from meshwind.workflow.helices import Helices
from meshwind.workflow.layer_plans import HOOP, LayerPlan, read_layers
from meshwind.workflow.options import Options

HELD = 10.0
"""Friction of a hoop's fibre, which keeps it on its course: what is asked is whether it lifts, not if it slides."""
PER_TURN = 48
"""Particles of a hoop in a turn."""


@dataclass(frozen=True)
class Course:
    """One winding that a part is to hold.

    revolutions: turns of a path; paths: a family; particles: of a path; between: v where the paths start and end;
    width: of a hoop's band, 0 for the two families of a helical winding; name: what it is called.
    """

    revolutions: float
    paths: int
    particles: int
    between: tuple[float, float] = (0.0, 1.0)
    friction: float = 0.0
    width: float = 0.0
    name: str = ""

    @classmethod
    def of(cls, options: Options, revolutions: float | None = None) -> "Course":
        """That of a run's options, or the same with other revolutions."""
        if options.particles is None:
            raise BadInputError("particles is None; give a whole number, the same for all rounds of an edit")
        turned = float(options.turns) if revolutions is None else revolutions
        return cls(turned, options.paths or PATHS, options.particles, name=f"{turned:.4g} revolutions")

    @property
    def is_hoop(self) -> bool:
        """Whether it is one fibre around the part rather than two families."""
        return self.width > 0.0

    def laid(self, surface: Surface) -> Paths:
        """Its paths."""
        return self._hoop(surface, self.width) if self.is_hoop else self._helices(surface, self.paths)

    def dense(self, surface: Surface) -> Paths:
        """Its paths with others between, no further apart than the control points."""
        if self.is_hoop:
            return self._hoop(surface, min(self.width, pitches(surface)[1]))
        return self._helices(surface, self.paths * self._per_gap(surface))

    def again(self, surface: Surface, paths: Paths) -> Paths:
        """Paths laid again on another surface, from where they were."""
        return self._from(surface, np.array(paths.uv), paths.family)

    def own(self, surface: Surface, dense: Paths) -> Paths:
        """Its paths on a surface, laid from where the `dense` ones lie there."""
        if self.is_hoop:
            return self.laid(surface)
        curves = np.array(dense.uv[self.asked(len(dense))])
        return self._helices(surface, self.paths, curves)

    def asked(self, dense: int) -> Bools:
        """Mask of the dense paths, so many, that start where its own paths do; all of a hoop."""
        return np.ones(dense, dtype=bool) if self.is_hoop else np.arange(dense) % (dense // (2 * self.paths)) == 0

    def _per_gap(self, surface: Surface) -> int:
        return -(-surface.control_points.shape[0] // self.paths)

    def _helices(self, surface: Surface, paths: int, initial: Floats | None = None) -> Paths:
        ends = families(surface, paths, self.revolutions, between=self.between)
        return solve(
            surface, ends.start, ends.end, family=ends.family, particles=self.particles, friction=self.friction,
            initial=initial,
        )  # fmt: skip

    def _hoop(self, surface: Surface, width: float) -> Paths:
        """One fibre around the part, its turns so far apart; it stays within the band that is asked for."""
        uv = hoop(surface, HoopPlan(*self.between, width)).tracks.uv[0]
        particles = int(np.ceil(PER_TURN * (uv[-1, 0] - uv[0, 0]))) + 1
        u = np.linspace(uv[0, 0], uv[-1, 0], particles)
        curve = np.stack([u, np.interp(u, uv[:, 0], uv[:, 1])], axis=1)
        return self._from(surface, curve[None], np.ones(1, dtype=np.int64))

    def _from(self, surface: Surface, uv: Floats, family: Ints) -> Paths:
        return solve(
            surface, uv[:, 0], uv[:, -1], family=family, particles=uv.shape[1], friction=self.friction, initial=uv
        )


def courses(surface: Surface, asked: WindingOptions, options: Options, units: str) -> tuple[Course, ...]:
    """The windings that are asked for, on a surface; `options` has the revolutions where they are one number."""
    if asked.layers is None:
        return tuple(Course.of(options, each) for each in asked.several or (float(options.turns),))
    plans = read_layers(asked.layers, replace(options, continuous=True)).plans  # of one filament or not, all the same
    lines, found = levels(surface), []
    for at, plan in enumerate(plans, 1):
        try:
            found.append(_of_layer(surface, plan, options, units, stretch(plan.start, plan.end, lines)))
        except BadInputError as error:
            raise BadInputError(f"layer {at}: {error}") from error
    return tuple(_named(each, at) for at, each in enumerate(found, 1))


def _of_layer(surface: Surface, plan: LayerPlan, options: Options, units: str, between: tuple[float, float]) -> Course:
    paths = plan.paths if isinstance(plan.paths, int) else options.paths or PATHS
    particles = Course.of(options, 0.0).particles
    if plan.kind == HOOP:
        width = plan.ply(options, units).laying.width
        around = float(np.ptp(hoop(surface, HoopPlan(*between, width)).tracks.uv[0, :, 0]))
        return Course(around, 1, particles, between, HELD, width)
    friction = plan.friction or 0.0
    turned = plan.revolutions
    if plan.angle is not None:
        turned = (
            Helices(surface, between, friction, levels(surface), paths).turned_to(np.radians(plan.angle)).revolutions
        )
    assert isinstance(turned, float)
    return Course(turned, paths, particles, between, friction)


def _named(course: Course, layer: int) -> Course:
    """A course with the name of its layer."""
    kind = "hoop" if course.is_hoop else "helical"
    return replace(course, name=f"layer {layer}, {kind}, {course.revolutions:.4g} revolutions")


def marked_share(masks: Sequence[Bools]) -> float:
    """Share of the particles of all windings that are marked, in masks (p, n)."""
    return float(sum(int(mask.sum()) for mask in masks) / sum(mask.size for mask in masks))
