"""Tables for pandas, which is an optional extra."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

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
