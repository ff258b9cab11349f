"""The exception for input that cannot be used."""


class BadInputError(ValueError):
    """Input that cannot be used.

    It is raised for everything that the caller can correct.  Its message is one line that says what is wrong and what
    to do about it.

    Examples
    --------
    >>> import meshwind as mw
    >>> mw.shapes.cylinder(radius=0.0, length=1.0)
    Traceback (most recent call last):
    meshwind.core.errors.BadInputError: radius0 is 0.0; give a positive length
    """
