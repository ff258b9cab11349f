"""Figures of the other states of rest close to those of a run's paths."""

import numpy as np

from meshwind.path.other_rests import LOOSER, OtherRests
from meshwind.path.paths import Paths, Status
from meshwind.results.report_types import OtherRestsFigures, OtherStateFigures


def other_rest_figures(paths: Paths) -> OtherRestsFigures:
    """Look for other states, and list them path by path."""
    rests = paths.other_rests
    known = rests.moved[~np.isnan(rests.moved)]
    return {
        "friction": LOOSER,
        "shift": rests.most_shifted,
        "largest_move": float(known.max()) if len(known) else None,
        "found": [_figures(rests, int(k)) for k in np.flatnonzero(rests.found)],
    }


def _figures(rests: OtherRests, path: int) -> OtherStateFigures:
    status = Status(int(rests.status[path]))
    return {
        "path": path,
        "apart": float(rests.apart[path]),  # NaN becomes None in the report
        "length": float(rests.length[path]),
        "status": int(status),
        "name": status.name.lower(),
        "friction": float(rests.friction[path]),
        "shift": float(rests.shift[path]),
    }
