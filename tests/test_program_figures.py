"""Programs against the figures of a commercial one for a vessel, and against closed forms of that vessel.

The vessel is a cylinder of radius 152.74 from x = -250 to 250 with elliptic caps 98.4436 long; the eye is 172 from the
axis beside the cylinder.  What is entered are points, tangents and moves that its program tells: single figures.
"""

import re
from dataclasses import replace
from math import asin, atan, degrees, pi

import numpy as np
import pytest
from program_blocks import blocks_of
from program_parts import chord, numbered, pieces

import meshwind as mw
from meshwind.core.cast import Floats
from meshwind.filament.course import Kind, joined
from meshwind.program.body import to_radius
from meshwind.program.eye import axes
from meshwind.program.machine import read_machine
from meshwind.program.posts.dialect import fitted
from meshwind.program.posts.dialects import DIALECTS
from meshwind.program.posts.header import Job
from meshwind.program.posts.writer import program_text
from meshwind.program.program import program
from meshwind.program.readback.compare import read_text
from meshwind.program.timing import Limits, timed
from meshwind.program.work import Work

RADIUS, EYE, HALF, CAP = 152.74, 172.0, 250.0, 98.4436
CIRCUITS, ADVANCE, POLE = 233, 427.98283, 37.21
JOINING = np.array([
    # P, T, E, free span, length laid
    [248.0, 0.0, 152.7400055, 0.0, 1.0, 0.0, 248.0, 79.085, 152.74, 79.085, 0.0],
    [245.9086025, 47.19925742, 145.2643775, -0.0724997, 0.9633839, -0.2581379, 240.71, 116.26, 126.76, 71.686,
     48.02182],
    [194.9196046, 152.7400055, 0.0, -0.3979753, 0.04801280, -0.9161389, 163.9, 156.48, -71.397, 77.934, 247.467],
    [171.0311397, 145.2643775, -47.19925742, -0.4687053, -0.2286290, -0.8532550, 133.1, 126.76, -116.26, 80.936,
     301.0616],
    [-166.6667023, -132.0015448, -76.79374298, -0.8170595, -0.3140135, 0.4835383, -268.7, -171.22, -16.41, 124.88,
     792.6291],
    [-215.1640620, -145.2643775, -47.19925742, -0.8354947, -0.1969227, 0.5130011, -323.87, -170.89, 19.547, 130.11,
     850.9988],
    [-262.8494873, -150.2180037, -18.26451038, -0.8606389, 0.05275713, 0.5064755, -351.94, -144.76, 34.163, 103.52,
     907.1196],
    [-275.4790955, -146.9601498, -10.97847281, -0.8345294, 0.2769407, 0.4763029, -355.17, -120.52, 34.502, 95.489,
     922.0898],
    [-340.4224671, -52.18460843, 30.12879772, -0.2272540, 0.9533124, 0.1988747, -363.29, 43.735, 50.139, 100.62,
     1048.941],
    [-345.3874027, -7.806606849, 36.72719763, -0.02316544, 0.9939923, 0.1069702, -349.27, 158.9, 54.668, 167.71,
     1094.163],
    [-345.3961129, 0.0, 37.48974419, 0.006275307, 0.9955588, 0.09393289, -344.36, 163.65, 52.931, 164.38, 1102.007],
])  # fmt: skip
"""Eleven of the 25 places of its joining pass, from the cylinder's end to the other pole."""
MOVES = {
    # from place to place: F, and the moves of A, X, Y and B
    (0, 1): (5760.6, 15.15, -7.29, 0.0, 4.69),
    (2, 3): (9999.5, 18.0, -30.80, 0.0, 4.82),
    (4, 5): (23536.8, 12.0, -55.17, 0.0, 1.79),
    (5, 6): (27462.6, 6.75, -28.07, -23.26, 0.0),
    (6, 7): (36760.5, 2.70, -3.23, -23.38, -2.37),
    (8, 9): (18019.3, 29.92, 14.02, 101.51, -15.19),
    (9, 10): (46892.0, 1.06, 4.91, 3.96, -7.61),
}
"""Its blocks between those that follow one another."""
FILTERED = (5, 6), (6, 7)
"""The roll's move of 0.15 degrees is left out of the first of these and made in the second."""
CIRCUIT = np.array([
    [1.90, 31.70], [1.56, 25.62], [1.47, 22.86], [1.49, 20.30], [2.66, 35.60], [51.45, 558.23], [0.01, 0.0],
    [1.09, 0.90], [0.72, 0.72], [0.39, 0.53], [2.69, 3.28], [4.64, 4.06], [8.35, 3.48], [20.71, 3.53], [60.97, 0.94],
    [42.17, -7.18], [12.47, -26.07], [1.93, -32.15], [1.50, -23.99], [1.32, -18.60], [1.67, -22.42], [3.89, -44.66],
    [13.98, -163.90], [15.77, -169.34], [0.10, -1.10], [17.93, -188.09], [2.55, -18.22], [0.87, -0.80], [0.52, -0.61],
    [0.24, -0.40], [2.15, -3.35], [4.59, -3.68], [9.55, -3.84], [29.97, -4.01], [65.97, 0.83], [34.38, 11.21],
    [4.36, 8.62],
])  # fmt: skip
"""Moves of A and X in its helical circuit, at 1000 units a minute along both together."""
HOOP = np.array([[360.0, 0.0], [2.44, 0.49], [44611.82, 495.68], [2.16, -0.17], [360.0, 0.0]])
"""Those of its first hoop layer."""
FANUC = replace(read_machine("lathe-4"), feed="G94", dialect="fanuc")


def apart(one: Floats | float, other: Floats | float) -> Floats:
    """Angles apart, half turns being the same."""
    return np.asarray(one - other - 180.0 * np.round((one - other) / 180.0))


def test_the_eye_is_where_that_of_the_commercial_program_is() -> None:
    point, tangent, eye = JOINING[:, :3], JOINING[:, 3:6], JOINING[:, 6:9]
    span, laid = JOINING[:, 9:].T
    assert np.abs(point + span[:, None] * tangent - eye).max() <= 0.005
    # beside the cylinder the closed form gives the span, which is told to five figures
    on_cylinder = np.abs(point[:, 0]) <= HALF
    assert on_cylinder.sum() == 6
    found = to_radius(point, tangent, EYE)
    assert np.abs(found - span)[on_cylinder].max() <= 0.005
    assert np.abs(point + found[:, None] * tangent - eye)[on_cylinder].max() <= 0.006
    assert np.diff(laid + span).min() > 0.0
    # what the axes do from place to place, for its own eye, which it tells to five figures
    x, r, mandrel, roll, _ = axes(eye - span[:, None] * tangent, tangent, span)
    values = np.stack([np.degrees(mandrel), x, r, np.degrees(roll)])
    for (one, other), (_, *moves) in MOVES.items():
        a, along, out, b = values[:, other] - values[:, one] - moves
        assert abs(a - 360.0 * round(a / 360.0)) <= 0.0053
        assert abs(along) <= 0.005
        assert abs(out) <= 0.008
        assert abs(apart(b, 0.0)) <= (0.16 if (one, other) in FILTERED else 0.01)
    first, last = FILTERED[0][0], FILTERED[1][1]
    assert abs(apart(values[3, last] - values[3, first], MOVES[5, 6][4] + MOVES[6, 7][4])) <= 0.01


def test_feeds_and_times_are_those_of_the_commercial_program() -> None:
    feeds, moves = np.split(np.array(list(MOVES.values())), [1], axis=1)
    # there the mandrel turns at most 5000 degrees a minute, and the cross-feed goes at most 36 m a minute
    limits = Limits(("A", "X", "Y", "B"), np.array([5000.0 / 60.0, np.inf, 600.0, np.inf]), np.full(4, np.inf))
    seconds = timed(moves, limits).seconds
    start = np.array([10.0, 0.0, EYE, 0.0])
    columns = np.column_stack([np.concatenate([start[None], start + np.cumsum(moves, axis=0)]), np.zeros(8)])
    text = told(columns, seconds)
    told_feeds = np.array([float(each) for each in re.findall(r"G1.*F([\d.]+)", text)])
    assert told_feeds == pytest.approx(feeds[:, 0], rel=1e-5)
    for pairs, count, minutes in ((CIRCUIT, CIRCUITS, 401.47), (HOOP, 1, 45.34)):
        length = np.hypot(pairs[:, 0], pairs[:, 1])
        each = timed(length[:, None], Limits(("A and X",), np.array([1000.0 / 60.0]), np.array([np.inf]))).seconds
        zero = np.zeros((len(pairs) + 1, 3))
        zero[:, 0] = EYE
        at = np.column_stack([np.concatenate([[[0.0, 0.0]], np.cumsum(pairs, axis=0)]), zero])
        read = read_text(told(at, each), fitted(FANUC, DIALECTS["fanuc"]))
        assert not read.faults
        assert count * read.seconds.sum() / 60.0 == pytest.approx(minutes, abs=0.005)
    assert CIRCUIT.sum(axis=0) == pytest.approx([ADVANCE, 0.0], abs=0.005)
    assert pytest.approx(44 * 360.0 / CIRCUITS, abs=1e-5) == ADVANCE % 360.0


def told(columns: Floats, seconds: Floats) -> str:
    """Moves of mandrel, eye, roll and yaw in Fanuc's words, at a feed that is the speed of all axes together."""
    blocks = blocks_of(columns, np.concatenate([[0.0], np.cumsum(seconds)]), np.zeros(len(columns), dtype=np.int64))
    return program_text(blocks, FANUC, DIALECTS["fanuc"], Job("vessel"))


def geodesic_pass(count: int) -> tuple[Floats, Floats, Floats, float]:
    """A geodesic from pole to pole of the vessel: radius, height and turn (n,), and its length.

    On a cap r = R sin s, z = HALF + CAP cos s, and cos s = cos s0 sin w, from w = 0 at the cylinder to a quarter turn
    at the pole, where r = R sin s0 = POLE.  With the meridian's rate q = sqrt((R cos s)^2 + (CAP sin s)^2) Clairaut's
    relation is dphi/dw = POLE q/r^2 and dL/dw = q, both finite at the pole.
    """
    w = np.linspace(0.0, pi / 2.0, count)
    gauss, weights = np.polynomial.legendre.leggauss(5)
    inner = w[:-1, None] + 0.5 * (gauss + 1.0) * np.diff(w)[:, None]

    def rates(w: Floats) -> tuple[Floats, Floats, Floats, Floats]:
        s = np.arccos(np.cos(asin(POLE / RADIUS)) * np.sin(w))
        rate = np.hypot(RADIUS * np.cos(s), CAP * np.sin(s))
        r = RADIUS * np.sin(s)
        return r, HALF + CAP * np.cos(s), POLE * rate / r**2, rate

    turn, length = (0.5 * np.diff(w) * (rates(inner)[k] @ weights) for k in (2, 3))
    phi = np.concatenate([[0.0], np.cumsum(turn)])
    r, z, _, _ = rates(w)
    straight = np.linspace(-HALF, HALF, count)
    slope = POLE / np.sqrt(RADIUS**2 - POLE**2)
    over = (straight + HALF) * slope / RADIUS
    radius = np.concatenate([r[::-1], np.full(count - 2, RADIUS), r])
    height = np.concatenate([-z[::-1], straight[1:-1], z])
    turned = np.concatenate([phi[-1] - phi[::-1], phi[-1] + over[1:-1], phi[-1] + over[-1] + phi])
    return radius, height, turned, float(2.0 * length.sum() + 2.0 * HALF * np.sqrt(1.0 + slope**2))


def test_a_geodesic_circuit_of_the_vessel_comes_back_but_for_the_mandrel() -> None:
    r, z, phi, length = geodesic_pass(161)
    assert degrees(phi[-1]) == pytest.approx(212.98386, abs=1e-5)
    assert 2.0 * length == pytest.approx(1820.2285, abs=1e-4)
    courses = []
    for k in range(4):
        # where a pass ends the next one begins: the fibre touches the pole
        turn = np.concatenate([phi, phi[-1] + phi[1:]]) + 2.0 * k * phi[-1]
        out, along = np.concatenate([r, r[-2::-1]]), np.concatenate([z, z[-2::-1]])
        points = np.stack([out * np.cos(turn), out * np.sin(turn), along], axis=1)
        courses.append(numbered(chord(points, Kind.LAID, np.array([1.0, 0.0, 0.0])), k, 2 * k))
    top = HALF + CAP * np.sqrt(1.0 - (POLE / RADIUS) ** 2)
    surface = mw.shapes.revolution(
        lambda at: RADIUS * np.sqrt(1.0 - (np.maximum(np.abs(at) - HALF, 0.0) / CAP) ** 2), -top, top, (32, 96)
    )
    diagonal = float(np.hypot(2.0 * top, 2.0 * np.sqrt(2.0) * RADIUS))
    made = program(Work((pieces(joined(courses)),), surface, diagonal, "mm"), read_machine("lathe-5"))
    b = made.blocks
    second, third = (np.flatnonzero(b.circuit == k) for k in (1, 2))
    assert len(second) == len(third)
    for name in ("eye_x", "eye_r", "free_length", "yaw"):
        assert getattr(b, name)[third] == pytest.approx(getattr(b, name)[second], abs=1e-8)
    assert apart(b.roll[third], b.roll[second]) == pytest.approx(0.0, abs=1e-8)
    assert b.mandrel[third] - b.mandrel[second] == pytest.approx(425.96773, abs=1e-5)
    # what its own circuit turns more, to come to 44 of 233 turns
    assert ADVANCE - 2.0 * degrees(phi[-1]) == pytest.approx(2.0151, abs=1e-4)
    assert degrees(atan(2.0 * pi * RADIUS / 4.0)) == pytest.approx(89.7612, abs=1e-4)
