"""What kernels a run needs, so that they are compiled before it and side by side."""

from collections.abc import Iterable

from meshwind.core.compile_ahead import compile_ahead
from meshwind.core.parsing import AUTO
from meshwind.core.progress import Progress, silent
from meshwind.workflow.options import Options


def compile_for(options: Iterable[Options], progress: Progress | None = None, laminate: bool = False) -> None:
    """Compile what is not kept yet of the kernels that runs with these options need, perhaps of a laminate."""
    jobs = {"wind"}
    for each in options:
        if each.friction != 0.0:
            jobs.add("friction")
        if each.revolutions == AUTO:  # what would hold where paths do not is tried with friction
            jobs |= {"friction", "auto"}
        if each.continuous or laminate:
            jobs |= {"friction", "continuous"}
    compile_ahead(jobs, progress or silent)
