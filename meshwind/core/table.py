"""Tables for pandas, which is an optional extra."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from meshwind.core.cast import Array
from meshwind.core.errors import BadInputError

if TYPE_CHECKING:
    import pandas

MISSING = 'a data frame needs pandas; install it with: pip install "meshwind[pandas]"'


def data_frame(columns: Mapping[str, Array]) -> pandas.DataFrame:
    """A table of columns of one length; raises BadInputError where pandas is not installed."""
    try:
        import pandas
    except ModuleNotFoundError as error:
        raise BadInputError(MISSING) from error
    return pandas.DataFrame({name: np.array(values) for name, values in columns.items()})


def as_columns(rows: Sequence[Mapping[str, Any]]) -> dict[str, Array]:
    """Rows as columns; a figure that a row lacks is None, or NaN among numbers."""
    columns: dict[str, Any] = {}
    for name in dict.fromkeys(key for row in rows for key in row):
        values = [row.get(name) for row in rows]
        plain = all(value is None or isinstance(value, int | float) for value in values)
        if plain and not all(isinstance(value, int) for value in values):
            columns[name] = np.array([np.nan if value is None else value for value in values])
        elif plain:
            columns[name] = np.array(values)
        else:
            columns[name] = np.empty(len(values), dtype=object)
            columns[name][:] = values
    return columns
