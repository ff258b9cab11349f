"""The main job: mesh in, paths out.  Each stage is a library call; this file only strings them together."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from time import perf_counter

from meshwind.chart import Chart, flatten
from meshwind.errors import BadInputError
from meshwind.layup import Layup, families, layup
from meshwind.mandrel import Annulus, Mesh, annulus, read
from meshwind.output import folder, pictures, report, write
from meshwind.path import Paths, Status, solve
from meshwind.surface import Surface, fit

Tell = Callable[[str], None]
