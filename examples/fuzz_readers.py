"""Fuzz a reader, guided by coverage: any file must give a mesh or an error of one line.

    pip install atheris
    python examples/fuzz_readers.py .obj corpus -max_total_time=600

Arguments are the suffix of a format, then those of libFuzzer: a folder of first files, to which it adds, and options.
It stops at the first file with any other outcome, and keeps it.
"""

import sys
import tempfile
from pathlib import Path

import atheris

from meshwind.core.errors import BadInputError
from meshwind.mesh.io.read import read

with atheris.instrument_imports(include=["trimesh.exchange"]):
    import trimesh  # noqa: F401


def main() -> None:
    """Fuzz until the time limit or the first finding."""
    suffix, *options = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, f"part{suffix}")

        def once(data: bytes) -> None:
            path.write_bytes(data)
            try:
                read(path)
            except BadInputError as error:
                if "\n" in str(error):
                    raise RuntimeError("more than one line") from error

        atheris.Setup([sys.argv[0], *options], once)
        atheris.Fuzz()


if __name__ == "__main__":
    main()
