"""The one error that a user can mend."""


class BadInputError(ValueError):
    """Input that cannot be used: one line that says what is wrong and what to do about it."""
