"""What some tests need that pip does not install: how it is found, and the Debian packages that hold it.

`python tests/needs.py` prints the packages that the whole check installs, and `python tests/needs.py unpacked` those
that it unpacks.
"""

import sys
from collections.abc import Callable
from functools import cache
from shutil import which
from typing import NamedTuple

STRICT = "MESHWIND_TEST_ALL"
"""Environment variable: where it is set, a test whose need is missing fails; otherwise it is skipped."""


CHROMIUM = "chromium", "chromedriver"


class Need(NamedTuple):
    """A name to print, whether this machine has it, and the Debian packages that install it.

    unpacked: whether the whole check only unpacks it, as it brings much that no test needs.
    """

    name: str
    is_there: Callable[[], bool]
    packages: str
    unpacked: bool = False

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
    # with the desktop that it brings it is as large as all the others
    "linuxcnc": Need("LinuxCNC's interpreter", lambda: _has("rs274"), "linuxcnc-uspace", unpacked=True),
}
"""By the name of the fixture (in conftest.py) that a test asks for."""


if __name__ == "__main__":
    unpacked = sys.argv[1:] == ["unpacked"]
    sys.stdout.write(" ".join(need.packages for need in NEEDS.values() if need.unpacked == unpacked) + "\n")
