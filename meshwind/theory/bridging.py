"""Chapter 5: fibres that leave the surface where it is hollow, and come back to it.

Lifting (section 5.1)
---------------------
A particle is pulled off the surface where the curve bends outwards::

    n . n_r > 0                                                                                                   (5.1)

*Touching* particles are on the surface, *lifted* ones are not.  Let ``i_-`` and ``i_+`` be the touching particles
nearest before and after the touching particle i, and ``P_-`` and ``P_+`` their positions.

Algorithm 1: mark particle i as lifted where ``(P_- - 2 P_i + P_+) . n_i > 0``, put it on the line between ``P_-`` and
``P_+``, and repeat until no particle is marked in a whole sweep.  The ends always touch.

Springs across a bridge (section 5.2)
-------------------------------------
Lifted particles lie evenly on the straight line between the touching ones next to them.  Springs in a row act as one
that is softer by their number, so the force on particle i, per unit of K, is ::

    F = (P_- - P_i) / (i - i_-) + (P_+ - P_i) / (i_+ - i).

Let i_1 < i_2 < ... be the touching particles.  Over these alone the matrix L has the rows ::

    row j:  a_j I,  b_j I,  a_(j+1) I    for the touching particles i_(j-1), i_j, i_(j+1)
    a_j = 1 / (i_j - i_(j-1)),    b_j = -(i_(j+1) - i_(j-1)) / ((i_j - i_(j-1)) (i_(j+1) - i_j))                  (5.2)

As an example, of six particles 3 and 4 are lifted; the rows of particles 2 and 5 over 1, 2, 5, 6 are ::

    (1, -4/3, 1/3, 0),    (0, 1/3, -4/3, 1)                                                               (5.3) context

Departure in meshwind: Algorithm 1 is applied with this force F in place of ``P_- - 2 P_i + P_+``.  Where ``i - i_-``
and ``i_+ - i`` differ, the unweighted sum can point outwards although the springs pull inwards; then a particle beside
a bridge is lifted and lands in turn, for ever.  `meshwind.methods.run` has both, by its argument `weighted`.

Landing (section 5.3)
---------------------
The *foot* of a point P is the point of the surface nearest to it, the minimum of ::

    g(x) = |s(x) - P|^2                                                                                           (5.4)
    x+ = x - H^-1 grad g                                                                                          (5.5)

the second line being Newton's method.  With d = s(x) - P, both derivatives of the same function g / 2 are ::

    H = (s_uu . d + a_uu,  s_uv . d + a_uv;  s_uv . d + a_uv,  s_vv . d + a_vv)                   (5.6) (5.7) corrected
    grad = J^T d                                                                                  (5.6) (5.7) corrected

The copy of the source at hand gives both under the one number (5.7); (5.6) belongs to one of them.

Algorithm 2: for each lifted particle find the foot s(x) by (5.5); where (P - s(x)) . n <= 0 the particle is inside the
body: it becomes touching, with the foot as its position.

Newton's method needs a guess.  The source moves a *shadow* particle on the surface for each lifted one, drawn by the
springs of its neighbours' shadows; its matrix over all particles has the rows ::

    touching, i = i_j:  -(i_(j+1) - i_(j-1)) / ((i - i_(j-1)) (i_(j+1) - i)) I at i,
                        I / (i - i_(j-1)) at i_(j-1),  I / (i_(j+1) - i) at i_(j+1)     (5.8) corrected, context
    lifted:             -2 I at i,  I at i - 1,  I at i + 1                                               (5.9) context

with the shadows' own positions in the columns of lifted particles.  In the example ::

    particle 2: (1, -4/3, 0, 0, 1/3, 0)       particle 3: (0, 1, -2, 1, 0, 0)
    particle 5: (0, 1/3, 0, 0, -4/3, 1)       particle 4: (0, 0, 1, -2, 1, 0)                                    (5.10)

Touching particles do not feel the shadows, so their system is solved first.

Departure in meshwind: a lifted particle keeps the foot that was found last, in place of a shadow.  Past the focal
distance of the surface the foot is not unique, and Newton's method stays on the near side of the body where the true
nearest point may be on the other; so the foot is looked for in a search tree over the surface when the particle may
have come near another part of it, and the finished path is checked as a whole.  Moreover lifting and landing in turn
need not come to an end.  The solver therefore keeps every iterate outside the body and accepts a step only if the
energy E falls.
"""
