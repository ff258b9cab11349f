"""Studies: many windings of many parts, as cases of one table."""

from meshwind.studies.run import Swept, sweep
from meshwind.studies.study import Case, Study, read_study

__all__ = ["Case", "Study", "Swept", "read_study", "sweep"]
