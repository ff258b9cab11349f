"""Words for what a program does and what is wrong with it, for those who watch it."""

from meshwind.appearance.strips import WORDS
from meshwind.filament.course import Kind
from meshwind.program.faults import EYE, LIES, LIMIT, SPAN

AXES = {"mandrel": "mandrel", "carriage": "carriage", "cross": "cross-feed", "roll": "roll", "yaw": "yaw"}
"""Names of the axes, by what they move."""
_FAULTS = {
    SPAN: "the free span meets the part or the shaft",
    EYE: "the eye is too near to the part",
    LIMIT: "an axis leaves its travel",
    LIES: "the fibre does not lie where it was planned",
}


def fault_words(kind: str) -> str:
    """A kind of fault in short words."""
    return _FAULTS.get(kind, kind)


DOES = (*(WORDS[kind] for kind in Kind), "cut: on the way to the next filament")
"""What the fibre does, by the kind of a block."""
