"""What holds of random programs: 25 of them, or as many as MESHWIND_TEST_PROGRAMS says."""

import os

import pytest
from hypothesis import HealthCheck, Phase, given, settings
from program_random import holds, machines, works

from meshwind.program.machine import Machine
from meshwind.program.program import program
from meshwind.program.work import Work

COUNT = int(os.environ.get("MESHWIND_TEST_PROGRAMS", "25"))
"""A second for each."""


@pytest.mark.filterwarnings("ignore:Generating overly large repr")  # of a part, where one fails
@settings(
    max_examples=COUNT, deadline=None, derandomize=True, database=None, phases=[Phase.generate],
    suppress_health_check=list(HealthCheck),
)  # fmt: skip
@given(works(), machines())
def test_what_holds_of_every_program(wound: Work, machine: Machine) -> None:
    holds(program(wound, machine))
