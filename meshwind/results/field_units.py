"""The unit of each field that has one."""

_LENGTHS = "gap", "arc_length", "length", "fibre_length", "bridged_length", "max_gap", "fit_error"
_OTHERS = {"mean_curvature": "1/{u}", "gaussian_curvature": "1/{u}2", "angle": "degrees", "press_reach": "degrees"}


def unit_of(field: str, units: str) -> str:
    """The unit of a field where lengths are in `units`; "" for a plain number, and where `units` is not known."""
    told = _OTHERS.get(field, "{u}" if field in _LENGTHS else "")
    return told.format(u=units) if units or "{u}" not in told else ""
