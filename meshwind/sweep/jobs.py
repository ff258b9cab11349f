"""The jobs of a study: parts to fit, each before its cases; where they run is a runner's business."""

from dataclasses import dataclass

from meshwind.core.errors import BadInputError
from meshwind.mesh import Mesh, read
from meshwind.mesh.io.scalars import Scalars, read_scalars
from meshwind.options import FIELD, Options
from meshwind.sweep.study import Case


@dataclass(frozen=True)
class Batch:
    """Cases that share a part, by their numbers in the study."""

    cases: dict[int, Case]

    @property
    def first(self) -> Case:
        """One of them: in what the part depends on they are alike."""
        return next(iter(self.cases.values()))

    def read(self) -> tuple[Mesh, Scalars | None, Options] | str:
        """What the part is fitted to, or why that cannot be read."""
        case = self.first
        try:
            mesh = read(case.mesh, case.options.component)
            told = case.options.friction
            field = read_scalars(case.mesh, told.removeprefix(FIELD).strip()) if isinstance(told, str) else None
        except BadInputError as error:
            return str(error)
        return mesh, field, case.options


def batches(cases: dict[int, Case]) -> list[Batch]:
    """The cases by the part that they share."""
    by_part: dict[tuple[object, ...], dict[int, Case]] = {}
    for number, case in cases.items():
        by_part.setdefault(case.shared, {})[number] = case
    return [Batch(held) for held in by_part.values()]
