"""What holds of random programs: 40 of them, or as many as MESHWIND_TEST_PROGRAMS says."""

import os

from hypothesis import HealthCheck, Phase, given, settings
from program_random import holds, machines, works

from meshwind.program.machine import Machine
from meshwind.program.program import Work, program

COUNT = int(os.environ.get("MESHWIND_TEST_PROGRAMS", "40"))
"""A second for each."""


@settings(
    max_examples=COUNT, deadline=None, derandomize=True, database=None, phases=[Phase.generate],
    suppress_health_check=list(HealthCheck),
)  # fmt: skip
@given(works(), machines())
def test_what_holds_of_every_program(wound: Work, machine: Machine) -> None:
    holds(program(wound, machine))
