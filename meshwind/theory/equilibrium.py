"""Chapter 3: when a fibre under tension is in equilibrium on a surface, and geodesics as an initial value problem.

Balance of forces (section 3.1)
-------------------------------
A piece of fibre between the arc lengths l0 and l1 is pulled at both ends by the tension, along its tangents, and
carried by what the surface exerts on it::

    T(l1) t(l1) - T(l0) t(l0) + integral over [l0, l1] of (N n + f) dl = 0                                (3.1) context
    force per unit length = N n + f,    f . n = 0                                                         (3.2) context
    T' t + T t' + N n + f = 0                                                                             (3.3) context

The tension is taken as constant along the fibre, as the machine sets it::

    T t' + N n + f = 0                                                                                            (3.4)

As t is a unit vector, t' = r'' is square to it.  With its principal normal n_r, a unit vector along r'',
``t' = |r''| n_r``, and in the surface's own directions r'' = kg b - kn n.  So (3.4) says, component by component::

    N = T kn,    f = -T kg b

Friction therefore acts across the fibre only: along it there is nothing to balance while the tension is constant.
Written with n_r, and with ``T |r''|`` squared::

    t' = |r''| n_r                                                                             (3.5) corrected, context
    -T |r''| n_r = N n + f                                                                     (3.6) corrected, context
    T^2 |r''|^2 = N^2 + |f|^2                                                                  (3.7) corrected, context

Coulomb's law (section 3.1)
---------------------------
Friction holds the fibre as long as ::

    |f| <= mu N                                                                                           (3.8) context
    T |r''| <= sqrt(1 + mu^2) N                                                                (3.9) corrected, context
    N = T |r''| (-n_r . n)                                                                    (3.10) corrected, context
    -n_r . n >= 1 / sqrt(1 + mu^2)                                                                       (3.11) context
    angle(n, -n_r) <= arctan(mu)                                                                                 (3.12)

In curvatures (3.12) is simply ::

    kn > 0  and  |kg| / kn <= mu

``|kg| / kn`` is the *required friction*: the least coefficient that holds the fibre where it lies.  The file field
`slip` and the attribute `Paths.slip` hold it.  A fibre that carries no load, N = 0, is straight there and needs none::

    N = 0:  r'' = 0,  and (3.12) is taken as met                                                         (3.13) context

Without friction n = -n_r: the fibre is a geodesic, kg = 0, where it presses::

    n = -n_r                                                                                             (3.14) context

A curve that is confined to the surface follows hollows as well, where n_r points outwards.  There the sign of n_r is
the one that makes the angle acute, that is, ``|kg| / |kn|`` takes the place of ``|kg| / kn``::

    angle(n, +n_r or -n_r) <= arctan(mu)                                                                         (3.15)
    n = +n_r or -n_r                                                                                     (3.16) context

meshwind uses (3.15) only for the angles in `meshwind.methods`, which the source charts; the solver decides first where
the fibre touches (chapter 5), and asks for (3.12) there.  Friction cannot hold a fibre where kn <= 0.

Particles (section 3.2)
-----------------------
The fibre is represented by points on it::

    P_i = r(l_i),  i = 1 ... end                                                                         (3.17) context

Four numbers fix a geodesic: a point, a direction and a length (a marching problem, `meshwind.trace`), or two points
(a boundary value problem, `meshwind.solve`).

Forward solver (section 3.3)
----------------------------
By arc length, with p = du/dl and q = dv/dl::

    |r'| = 1                                                                                                     (3.18)
    t = p s_u + q s_v                                                                                            (3.19)

Both components of r'' along the surface vanish for a geodesic::

    u'' + Gu_uu u'^2 + 2 Gu_uv u' v' + Gu_vv v'^2 = 0
    v'' + Gv_uu u'^2 + 2 Gv_uv u' v' + Gv_vv v'^2 = 0                                                    (3.20) context

where Christoffel's symbols are ::

    Gu_ij = (a_vv s_ij . s_u - a_uv s_ij . s_v) / W^2
    Gv_ij = (a_uu s_ij . s_v - a_uv s_ij . s_u) / W^2   for ij = uu, uv, vv                            (3.21) corrected

As a system of first order, which is what is integrated::

    u' = p,    p' = -Gu_uu p^2 - 2 Gu_uv p q - Gu_vv q^2
    v' = q,    q' = -Gv_uu p^2 - 2 Gv_uv p q - Gv_vv q^2                                                         (3.22)

The source integrates (3.22) by the classical Runge-Kutta method of fourth order with a fixed step.

Extension in meshwind: a fibre of constant required friction.  With kg = mu kn, the bound of (3.12) used to the full, b
in the basis s_u, s_v is (-(a_uv p + a_vv q), a_uu p + a_uv q) / W, so that (3.22) gains ::

    p' += -mu kn (a_uv p + a_vv q) / W,    q' += mu kn (a_uu p + a_uv q) / W

A positive mu turns the fibre to its left.  `meshwind.march.geodesic_equation` holds this right-hand side.
"""
