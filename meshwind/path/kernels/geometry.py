"""Vectors in space, as tuples of three numbers, and in the tangent plane of a surface, as rates of (u, v).

Tuples live in registers: a row of an array costs a reference count, which in loops over particles is seen.
"""

from typing import TypeAlias

from meshwind.core.kernel import njit
from meshwind.core.vectors import TINY

Vector: TypeAlias = tuple[float, float, float]


@njit(forceinline=True, cache=True)
def row(array, i):
    """Row i of an array (n, 3) as a vector."""
    return array[i, 0], array[i, 1], array[i, 2]


@njit(forceinline=True, cache=True)
def derivative(frames, i, which):
    """Derivative `which` (SU, SV, SUU...) of the surface at particle i, from frames (n, 6, 3)."""
    return frames[i, which, 0], frames[i, which, 1], frames[i, which, 2]


@njit(forceinline=True, cache=True)
def put(a, array, i):
    """Write a vector into row i of an array (n, 3)."""
    array[i, 0], array[i, 1], array[i, 2] = a


@njit(forceinline=True, cache=True)
def dot(a, b):
    """Scalar product of two vectors."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@njit(forceinline=True, cache=True)
def cross(a, b):
    """Vector product a x b."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@njit(forceinline=True, cache=True)
def plus(a, b):
    """Sum a + b."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


@njit(forceinline=True, cache=True)
def minus(a, b):
    """Difference a - b."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@njit(forceinline=True, cache=True)
def times(x, a):
    """The vector a times the number x."""
    return x * a[0], x * a[1], x * a[2]


@njit(forceinline=True, cache=True)
def over(a, x):
    """The vector a over the number x."""
    return a[0] / x, a[1] / x, a[2] / x


@njit(forceinline=True, cache=True)
def combine(x, a, y, b):
    """The combination x a + y b of two vectors."""
    return x * a[0] + y * b[0], x * a[1] + y * b[1], x * a[2] + y * b[2]


@njit(cache=True)
def to_parameters(su, sv, w):
    """Rates of (u, v) whose velocity on the surface is the tangent vector w."""
    e, f, g = dot(su, su), dot(su, sv), dot(sv, sv)
    a, b = dot(su, w), dot(sv, w)
    det = max(e * g - f * f, TINY)
    return (g * a - f * b) / det, (e * b - f * a) / det


@njit(forceinline=True, cache=True)
def second_form(form, a, b):
    """The second fundamental form, given as its coefficients (uu, uv, vv), of two rates of (u, v)."""
    return form[0] * a[0] * b[0] + form[1] * (a[0] * b[1] + a[1] * b[0]) + form[2] * a[1] * b[1]
