"""Chapter 4: particles joined by springs, moved in the parametric plane until they are at rest.

Equations of motion (section 4.1)
---------------------------------
Neighbouring particles are joined by springs of constant K without rest length, so that the chain shortens as far as it
can.  The force on an inner particle is ::

    F_i = K (P_(i-1) - P_i) + K (P_(i+1) - P_i)                                                                   (4.1)

which is minus K times the gradient of the energy ``E = 1/2 sum over i of |P_(i+1) - P_i|^2``.

With unit masses, or k = K/m, all accelerations in space are linear in the positions; the two ends are fixed::

    A = k L P,    rows of L: (I, -2 I, I) for inner particles, 0 for the two ends                         (4.2) context

A particle on the surface is P_i = s(x_i), and so ::

    V_i = dP_i/dt = J_i dx_i/dt = J_i w_i                                                      (4.3) corrected, context
    A = J dw/dt + (dJ/dt) w                                                                                       (4.4)
    (dJ/dt) w = s_uu w_u^2 + 2 s_uv w_u w_v + s_vv w_v^2   for each particle

The surface takes up what is normal to it; J^T keeps the rest::

    J dw/dt = k L P - (dJ/dt) w,  but for forces along the normals                                        (4.5) context
    J^T J dw/dt = J^T (k L P - (dJ/dt) w)                                                                 (4.6) context

A damping force -beta V on each particle adds, with c = beta/m ::

    J dw/dt = k L P - (dJ/dt) w - c J w,  but for forces along the normals                              (4.7) corrected

At rest w = 0, and only the state at rest is wanted, so the velocity term may go::

    J^T J dw/dt = k J^T L P                                                                                       (4.8)

The motion then depends on the chart, but its equilibria do not.  They are the geodesics with equally spaced particles:
J^T L P = 0 says that no spring pulls along the surface.

Only minima of E are stable.  An equilibrium at which E falls in some direction is a saddle of E: a taut fibre leaves it
along that direction of *negative curvature* (second derivative) of E.  See `errata` for the source's word for it.

Explicit steps (section 4.2)
----------------------------
Euler's method on (4.6) is ::

    J^T J (w+ - w) = h J^T (k L P - (dJ/dt) w)                                                            (4.9) context
    w+ = w + h (J^T J)^-1 J^T (k L P - (dJ/dt) w),    x+ = x + h w                                               (4.10)
    w+ = w + h (J^T J)^-1 J^T (k L P - (dJ/dt) w) - h c w                                                        (4.11)
    w+ = w + h (J^T J)^-1 J^T k L P                                                                              (4.12)

(4.11) is (4.10) with damping and (4.12) is (4.10) without the velocity term.  Undamped, (4.10) multiplies the amplitude
of a mode of angular frequency omega by sqrt(1 + (h omega)^2) in every step: there is no stable step at all.  With the
new velocity in the position, x+ = x + h w+, the method is symplectic Euler, stable for h < 2 / omega.  The classical
Runge-Kutta method, which the source tries as well, is stable for h < 2 sqrt(2) / omega.  The highest frequency of a
straight chain of n particles is 2 sqrt(k) cos(pi / (2 (n - 1))).  With damping c the limits are those of
`meshwind.methods.stable_step`.

Implicit steps (section 4.3)
----------------------------
Backward Euler takes forces and Jacobians at the end of the step::

    (J+)^T J+ (w+ - w) = h (J+)^T k L P+                                                                         (4.13)

It is made linear by J+ = J and ::

    P+ = s(x + h w+) = P + h J w+ approximately                                               (4.14) corrected, context
    J^T J (w+ - w) = h J^T k L (P + h J w+)                                                              (4.15) context

so that each step is one linear system, block tridiagonal with 2 x 2 blocks::

    J^T (I - h^2 k L) J w+ = J^T J w + h k J^T L P,    x+ = x + h w+                                             (4.16)
    J^T ((1 + h c) I - h^2 k L) J w+ = J^T J w + h k J^T L P,    x+ = x + h w+                                   (4.17)

(4.17) is (4.16) with damping.  For a long time step the first matrix is all but -h^2 k J^T L J, and the move is ::

    x+ - x = h w+ = -(J^T L J)^-1 J^T L P

a Gauss-Newton step on E.  Departure in meshwind: the solver keeps the second derivatives that Gauss-Newton drops; the
diagonal block of particle i then is, with F = F_i / K ::

    2 J_i^T J_i - (F . s_uu, F . s_uv; F . s_uv, F . s_vv)

and the step is Newton's.  What remains of the time step is a multiple of J^T J that is added where this matrix is not
positive definite.

Friction as a scaling of velocities (section 4.4)
-------------------------------------------------
After a step the velocity of each particle is shortened by what friction can take from it in the time h, from the force
with which the springs press it on the surface::

    V_i+ = max(1 - h mu |A_i . n| / |V_i before|, 0) V_i before                               (4.18) corrected, context
    w_i+ = max(1 - h mu |A_i . n| / |J_i w_i before|, 0) w_i before                                              (4.19)

Departure in meshwind: only `meshwind.methods` uses (4.19).  It is not Coulomb's law, because the implicit step has
spread every force over the neighbours before it is scaled, so that particles stick too early or too late and the state
at rest need not meet (3.12); and it resists motion along the fibre as well, against the constant tension of (3.4).

The solver lets the fibre slide instead.  Overdamped and of constant tension, it moves across itself at the rate ::

    w = sign(kg) max(|kg| - mu kn, 0)

where it touches, until it is at rest, and (3.12) holds at every particle.  Where it comes to rest depends on its way
there: a particle that has slid one way may be drawn back when the rest of the fibre has straightened, or be held where
it stopped.  A step in time of length t is implicit: with d the slips from where the fibre lay before it minimises ::

    E + sum (mu N |d| + d^2 / (2 t))

with the contact forces N held, and is made anew with those at its end until they no longer change it.  Each is a
minimum, by which every step of Newton's method is judged; held, too, they let particles stick and slip without going in
circles.  Bridges form in no time, waves die out in a time of their length squared, and so the steps grow by a constant
factor.  At rest the fibre is balanced to the last against friction from the earliest curve that leads to the same
place: the starting curve where nothing has turned back.  A fibre that begins to slip to one side only never turns back,
as curves that shorten keep their order; where it presses everywhere one step of endless length does.
`meshwind.path.kernels.coulomb` states the equations that it solves.

Figures
-------
Figure 4.2 shows the distance to the exact geodesic, and the angle of (3.12), for each particle after 50 to 200 steps of
(4.16); figure 4.3 shows the same on half a sphere for mu from 0 to 0.3.  `examples/charts/source_on_surface.py` redoes
both.
"""
