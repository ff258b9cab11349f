"""Files that are shipped with a package and asked for by name, beside files of one's own."""

from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path

from meshwind.core.errors import BadInputError
from meshwind.core.parsing import nearest


@dataclass(frozen=True)
class Shipped:
    """The TOML files in a folder of a package; kind: what each of them is, for messages."""

    package: str
    folder: str
    kind: str

    @property
    def names(self) -> list[str]:
        """Their names, without the ending."""
        found = files(self.package).joinpath(self.folder).iterdir()
        return sorted(each.name.removesuffix(".toml") for each in found if each.name.endswith(".toml"))

    def file(self, name: str) -> Path:
        """The file of a name, or the TOML file that it is the path of; raises BadInputError where it is neither."""
        if name.lower() in self.names:
            return Path(str(files(self.package).joinpath(self.folder, f"{name.lower()}.toml")))
        if name.lower().endswith(".toml"):
            return Path(name)
        advice = nearest(name, self.names)
        raise BadInputError(
            f"no {self.kind} {name!r}; {advice}{'' if advice.endswith('?') else ','} or give a file.toml"
        )
