"""The course of a fibre in the order in which it is wound: over the part, in the air, and through the turnarounds."""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import NamedTuple

import numpy as np

from meshwind.core.brief import brief
from meshwind.core.cast import Floats, Ints, frozen
from meshwind.core.threads import parallel_for
from meshwind.filament.kinds import Kind as Kind
from meshwind.filament.runs import Columns, Order, Runs, copy_runs

_BLOCK = 50
"""Stretches at least that a thread copies."""


@dataclass(frozen=True)
class Course:
    """A stretch of fibre of n points in order of winding; two stretches in a row share the point where they meet.

    Attributes
    ----------
    points : ndarray of float, shape (n, 3)
        Points of the fibre, in the surface's units.
    normal : ndarray of float, shape (n, 3)
        Outward unit normals of what the fibre lies on or, in the air, of its foot there.
    angle : ndarray of float, shape (n,)
        Winding angle in radians, from the direction along the part: 0 along it, pi/2 for a hoop.
    slip : ndarray of float, shape (n,)
        Friction that it needs, |kg|/kn; NaN in the air.
    kind : ndarray of int, shape (n,)
        What each point does, as `Kind`.
    circuit, passed, path : ndarray of int, shape (n,)
        The circuit and the pass, counted from 0 in the order of winding, and the path, -1 where it is none.
    """

    points: Floats
    normal: Floats
    angle: Floats
    slip: Floats
    kind: Ints
    circuit: Ints
    passed: Ints
    path: Ints

    __repr__ = brief

    def __len__(self) -> int:
        return len(self.points)

    def chosen(self, which: slice | Ints) -> "Course":
        """Some of the points, in this order."""
        return Course(*(frozen(getattr(self, each.name)[which]) for each in fields(Course)))

    @property
    def arc_length(self) -> Floats:
        """Length (n,) of the polyline up to each point."""
        steps = np.linalg.norm(np.diff(self.points, axis=0), axis=1)
        return frozen(np.concatenate([[0.0], np.cumsum(steps)]))


def joined(courses: Sequence[Course]) -> Course:
    """One course from several in a row, each of which starts where the one before ends.

    The first point of each but the first is left out, as the one before it has it already.
    """
    return in_a_row([each.chosen(slice(min(k, 1), None)) for k, each in enumerate(courses)])


def in_a_row(courses: Sequence[Course]) -> Course:
    """One course from several, from each of which the fibre goes straight to the next."""
    return Course(*(frozen(np.concatenate([getattr(one, each.name) for one in courses])) for each in fields(Course)))


@dataclass(frozen=True)
class Courses:
    """Courses of many fibres in one: number k has count[k] points (n,), and comes after those before it."""

    course: Course
    count: Ints

    @property
    def first(self) -> Ints:
        """Which point of `course` is the first of each (n,)."""
        return np.asarray(np.cumsum(self.count) - self.count)

    @property
    def backwards(self) -> "Courses":
        """Each fibre from its last point to its first."""
        return Courses(self.course.chosen(runs(self.first + self.count - 1, self.count, -1)), self.count)

    def between(self, first: Floats, last: Floats) -> "Courses":
        """The same with other points (n, 3) at both ends of each."""
        points = self.course.points.copy()
        points[self.first], points[self.first + self.count - 1] = first, last
        return Courses(replace(self.course, points=points), self.count)


class Stretches(NamedTuple):
    """Some of the courses of many fibres, `rows` (n,), each from its first point to its last or backwards.

    back: 1 if they belong to the passes back, 0 to those there.
    """

    courses: Courses
    rows: Ints
    backwards: bool = False
    back: int = 0


def in_line(stretches: Sequence[Stretches], circuit: int) -> Course:
    """One course through the first of all stretches, which are a circuit of this number, then the second ones, and on.

    Each starts where the one before ends, so that its first point is left out.
    """
    step = np.array([-1 if each.backwards else 1 for each in stretches])
    count = np.stack([each.courses.count[each.rows] for each in stretches], axis=1)
    first = np.stack([each.courses.first[each.rows] for each in stretches], axis=1)
    first = np.where(step < 0, first + count - 1, first) + step
    count -= 1
    first[0, 0] -= step[0]
    count[0, 0] += 1
    at = (np.cumsum(count) - count.ravel()).reshape(count.shape)
    many = int(count.sum())
    made = Columns(
        np.empty((many, 3)), np.empty((many, 3)), np.empty(many), np.empty(many), np.empty(many, dtype=np.int64),
        np.empty(many, dtype=np.int64),
    )  # fmt: skip
    order = Order(np.empty(many, dtype=np.int64), np.empty(many, dtype=np.int64))
    for k, each in enumerate(stretches):
        one = each.courses.course
        source = Columns(*(frozen(getattr(one, name)) for name in Columns._fields))
        begin, length, to = (frozen(of[:, k]) for of in (first, count, at))
        runs_ = Runs(begin, length, to, int(step[k]), circuit, each.back)
        parallel_for(copy_runs, len(count), _BLOCK, source, runs_, made, order)
    points, normal, angle, slip, kind, path = (frozen(each) for each in made)
    return Course(points, normal, angle, slip, kind, frozen(order.circuit), frozen(order.passed), path)


def in_turn(parts: Sequence[Courses], *, share: bool) -> Courses:
    """From n courses of each part one from the first to the last part.

    share: whether each starts where that of the part before ends, so that its first point is left out.
    """
    base = np.cumsum([0, *(len(part.course) for part in parts[:-1])])
    first = np.stack([part.first for part in parts], axis=1) + base
    count = np.stack([part.count for part in parts], axis=1)
    if share:
        first[:, 1:] += 1
        count[:, 1:] -= 1
    whole = in_a_row([part.course for part in parts])
    return Courses(whole.chosen(runs(first.ravel(), count.ravel())), count.sum(axis=1))


def runs(first: Ints, count: Ints, step: Ints | int = 1) -> Ints:
    """Runs of integers, one after the other: count[k] of them from first[k] on, step[k] or one step for all apart."""
    within = np.arange(int(count.sum())) - np.repeat(np.cumsum(count) - count, count)
    return np.asarray(np.repeat(first, count) + np.repeat(np.broadcast_to(step, count.shape), count) * within)
