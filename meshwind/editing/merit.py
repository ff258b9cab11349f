"""Which of two states of an edit is the better one."""

SAME = 0.01
"""Share of the largest gap by which two states are alike in it: then that which bridges less is better."""
ALIKE = 1e-3
"""The same where the largest gap is to become the least, as not all can be met."""


def is_better(one: tuple[float, float], other: tuple[float, float], same: float = SAME, rise: float = 0.0) -> bool:
    """Whether one state is better than another, by their bridged shares and largest gaps.

    Gaps are alike that differ by no more than the share `same`, or of which the one's is larger by no more than the
    share `rise`.
    """
    (bridged, gap), (bridged_before, gap_before) = one, other
    if (bridged == 0.0) != (bridged_before == 0.0):
        return bridged == 0.0
    gain = (gap_before - gap) / gap_before if gap_before > 0.0 else -gap
    if gain > same or gain < -max(same, rise):
        return gain > 0.0
    return bridged < bridged_before
