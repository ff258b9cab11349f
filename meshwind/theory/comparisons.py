"""Chapter 7: the methods that the source compares with, in space rather than in the parametric plane.

Penalty force (section 7.2)
---------------------------
Particles move in space.  Closer to the surface than epsilon they are pushed off it, away from their foot, by a force
that grows with the depth; d is the signed distance, negative inside the body::

    force(d) = 0                          for d > epsilon
               k_PF (epsilon - d)/epsilon for epsilon >= d > 0
               k_PF                       for d <= 0                                              (7.1)

A fibre in contact thus floats above the surface, by up to epsilon; a small epsilon needs a small step.

Karush-Kuhn-Tucker method (section 7.2)
---------------------------------------
Without contact the chain takes linearly implicit steps.  M is the mass matrix, S = df/dP the derivative of the
forces f [K], v the new and v_0 the old velocities; with M = m I and S = K L this is (4.16) with J = I::

    (M - h^2 S) v = M v_0 + h f,  in short  D v = y                                                               (7.2)

The source writes D and y as M and f with tildes.  A particle in contact does not move along the normal, and all such
rows make G::

    n . v = 0                                                                                                     (7.3)
    G v = 0                                                                                                       (7.4)

Then v minimises ::

    1/2 v^T D v - v^T y                                                                                           (7.5)
    subject to G v = 0                                                                                            (7.6)

and follows with multipliers lambda, one for each contact, from ::

    (D, G^T; G, 0) (v; lambda) = (y; 0)                                                                           (7.7)
    G D^-1 G^T lambda = G D^-1 y                                                                        (7.8) corrected
    D v = y - G^T lambda                                                                                          (7.9)

The surface acts on the fibre by -G^T lambda, that is by -lambda n on a particle.  It can only push, so contacts with
lambda > 0 are let go: lambda is set to 0 and v found again by (7.9).  To take back gaps that would otherwise stay, the
right-hand side of (7.3) is -stabilisation gap / h in place of 0.

In meshwind (7.8), whose matrix is dense, is not formed.  With P = I - n n^T for particles in contact and I for the
others, v = P w solves P D P w = P y, a block tridiagonal system, and lambda = n . (y - D v).

Reuse of the matrix (section 7.2)
---------------------------------
The matrix of (4.16) changes little from step to step; factored once, it may serve several.  The equilibrium does not
depend on it.

Figures and tables
------------------
Figure 7.1: a fibre dragged by its ends along both sides of a valley meets a peak; confined to the surface it is caught
by a small peak as well as by a large one, while a fibre that can lift jumps over the small one (`meshwind.drag`).
Figure 7.2-b: one path that bridges on a B-spline surface.  Table 7.1: how the time of 1000 steps of (4.16) on it
splits, 603 ms on six threads in all: building the matrix 39 %, solving 34 %, lifting and landing 25 %, the rest 3 %.
Figure 7.6: the path's length against wall-clock and simulated time for (4.16), the same with reuse, the penalty force
and the Karush-Kuhn-Tucker method.  Figure 7.7: a freeform mesh, its chart as an image whose red, green and blue are the
x, y and z of surface points (`meshwind.surface_image`), and paths on it (section 7.3).
"""
