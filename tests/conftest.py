"""Tests that need more than pip installs are skipped where it is missing, and the last lines say what to install."""

import os
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from shutil import which
from typing import TYPE_CHECKING

import pytest
from needs import CHROMIUM, NEEDS, STRICT

from meshwind.core.compile_ahead import compile_ahead

if TYPE_CHECKING:
    from selenium import webdriver

_MISSING = "missing"
"""Property of a test's report: the need that was not met."""


@pytest.fixture(scope="session")
def opengl() -> None:
    """For tests that draw: this machine has an OpenGL driver."""


@pytest.fixture(scope="session")
def chromium() -> tuple[str, str]:
    """For tests in a browser: the executables of Chromium and of its driver."""
    browser, driver = (which(program) or "" for program in CHROMIUM)
    return browser, driver


@pytest.fixture(scope="module")
def browser(
    page: Path, tmp_path_factory: pytest.TempPathFactory, chromium: tuple[str, str]
) -> "Iterator[webdriver.Chrome]":
    """For tests of a page, which a module has as the fixture of this name: a browser that shows it."""
    from benchmarks.browser import opened

    with opened(page, tmp_path_factory.mktemp("chromium"), chromium) as driver:
        yield driver


@pytest.fixture(scope="session")
def calculix() -> None:
    """For tests that run a shell deck: this machine has CalculiX."""


@pytest.fixture(scope="session")
def linuxcnc() -> None:
    """For tests of programs for LinuxCNC: this machine has its interpreter."""


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> None:
    """Look for what the test's fixtures need before any of them is set up."""
    for name in NEEDS.keys() & set(getattr(item, "fixturenames", ())):
        if NEEDS[name].is_there():
            continue
        item.user_properties.append((_MISSING, name))
        if os.environ.get(STRICT):
            pytest.fail(f"{NEEDS[name].advice}, and {STRICT} is set", pytrace=False)
        pytest.skip(NEEDS[name].advice)


def pytest_configure(config: pytest.Config) -> None:
    """Compile the kernels that are missing before several processes test, which would each compile them."""
    if getattr(config.option, "numprocesses", None) and not hasattr(config, "workerinput"):
        compile_ahead()


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Name the skipped tests, file by file, with what each lacked."""
    for name, need in NEEDS.items():
        files = Counter(
            report.nodeid.split("::")[0]
            for report in terminalreporter.stats.get("skipped", [])
            if (_MISSING, name) in map(tuple, report.user_properties)
        )
        if files:
            terminalreporter.section(f"skipped: {need.advice}")
            for file, count in sorted(files.items()):
                terminalreporter.line(f"{file}: {count} {'test' if count == 1 else 'tests'}")
