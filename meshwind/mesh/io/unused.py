"""Vertices that nothing uses, which show that a file without counts is cut short: the faces come last."""

_MANY = 0.1
"""Share of the vertices: construction points and nodes for reference are fewer."""


def words_on_unused(unused: int, count: int, nouns: tuple[str, str]) -> tuple[str, ...]:
    """A warning where many of the vertices are in no face; nouns: what the format calls vertices, and a face."""
    if unused <= _MANY * count:
        return ()
    vertices, face = nouns
    share = 100.0 * unused / count
    return (f"{share:.0f} % of the {vertices} ({unused} of {count}) are in no {face}: is the file cut short?",)
