"""The criterion of Tsai and Wu for a unidirectional ply in plane stress.

S. W. Tsai and E. M. Wu, "A general theory of strength for anisotropic materials", Journal of Composite Materials 5
(1971), 58-80.
"""

from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Floats
from meshwind.exporting.shell_about import Strengths


class Index(NamedTuple):
    """At m points: the criterion's polynomial (m,), which is 1 at failure, and the exposure (m,).

    The exposure is the load over that which makes the ply fail: it grows in proportion with the stress, and 1 over it
    is the factor to failure.
    """

    polynomial: Floats
    exposure: Floats


def index(stress: Floats, strengths: Strengths) -> Index:
    """Index at stresses 11, 22, 12 (m, 3) in the axes of the fibres, in MPa.

    F1 s1 + F2 s2 + F11 s1^2 + F22 s2^2 + 2 F12 s1 s2 + F66 s12^2 with F1 = 1/Xt - 1/Xc, F11 = 1/(Xt Xc), F2 and F22
    likewise of Y, F66 = 1/S^2, and F12 the interaction times sqrt(F11 F22).
    """
    xt, xc, yt, yc, s = (strengths.of[name] for name in ("xt", "xc", "yt", "yc", "s"))
    f11, f22 = 1.0 / (xt * xc), 1.0 / (yt * yc)
    along, across, shear = stress.T
    linear = (1.0 / xt - 1.0 / xc) * along + (1.0 / yt - 1.0 / yc) * across
    square = f11 * along**2 + f22 * across**2 + (shear / s) ** 2
    square = square + 2.0 * strengths.interaction * np.sqrt(f11 * f22) * along * across
    root = np.sqrt(linear**2 + 4.0 * square)
    # the positive root of e^2 - linear e - square, without a difference of like numbers
    above = np.where(linear > 0.0, linear + root, root - linear)
    exposure = np.where(linear > 0.0, 0.5 * above, 2.0 * square / np.where(above > 0.0, above, 1.0))
    return Index(linear + square, np.asarray(exposure))
