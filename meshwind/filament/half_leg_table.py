"""Compiled: half-legs by touch point and slip, from a table of periodic splines."""

from math import floor

from meshwind.core.kernel import njit


@njit(cache=True)
def piece_of(splines, u):
    """Number of the piece of periodic splines (4, m, ...) over even knots that u is on, and how far it is along it."""
    many, rest = splines.shape[1], u - floor(u)
    k = min(int(rest * many), many - 1)
    return k, rest - k / many


@njit(nogil=True, cache=True)
def look_up(splines, reach, u, slip, found, by_u, by_slip):
    """Write where half-legs lead (n, 2) from touch points u (n,) with slips (n,), and its derivatives by both.

    splines (4, m, 3, 2): what leads on in u and the angle, without slip and with its first and second power over reach.
    """
    for i in range(len(u)):
        k, h = piece_of(splines, u[i])
        x = slip[i] / reach
        for c in range(2):
            value = rate = steer = 0.0
            for power in range(3):
                a, b, d, e = (
                    splines[0, k, power, c],
                    splines[1, k, power, c],
                    splines[2, k, power, c],
                    splines[3, k, power, c],
                )
                one = ((a * h + b) * h + d) * h + e
                value += one * x**power
                rate += ((3.0 * a * h + 2.0 * b) * h + d) * x**power
                if power:
                    steer += power * one * x ** (power - 1)
            found[i, c], by_u[i, c], by_slip[i, c] = value, rate, steer / reach
        found[i, 0] += u[i]
        by_u[i, 0] += 1.0


@njit(nogil=True, cache=True)
def follow(splines, start, leads, orbit):
    """Write the circuits (n, m) that lead from start (m,) on by a periodic spline (4, k): how far, and from where."""
    at = start.copy()
    for circuit in range(len(leads)):
        for i in range(len(at)):
            k, h = piece_of(splines, at[i])
            orbit[circuit, i] = at[i]
            leads[circuit, i] = ((splines[0, k] * h + splines[1, k]) * h + splines[2, k]) * h + splines[3, k]
            at[i] += leads[circuit, i]
