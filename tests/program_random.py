"""Random programs: parts of many kinds, courses, and machines; and what must hold of each."""

from dataclasses import dataclass, replace
from math import pi

import igl
import numpy as np
from hypothesis import strategies as st
from program_parts import along, numbered, work
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

import meshwind as mw
from meshwind.core.cast import Floats, Ints
from meshwind.filament.course import Kind, joined
from meshwind.filament.filament import Filament
from meshwind.program.axes import limits_of, moved
from meshwind.program.blocks import Blocks
from meshwind.program.machine import Eye, Machine, machine_names, read_machine
from meshwind.program.program import Program
from meshwind.program.work import Work
from meshwind.surface import Surface
from meshwind.surface.evaluate import SU, SV
from meshwind.surface.grid import Grid, grid

SPANS = (16, 12)


@dataclass(frozen=True)
class Tube:
    """A tube: half axes, lobes, waves and steps along it, a spine that leaves the axis, slanted rims, and a pose."""

    a: float
    b: float
    star: float
    lobes: int
    wave: float
    waves: float
    step: float
    off: float
    slant: float
    pose: tuple[float, float, float]

    def surface(self) -> Surface:
        """Its surface, turned and moved."""
        turned = Rotation.from_rotvec(self.pose).as_matrix()

        def formula(u: Floats, v: Floats) -> Floats:
            turn, z = 2.0 * pi * u, v - 0.5
            r = 1.0 + self.star * np.cos(self.lobes * turn + 2.0 * v) + self.wave * np.sin(2.0 * pi * self.waves * z)
            r = r * (1.0 + self.step * np.tanh(12.0 * (z + 0.2)))
            x = self.a * r * np.cos(turn) + self.off * np.sin(pi * v)
            y = self.b * r * np.sin(turn) + 0.5 * self.off * np.sin(2.0 * pi * v)
            points = np.stack([x, y, 200.0 * z + self.slant * np.cos(turn) * (2.0 * v - 1.0)], axis=-1)
            return np.asarray(points @ turned.T + [30.0, -50.0, 7.0])

        return mw.shapes.parametric(formula, SPANS)


tubes = st.builds(
    lambda *values: Tube(*values).surface(),
    st.floats(20.0, 60.0), st.floats(20.0, 60.0), st.sampled_from([0.0, 0.05, 0.15]), st.integers(1, 4),
    st.sampled_from([0.0, 0.15, 0.35]), st.floats(0.5, 2.0), st.sampled_from([0.0, 0.25, -0.3]), st.floats(0.0, 40.0),
    st.floats(0.0, 20.0), st.tuples(*3 * [st.floats(-2.0, 2.0)]),
)  # fmt: skip
parts = st.one_of(
    tubes,
    st.builds(lambda a, b, slim: mw.shapes.ellipsoid(a, b, slim, 0.5, 2.4, SPANS), *3 * [st.floats(20.0, 120.0)]),
    st.builds(lambda start, end: mw.shapes.ellipsoid(60.0, 60.0, 60.0, start, end, SPANS), st.floats(0.05, 1.0),
              st.floats(1.6, 3.0)),
    st.builds(lambda bend: mw.shapes.elbow(120.0, 30.0, bend, SPANS), st.floats(0.2, 2.5)),
    st.builds(lambda one, other: mw.shapes.cone(one, other, 200.0, SPANS), *2 * [st.floats(5.0, 90.0)]),
    st.builds(lambda waist, slope: mw.shapes.hyperboloid(waist, slope, 80.0, SPANS), st.floats(5.0, 50.0),
              st.floats(0.1, 1.5)),
)  # fmt: skip


@st.composite
def machines(draw: st.DrawFn) -> Machine:
    """A machine that is shipped, with clearance, shaft and size of the eye of any kind."""
    return replace(
        read_machine(draw(st.sampled_from(machine_names()))),
        clearance=draw(st.sampled_from([None, 2.0, 15.0, 80.0])),
        shaft=draw(st.sampled_from([0.0, 0.0, 4.0, 30.0])),
        eye=draw(st.sampled_from([Eye(), Eye(), Eye(1.5), Eye(box=(20.0, 12.0, 8.0))])),
    )


@st.composite
def works(draw: st.DrawFn) -> Work:
    """Circuits on a part, in either sense, of any angle; wavy as only friction holds them, or straight."""
    part, sense = draw(parts), draw(st.sampled_from([1, -1]))
    turns, dwell = draw(st.floats(0.02, 3.0)), draw(st.floats(0.0, 0.8))
    wound = work(part, 2, sense * turns, sense * dwell, 61)
    wave = draw(st.sampled_from([0.0, 0.0, 0.05, 0.15]))
    if not wave:
        return wound
    courses, u = [], draw(st.floats(0.0, 1.0))
    for passed in range(4):
        rims = [(u, float(passed % 2)), (u + sense * turns, float(1 - passed % 2))]
        straight = np.linspace(rims[0], rims[1], 61)
        straight[:, 0] += sense * wave * np.sin(2.0 * pi * straight[:, 1])
        pass_ = replace(along(part, rims[0], rims[1], 61, Kind.LAID), points=part.points(straight),
                        normal=part.normals(straight))  # fmt: skip
        courses.append(numbered(pass_, passed // 2, passed))
        u += sense * turns
    course = joined(courses)
    return replace(wound, filaments=(Filament(course, np.zeros(len(course), dtype=np.int64), np.zeros(len(course))),))


def closed(on: Grid) -> tuple[Floats, Ints]:
    """Vertices and triangles of a part on a grid, closed over its rims, all facing outwards."""
    nu, nv = on.shape
    rings = np.arange(nu)[:, None] * nv + [0, nv - 1]
    first, last = (np.stack([ring, np.roll(ring, -1), np.full(nu, nu * nv + k)], axis=1)
                   for k, ring in enumerate(rings.T))  # fmt: skip
    faces = np.concatenate([on.quads[:, [0, 1, 2]], on.quads[:, [0, 2, 3]], first[:, ::-1], last])
    return np.concatenate([on.points, [on.points[ring].mean(axis=0) for ring in rings.T]]), faces.astype(np.int64)


def outside(made: Program) -> None:
    """The eye is outside of the part, closed over its rims, by its winding number; and keeps the clearance."""
    on = grid(made.work.surface)
    points, faces = closed(on)
    normal = np.cross(on.frames[:, SU], on.frames[:, SV])
    under = on.points - 1e-3 * made.work.diagonal * normal / np.linalg.norm(normal, axis=1)[:, None]
    assert np.median(igl.fast_winding_number(points, faces, under)) > 0.5  # so that the next line can fail
    hollows = any(words.startswith("shorter spans") and words.endswith("; taken") for words in made.remedies)
    # where the eye runs out along a bridge it grazes the part
    walls = np.concatenate([under, points[len(under) :]]) if hollows else points
    assert igl.fast_winding_number(walls, faces, made.blocks.eye).max() < 0.5
    if made.machine.axis("cross") is not None:
        least = made.nearest if hollows else made.clearance
        assert cKDTree(points).query(made.blocks.eye)[0].min() >= least * (1.0 - 1e-6)
        assert made.nearest >= 0.0 or not hollows


def holds(made: Program) -> None:
    """What holds of every program: finite blocks, no slack, axes of the eye, short steps, and time within limits."""
    b, size = made.blocks, made.work.diagonal
    for value in vars(b).values():
        assert len(value) == len(b)
        assert np.isfinite(value).all()
    assert b.free_length.min() > 0.0
    assert np.diff(b.arc_length + b.free_length).min() >= -1e-9 * size
    assert np.diff(b.arc_length).min() >= 0.0
    outside(made)
    on_fibre(made)
    short(b, size)
    in_time(made)


def on_fibre(made: Program) -> None:
    """The axes are those of the eye on the fibre's tangent, and the mandrel turns on as the fibre goes round."""
    m, b, size = made.mandrel, made.blocks, made.work.diagonal
    phi = -np.radians(b.mandrel)
    out = np.cos(phi)[:, None] * m.zero + np.sin(phi)[:, None] * m.third
    assert np.abs(m.origin + b.eye_x[:, None] * m.direction + b.eye_r[:, None] * out - b.eye).max() <= 1e-8 * size
    e_t = np.cross(m.direction, out)
    ahead = np.stack([b.tangent @ m.direction, (b.tangent * e_t).sum(axis=1)], axis=1)
    roll = np.stack([np.sin(np.radians(b.roll)), np.cos(np.radians(b.roll))], axis=1)
    assert np.abs(ahead[:, 0] * roll[:, 1] - ahead[:, 1] * roll[:, 0]).max() <= 1e-9
    along = m.inside(made.work.filaments[0].course.points)
    point, tangent = m.inside(b.point), m.turned(b.tangent)
    round_ = point[:, 1] * tangent[:, 2] - point[:, 2] * tangent[:, 1]
    if (round_ < 0.0).all():  # a fibre that goes round the axis all the way, so that the eye does so with it
        turned = np.ptp(np.unwrap(np.arctan2(along[:, 2], along[:, 1]))[[0, -1]]) / (2.0 * pi)
        assert turned - 0.5 <= (b.mandrel[-1] - b.mandrel[0]) / 360.0 <= turned + 0.5


def short(b: Blocks, size: float) -> None:
    """Steps are short."""
    # on the axis the mandrel's angle has no limit, and the roll none of a fibre that leads straight from it
    away = (b.eye_r > 0.05 * size) & (np.abs(b.yaw) < 85.0)
    for values, most in ((b.mandrel, 5.0), (b.roll, 10.0), (b.eye_x, 10.0), (b.eye_r, 10.0)):
        step = np.abs(np.diff(values))[away[1:] & away[:-1]]
        assert step.max(initial=0.0) <= most * (1 + 1e-9)


def in_time(made: Program) -> None:
    """No axis is faster than it can be, nor changes its speed faster."""
    b, machine = made.blocks, made.machine
    assert np.diff(b.time).min() >= 0.0
    limits, step = limits_of(machine), np.diff(b.time)
    going = step > 0.0
    moves = np.stack([np.diff(b.arc_length + b.free_length)]
                     + [np.diff(moved(b, axis.moves, 1.0)) for axis in machine.axes], axis=1)  # fmt: skip
    assert (np.abs(moves[~going]) <= 1e-12 * made.work.diagonal).all()
    speed = np.concatenate([np.zeros((1, moves.shape[1])), moves[going] / step[going][:, None]])
    assert (np.abs(speed) <= limits.speed * (1 + 1e-9)).all()
    change = np.abs(np.diff(speed, axis=0)) / (0.5 * (step[going] + np.append(0.0, step[going][:-1])))[:, None]
    assert (change <= limits.acceleration * 1.002).all()
    assert abs(made.seconds - sum(made.seconds_of_layers)) <= 1e-9 * made.seconds
    assert abs(made.seconds - sum(made.limits.values())) <= 1e-9 * made.seconds
