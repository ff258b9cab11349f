"""Text of mesh files: byte order marks, line ends, and the unit in a header that meshwind writes."""

import codecs
import re
from pathlib import Path

_OWN = re.compile(rb"lengths in (mm|cm|m|um|inch|in|ft)\b")
_OWN_WORDS = (b"meshwind", b"of a winding", b"quad mesh on the crossings")
"""Words of the headers of meshwind's own files."""
_END_OF_FILE = b"\x1a"
"""Byte after which programs of DOS and Windows take a text to end."""
_HEADER = 400
"""Length of the part of a file in which meshwind names the unit."""


def text_of(path: Path) -> bytes:
    """Content of a text file in UTF-8, its lines ended by line feeds only."""
    return plain_text(path.read_bytes())


def plain_text(content: bytes) -> bytes:
    """A text in UTF-8, its lines ended by line feeds only, without a mark of its end."""
    if content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        content = content.decode("utf-16").encode()
    content = content.removeprefix(codecs.BOM_UTF8).removesuffix(_END_OF_FILE)
    return content.replace(b"\r\n", b"\n").replace(b"\r", b"\n") if b"\r" in content else content


def own_unit(content: bytes) -> str:
    """Unit of length that the header of a file of meshwind's own names, "" if there is none."""
    head = content[:_HEADER]
    found = _OWN.search(head) if any(words in head for words in _OWN_WORDS) else None
    return found[1].decode() if found else ""
