"""The equations behind the code, by number, in one notation.

Comments and docstrings in meshwind cite equations as (4.16), sections as "section 3.3", and so on.  The numbers are
those of the source of the method, a dissertation on physically based filament winding in the parametric plane.  These
pages state every equation that is cited, so that code can be checked against its formula without the source:

==================== ===============================================================================================
module               holds
==================== ===============================================================================================
`equilibrium`        chapter 3: balance of forces, friction, geodesics as an initial value problem
`geodesics`          chapter 4: particles on springs in the parametric plane, explicit and implicit steps, friction
`bridging`           chapter 5: lifting from the surface, springs across a bridge, foot points, landing
`layups`             chapter 6: revolutions, crossings, coverage, spacing, automatic surface editing
`comparisons`        chapter 7: penalty forces, the Karush-Kuhn-Tucker method, reuse of the matrix, freeform meshes
`errata`             what is wrong or ambiguous in the source, and what is used instead
==================== ===============================================================================================

How to read them: an equation's number stands at the end of its line.  After the number, "corrected" says that the
formula differs from the printed one, which `errata` quotes, and "context" says that no code cites the equation; it is
there because others follow from it.  `tests/test_theory.py` checks both marks against the code, and the formulas
against the functions that implement them.

Notation
--------
A dot between two vectors is the scalar product, x the vector product, ^T a transpose, ``|.|`` a Euclidean norm.  Angles
are in radians, lengths in the unit of the mesh.  Symbols that the source writes in other ways are given in brackets.

================== =====================================================================================================
symbol             meaning
================== =====================================================================================================
s(u, v)            the surface; u in turns with period 1 [T_u], v in [0, 1] from the start rim to the end rim
s_u ... s_vv       its partial derivatives
a_uu, a_uv, a_vv   first fundamental form: s_u . s_u, s_u . s_v, s_v . s_v
W                  area element: W^2 = a_uu a_vv - a_uv^2, ``W = |s_u x s_v|``
n                  outward unit normal, s_u x s_v / W [n_s]
r(l)               the fibre as a curve, by arc length l [t]; ' is its derivative by l
t, b               its unit tangent r', and b = n x t, which points to the fibre's left as seen from outside
kn, kg             normal curvature -r'' . n, positive where the fibre presses, and geodesic curvature r'' . b
T                  tension of the fibre, a force, the same all along it
N, f               what the surface exerts on the fibre per unit length: support N n and friction f, f . n = 0
mu                 coefficient of friction
P_i                position in space of particle i, from 1 to the last, `end`; P all of them, stacked
x_i = (u_i, v_i)   its parametric position [P with a bar]; x all of them
V_i, w_i           velocities in space and in the parametric plane [V with a bar]
A_i                acceleration in space
J_i = (s_u, s_v)   Jacobian (3 x 2) at x_i; J the block diagonal matrix of all of them
K, m, beta         constant of a spring, mass of a particle, coefficient of damping
k, c               K/m and beta/m, which are all that counts in the motion
L                  matrix of the springs, with rows (I, -2 I, I), so that the springs' force is K L P [K/m L: bold K]
h                  time step; x+, w+, J+ are x, w, J after the step, and without a sign they are those before it
E                  energy of the chain over K, ``1/2 sum over i of |P_(i+1) - P_i|^2``
================== =====================================================================================================

Figures, tables and algorithms that the code refers to are described where they belong: figures 1.3 and 6.3 and
section 6.3 in `layups`, figures 4.2 and 4.3 in `geodesics`, algorithms 1 and 2 in `bridging`, figures 7.1, 7.2, 7.6 and
7.7 and table 7.1 in `comparisons`.
"""
