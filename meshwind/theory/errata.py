"""What is wrong or ambiguous in the source, and what meshwind uses instead.

The left column gives what the copy at hand prints, in the notation of these pages; some of it may be the copy's fault.

============= ============================================= ===============================================
where         printed                                       used
============= ============================================= ===============================================
(3.5)-(3.7)   ``|r'|``, which is 1                          ``|r''|``, the curvature
(3.9), (3.10) the same                                      the same
(3.21)        second terms of all symbols but the first two s_ij . s_v in Gu_ij and s_ij . s_u in Gv_ij; the
              end in a bare s_uv or s_vv; Gv_vv has no name last symbol is Gv_vv
section 4.1   an unstable geodesic is a local maximum of    it is a saddle: of the curves near it some are
              the length                                    shorter, but zigzags are always longer
(4.3)         V_i = dP_i/dx_i                               V_i = J_i dx_i/dt
(4.7)         damping force beta V; dJ/dt dV/dt on the      damping force -beta V; J dw/dt on the left,
              left                                          as (4.11) and (4.17) have it
(4.14)        P+ = P + h J+ w                               P + h J w+, the superscripts exchanged, which
                                                            (4.15) uses
(4.18)        A . n without absolute value                  ``|A . n|``, as (4.19) has it: with n outwards it
                                                            is negative where the fibre presses, and
                                                            friction would drive the fibre on
(5.7)         the Hessian H without the factor 2 that       both without it, for g / 2: as printed, step (5.5)
              grad g has                                    is twice too long and does not converge
(5.8)         denominator (i - i_(j-1)) (i_(j-1) - i)       (i - i_(j-1)) (i_(j+1) - i), as in (5.2): the
                                                            three weights of a row add up to 0
Algorithm 1   ``P_- - 2 P_i + P_+``                         the force of (5.2), as ``i_-`` and ``i_+`` need
                                                            not be as far from i
(6.3)         s_uv without a factor 2; > 0, with            2 s_uv; < 0, as s_u x s_v points outwards here
              s_u x s_v inwards
section 6.3   ceiling(x) new paths between two that are     ceiling(x) - 1 are enough
              x times the largest distance apart
(7.5)         V for the second v                            v
(7.8)         G D G^T lambda = G D y                        G D^-1 G^T lambda = G D^-1 y, which follows from
                                                            (7.7)
section 7.2   a contact with lambda > 0 needs a constraint  it is let go, as is then done in the source too
============= ============================================= ===============================================

Not errors, but departures: the solver's Newton steps in place of (4.16), Coulomb's law in place of (4.19), descent of
the energy in place of lifting and landing in turn, and the changes to (6.3) and (6.12).  Each is argued on the page of
its chapter and beside the code.
"""
