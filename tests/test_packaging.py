"""What the wheel and the source distribution hold."""

import re
import tarfile
import tomllib
import zipfile
from pathlib import Path

import pytest
from hatchling.builders.sdist import SdistBuilder
from hatchling.builders.wheel import WheelBuilder

ROOT = Path(__file__).parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]

KINDS = ".py", ".html", ".css", ".js", ".json", ".toml"


def sources(folder: str, *kinds: str) -> set[str]:
    """Files below a folder of the repository, as paths from its root."""
    return {str(file.relative_to(ROOT)) for kind in kinds for file in (ROOT / folder).rglob(f"*{kind}")}


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> set[str]:
    (built,) = WheelBuilder(str(ROOT)).build(directory=str(tmp_path_factory.mktemp("wheel")), versions=["standard"])
    with zipfile.ZipFile(built) as file:
        return set(file.namelist())


@pytest.fixture(scope="module")
def sdist(tmp_path_factory: pytest.TempPathFactory) -> set[str]:
    (built,) = SdistBuilder(str(ROOT)).build(directory=str(tmp_path_factory.mktemp("sdist")), versions=["standard"])
    with tarfile.open(built) as file:
        return {name.partition("/")[2] for name in file.getnames()}


def test_the_wheel_holds_the_package_and_nothing_else(wheel: set[str]) -> None:
    package = sources("meshwind", *KINDS) | {"meshwind/py.typed"}
    assert {name for name in wheel if not re.match(r"meshwind-[\d.]+\.dist-info/", name)} == package
    assert any(name.endswith("licenses/LICENSE") for name in wheel)


def test_the_source_distribution_can_be_built_and_tested(sdist: set[str]) -> None:
    top = {"README.md", "LICENSE", "CHANGELOG.md", "CONTRIBUTING.md", "CITATION.cff", "pyproject.toml"}
    assert top | sources("meshwind", *KINDS) | {"meshwind/py.typed"} <= sdist
    assert sources("tests", ".py", ".json") | sources("data", "") - {"data"} <= sdist


def test_one_version_everywhere() -> None:
    version = PROJECT["version"]
    assert f"\nversion: {version}\n" in (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    newest = re.search(r"^## \[(.+?)\] - (\S+)$", (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"), re.MULTILINE)
    assert newest and newest[1] == version
    assert f'date-released: "{newest[2]}"' in (ROOT / "CITATION.cff").read_text(encoding="utf-8")
