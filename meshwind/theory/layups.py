"""Chapter 6: revolutions, what is measured on a winding, and automatic surface editing.

Revolutions (section 6.1)
-------------------------
A path from x_1 = (u_1, v_1) on one rim to x_end = (u_end, v_end) on the other turns ::

    n_rev = (u_end - u_1) / T_u                                                                                   (6.1)

times around the part; in meshwind u is in turns, T_u = 1.  It starts as a straight line in the parametric plane::

    v = v_1 + (v_end - v_1) / (T_u n_rev) (u - u_1)                                                               (6.2)

which `meshwind.solve` writes as x = (1 - c) x_1 + c x_end, c from 0 to 1, so that n_rev = 0 is no exception.  The line
has the direction (1, z) with z = (v_end - v_1) / (T_u n_rev), and presses on the surface where its normal curvature is
positive::

    (s_uu + 2 z s_uv + z^2 s_vv) . (s_u x s_v) < 0                                                      (6.3) corrected

With v from 0 to 1 and divided by z^2, this is quadratic in n_rev::

    -(n_rev^2 s_uu + 2 n_rev s_uv + s_vv) . n > 0

so that it holds on no, one or two intervals of n_rev >= 0.  The source takes n_rev from the interval that most points
of the surface share.  Departures in meshwind: both families must press, +n_rev and -n_rev, so that the middle term
becomes ``-2 n_rev |s_uv . n|``; points count by the area that they stand for; and a number is used only if paths wound
by it do not slide off a rim.  These are the *feasible revolutions*.  On a surface of revolution with the radius r and
the winding angle alpha Clairaut's relation r sin(alpha) = constant bounds them, even where (6.3) holds.

What is measured (section 6.2)
------------------------------
Figure 1.3 shows at points of a surface in which tangent directions a fibre presses: all of them where it is convex,
none where it is concave, a sector where it is a saddle.  With the principal curvatures k1 >= k2, positive where the
surface bulges outwards, and the angle phi to the first principal direction, kn = k1 cos(phi)^2 + k2 sin(phi)^2, and the
sector is ``|phi| <= arctan(sqrt(k1 / -k2))``.  `meshwind.windability` gives it.

Figure 6.3: two paths of different families cross at the angle theta; the *quality* of the crossing is ``|cos(theta)|``,
0 where they are square to each other and 1 where they are parallel.  The distance between neighbouring paths of a
family is measured along the paths of the other family, from crossing to crossing; meshwind measures it straight as
well.  Its relation to the width of the band gives the coverage.

Non-uniform paths (section 6.3)
-------------------------------
Between neighbours of a family that lie further apart than a largest distance, new paths are added evenly; the source
adds ceiling(distance / largest distance) of them.  Crossings joined along the paths make a quad mesh.

Automatic surface editing (section 6.4)
---------------------------------------
The surface depends on its control points, stacked in C; the change of C is dC::

    s(x; C)                                                                                               (6.4) context

A lifted particle P_i hangs above its foot or shadow at x_i, and the surface has reached it when it has risen so far
along the normal::

    (P_i - s(x_i; C)) . n > 0                                                                             (6.5) context
    (s(x_i; C + dC) - s(x_i; C)) . n >= (P_i - s(x_i; C)) . n                                             (6.6) context

To first order the surface moves by its Jacobian by the control points::

    J_C(x) = ds(x; C)/dC,  a matrix of 3 x 3m                                                                     (6.7)
    s(x; C + dC) - s(x; C) = J_C(x) dC                                                                    (6.8) context
    n^T J_C(x_i) dC >= (P_i - s(x_i; C)) . n                                                                      (6.9)

For a B-spline (6.8) is exact, as the surface is linear in its control points.  One row (6.9) for each lifted particle
gives the matrix M and the vector B::

    rows n^T J_C(x_i) of M and (P_i - s(x_i; C)) . n of B, for all lifted particles                              (6.10)
    M dC >= B                                                                                                    (6.11)

and the edit is the least change that satisfies them, a convex quadratic program::

    minimise dC^T dC  subject to  M dC >= B                                                                      (6.12)

As the paths move on the edited surface, the part is wound and edited again until no path bridges.

Departures in meshwind, all argued in `meshwind.editing`: rows take the direction across the chord nearest to the
normal, in place of the normal; they are elastic, as neighbouring rows all but repeat each other; the objective has a
term that keeps the change smooth; particles that touch ask for a least normal curvature along the fibre, which makes
the rounds converge quickly; and control points may be frozen, bounded or tied by a symmetry.
"""
