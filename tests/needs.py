"""What some tests need that pip does not install: how it is found, and the Debian packages that hold it.

`python tests/needs.py` prints the packages that the whole check installs.
"""

import sys
from collections.abc import Callable
from functools import cache
from shutil import which
from typing import NamedTuple

STRICT = "MESHWIND_TEST_ALL"
"""Environment variable: where it is set, a test whose strict need is missing fails; otherwise it is skipped."""


CHROMIUM = "chromium", "chromedriver"


class Need(NamedTuple):
    """A name to print, whether this machine has it, and the Debian packages that install it.

    strict: whether the whole check installs it, and fails without it.
    """

    name: str
    is_there: Callable[[], bool]
    packages: str
    strict: bool = True

    @property
    def advice(self) -> str:
        """What is missing and how to install it."""
        return f"{self.name} is missing (Debian: apt-get install {self.packages})"


@cache
def _can_draw() -> bool:
    """Whether VTK finds a driver; any other failure to draw is for the tests to find."""
    from meshwind.pictures.driver import NO_DRIVER, can_draw

    return can_draw() != NO_DRIVER


def _has(*programs: str) -> bool:
    return all(which(program) for program in programs)


NEEDS = {
    "opengl": Need("an OpenGL driver", _can_draw, "libegl1 libgl1-mesa-dri"),
    "chromium": Need("Chromium with its driver", lambda: _has(*CHROMIUM), "chromium chromium-driver"),
    "calculix": Need("CalculiX", lambda: _has("ccx"), "calculix-ccx"),
    # with what it brings it is as large as all the others, so that it is tested where it is there
    "linuxcnc": Need("LinuxCNC's interpreter", lambda: _has("rs274"), "linuxcnc-uspace", strict=False),
}
"""By the name of the fixture (in conftest.py) that a test asks for."""


if __name__ == "__main__":
    sys.stdout.write(" ".join(need.packages for need in NEEDS.values() if need.strict) + "\n")
