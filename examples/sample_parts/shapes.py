"""The smooth maps behind the sample parts: (u, v) in [0, 1)^2, u around and periodic, to millimetres.

Each map takes u and v of shape (n,) and gives points (n, 3); growing u and v, in this order, point outward.
All are smooth, so that a spline can follow them; the closed ones run from pole to pole.
"""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def bump(x: Floats, centre: float, width: float) -> Floats:
    """Return a bell of height 1 and the given half-width."""
    return np.exp(-(((x - centre) / width) ** 2))


def rise(x: Floats, centre: float, width: float) -> Floats:
    """Return a smooth step from 0 to 1 about `centre`."""
    return 0.5 + 0.5 * np.tanh((x - centre) / width)


def vase(u: Floats, v: Floats) -> Floats:
    """Return an oval, leaning vase 200 mm high, open at both ends, its waist well inside its rims."""
    turn = 2 * np.pi * u
    radius = 40 + 13 * bump(v, 0.28, 0.22) - 13 * bump(v, 0.7, 0.18) + 8 * bump(v, 1.04, 0.18)
    radius *= 1 + 0.07 * np.cos(2 * turn - 0.6 - 0.8 * v) + 0.02 * np.cos(3 * turn + 1.1 * v)
    centre_x = 14 * v**2
    centre_y = 3 * np.sin(np.pi * v)
    return np.column_stack([centre_x + radius * np.cos(turn), centre_y + radius * np.sin(turn), 200 * v])


def elbow(u: Floats, v: Floats) -> Floats:
    """Return a quarter of a torus, a pipe of radius 30 mm bent to 90 mm, from z=0 to x=0, open."""
    turn, bend = 2 * np.pi * u, 0.5 * np.pi * v
    reach = 90 + 30 * np.cos(turn)
    return np.column_stack([reach * np.cos(bend), 30 * np.sin(turn), reach * np.sin(bend)])


def tank(u: Floats, v: Floats) -> Floats:
    """Return the domed tank (x^2 + y^2) / 60^2 + (z / 120)^6 = 1: convex, analytic, closed."""
    turn, height = 2 * np.pi * u, -np.cos(np.pi * v)
    # 1 - h^6 in factors, which keeps its digits at the poles
    radius = 60 * np.sin(np.pi * v) * np.sqrt(1 + height**2 + height**4)
    return np.column_stack([radius * np.cos(turn), radius * np.sin(turn), 120 * height])


def bottle(u: Floats, v: Floats) -> Floats:
    """Return a closed bottle 220 mm high, its axis bent, with three unequal lobes twisting below its neck."""
    turn, height = 2 * np.pi * u, -np.cos(np.pi * v)
    # domed at both ends, so that fibres hold there: 1 - h^4 in factors, which keeps its digits at the poles
    closing = np.sin(np.pi * v) * np.sqrt(1 + height**2)
    radius = closing * (22 + 26 * (1 - rise(height, 0.34, 0.2)) + 4 * bump(height, -0.55, 0.35))
    twisted = turn + 0.55 * (height + 1)
    lobes = 0.12 * np.cos(3 * twisted) + 0.04 * np.cos(2 * twisted + 0.7) + 0.03 * np.cos(twisted - 0.4)
    # the square of the sine keeps the lobes smooth where they fade into the poles
    radius *= 1 + lobes * np.sin(np.pi * v) ** 2 * 1.15 * (1 - rise(height, 0.5, 0.25)) * (1 + 0.25 * height)
    centre_x = 4 * np.sin(1.3 * height + 0.4)
    centre_y = 3 * np.cos(1.9 * height - 0.3)
    return np.column_stack([centre_x + radius * np.cos(turn), centre_y + radius * np.sin(turn), 110 * (height + 1)])


def cast(u: Floats, v: Floats) -> Floats:
    """Return a cast of the lower leg, bent 82 degrees at the ankle, open at knee and toes."""
    turn, t = 2 * np.pi * u, -225 + 335 * v
    up, ahead = np.array([0.0, 0.0, 1.0]), np.array([np.cos(0.14), 0.0, -np.sin(0.14)])
    # a hyperbola-like centreline: leg and foot are its asymptotes, 40 mm the size of its bend
    leg, foot = 40 * np.logaddexp(0, -t / 40), 40 * np.logaddexp(0, t / 40)
    share = rise(t, 0.0, 80.0)
    tangent = np.outer(share, ahead) - np.outer(1 - share, up)
    tangent /= np.linalg.norm(tangent, axis=1)[:, None]
    side = np.array([0.0, -1.0, 0.0])
    front = np.cross(side, tangent)
    calf = 1 - rise(t, -95, 45)
    depth = 36 + 14 * calf + 4 * bump(t, -165, 50) - 7 * rise(t, 50, 35)
    width = 34 + 15 * calf + 3 * bump(t, -160, 50) + 9 * rise(t, 65, 35)
    across, along = np.cos(turn), np.sin(turn)
    # the mixed term squares the ellipse off, as a sole and a shin do
    square = 0.45 * (across * along) ** 2 / (depth * width)
    radius = 1 / np.sqrt((across / depth) ** 2 + (along / width) ** 2 - square)
    radius += 15 * np.exp(3 * (-across - 1)) * bump(t, -4, 30)
    radius += 4 * np.exp(5 * (along - 1)) * bump(t, -36, 20) + 4 * np.exp(5 * (-along - 1)) * bump(t, -26, 20)
    radius += 5 * np.exp(1.5 * (np.cos(turn - 2.6) - 1)) * bump(t, -150, 50)
    centre = np.outer(leg, up) + np.outer(foot, ahead) + np.outer(5 * bump(t, 100, 60), side)
    return np.asarray(centre + (radius * across)[:, None] * front + (radius * along)[:, None] * side)


def wing(u: Floats, v: Floats) -> Floats:
    """Return a closed, swept, tapered wing panel of 400 mm span, its trailing edge and tips rounded."""
    turn, station = 2 * np.pi * u, -np.cos(np.pi * v)
    chord = 75 - 15 * station
    x = 0.5 + 0.5 * np.cos(turn)
    nose = np.sqrt(-np.expm1(-7 * x))
    tail = np.sqrt(-np.expm1(-1.25 * chord * (1 - x)))
    thickness = (1.5 + (0.075 * chord - 1.5) * (1 - x**2)) * nose * tail
    to_tip = 200 * (1 - np.abs(station))
    # every section fades into an ellipse at the tips, or the surface would have no curvature there
    airfoil = -np.expm1(-to_tip / 8)
    side = airfoil * thickness * np.sign(np.sin(turn)) + (1 - airfoil) * 0.06 * chord * np.sin(turn)
    fullness = -np.expm1(-to_tip / 20)
    height = 0.048 * chord * x * (1 - x) * fullness - side * np.sqrt(-np.expm1(-to_tip / 7))
    reach = (x - 0.4) * chord * np.sqrt(fullness)
    washout = 0.03 * (1 + station)
    aft = 32 * station + reach * np.cos(washout) - height * np.sin(washout)
    upward = 10 * station + reach * np.sin(washout) + height * np.cos(washout)
    return np.column_stack([aft, 200 * station, upward])
