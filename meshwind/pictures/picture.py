"""A picture in memory."""

from __future__ import annotations

import io
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

from meshwind.core.checks import path_given
from meshwind.core.errors import BadInputError

if TYPE_CHECKING:
    from PIL import Image


@dataclass(frozen=True)
class Picture:
    """A picture in memory, which a notebook shows.

    Attributes
    ----------
    png : bytes
        The picture as a PNG file.
    title : str
        What it shows.

    Examples
    --------
    >>> import meshwind as mw
    >>> picture = mw.wind("data/tank.ply", paths=3, particles=51).plot(page=mw.Page(400, 300), interactive=False)
    >>> picture.image.size
    (400, 300)
    """

    png: bytes
    title: str = ""

    def __repr__(self) -> str:
        width, height = self.image.size
        return f"<meshwind Picture: {self.title}, {width} x {height}>"

    def _repr_png_(self) -> bytes:
        return self.png

    @property
    def image(self) -> Image.Image:
        """The picture for Pillow."""
        from PIL import Image

        return Image.open(io.BytesIO(self.png))

    def save(self, file: str | PathLike[str]) -> None:
        """Write the picture into a file.

        Parameters
        ----------
        file : str or PathLike
            File, of the kind that its name ends with, as in .png, .jpg, .webp or .pdf; PNG without an ending.

        Raises
        ------
        BadInputError
            If the file cannot be written, or its name ends otherwise.

        Examples
        --------
        >>> import meshwind as mw
        >>> picture = mw.wind("data/tank.ply", paths=3, particles=51).plot(page=mw.Page(400, 300), interactive=False)
        >>> picture.save("tank.png")
        """
        path = path_given(file, "file", "file for the picture")
        content = self._as(path)
        try:
            path.write_bytes(content)
        except OSError as error:
            raise BadInputError(
                f"{path} cannot be written ({error.strerror}); give a file in another folder"
            ) from error

    def _as(self, path: Path) -> bytes:
        """The picture as a file of the kind that a name ends with."""
        if path.suffix.lower() in ("", ".png"):
            return self.png
        from PIL import Image

        kind = Image.registered_extensions().get(path.suffix.lower(), "")
        if kind not in Image.SAVE:
            raise BadInputError(f"{path.name}: no pictures end with {path.suffix}; give a name with .png")
        held, image = io.BytesIO(), self.image.convert("RGBA")
        white = Image.new("RGBA", image.size, "white")  # not all kinds can be transparent
        Image.alpha_composite(white, image).convert("RGB").save(held, kind)
        return held.getvalue()
