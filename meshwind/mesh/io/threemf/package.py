"""The package of a 3MF file: a zip archive of parts, as the Open Packaging Conventions (ECMA-376, part 2) define it."""

import posixpath
import re
import zipfile
from collections import Counter
from pathlib import Path
from typing import IO
from urllib.parse import unquote
from xml.parsers import expat

from meshwind.core.errors import BadInputError

_OLE = bytes.fromhex("d0cf11e0a1b11ae1")
"""Start of a compound file, in which an encrypted package is kept."""
_ZIP = b"PK\x03\x04"
"""Start of a ZIP archive."""
_METHODS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED, zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA)
_MAX_BYTES = 1 << 30
"""Largest unpacked size of a part."""
_CHUNK = 1 << 20
"""Bytes that are parsed at a time."""
_ROOT_TYPE = "/3dmodel"
_ENCRYPTED_TYPE = "/encryptedfile"
"""Last part of the types of relationships to the root model, and to what is encrypted (Secure Content, chapter 2)."""


class Package:
    """The parts of an archive by their names, which `plain_name` makes comparable."""

    def __init__(self, path: Path, archive: zipfile.ZipFile) -> None:
        self.file, self.archive = path.name, archive
        self.members = {plain_name(member.filename): member for member in archive.infolist()}
        self._copies = Counter(plain_name(member.filename) for member in archive.infolist())
        self.encrypted: set[str] = set()
        tables = [self._relationships(name) for name in self.members if name.endswith(".rels")]
        self.encrypted = {target for table in tables for kind, target in table if kind.endswith(_ENCRYPTED_TYPE)}

    def root(self) -> str:
        """Name of the root model part: the one that the package's relationships name (core specification, 2.1.1)."""
        named = [] if "_rels/.rels" not in self.members else self._relationships("_rels/.rels")
        roots = sorted({target for kind, target in named if kind.endswith(_ROOT_TYPE)})
        if not roots:
            roots = [name for name in self.members if name.endswith(".model")]
            roots = ["3d/3dmodel.model"] if "3d/3dmodel.model" in roots else roots
        if not roots:
            raise BadInputError(f"{self.file}: holds no 3D model; export the part as a 3MF mesh")
        if len(roots) > 1:
            raise BadInputError(
                f"{self.file}: holds {len(roots)} models, and does not name one of them as the root; export it again"
            )
        return roots[0]

    def open(self, name: str) -> IO[bytes]:
        """Open a part.  Raises BadInputError or ValueError if it is missing, too large or cannot be unpacked."""
        member = self.members.get(name)
        if member is None:
            raise ValueError(f"it refers to {name[:60]}, which it does not hold")
        if name in self.encrypted or member.flag_bits & 1:
            raise BadInputError(f"{self.file}: its part {name[:60]} is encrypted; save it without encryption")
        if member.compress_type not in _METHODS:
            raise BadInputError(
                f"{self.file}: its part {name[:60]} is compressed by the method {member.compress_type} of ZIP, "
                "which is not read; zip it again by deflate"
            )
        if self._copies[name] > 1:
            raise ValueError(f"it holds {name[:60]} {self._copies[name]} times")
        if member.file_size > _MAX_BYTES:
            raise ValueError(f"it unpacks to more than {_MAX_BYTES >> 30} GB")
        return self.archive.open(member)

    def count(self, name: str, pattern: bytes) -> int:
        """How often a pattern occurs in a part; 0 if there is no such part."""
        if name not in self.members:
            return 0
        with self.open(name) as part:
            return len(re.findall(pattern, part.read()))

    def _relationships(self, name: str) -> list[tuple[str, str]]:
        """Types and targets in a part of relationships; targets are relative to the folder above it."""
        found: list[tuple[str, str]] = []
        folder = posixpath.dirname(posixpath.dirname(name))

        def start(tag: str, attributes: dict[str, str]) -> None:
            if tag.rpartition("}")[2] == "Relationship":
                target = posixpath.normpath(posixpath.join("/", folder, attributes.get("Target", "")))
                found.append((attributes.get("Type", ""), plain_name(target)))

        parser = expat.ParserCreate(namespace_separator="}")
        parser.StartElementHandler = start
        with self.open(name) as part:
            parse(parser, part, name)
        return found


def open_archive(path: Path) -> zipfile.ZipFile:
    """The archive in a file.  Raises BadInputError if it is encrypted as a whole, or cut short."""
    with path.open("rb") as file:
        start = file.read(len(_OLE))
    if start == _OLE:
        raise BadInputError(
            f"{path.name}: is encrypted, or is a document of another kind (a compound file, where a 3MF file is a "
            "ZIP archive); save it without a password"
        )
    try:
        return zipfile.ZipFile(path)
    except zipfile.BadZipFile as error:
        if start.startswith(_ZIP):
            raise BadInputError(
                f"{path.name}: is cut short or damaged, as the end of its ZIP archive is missing; copy it again"
            ) from error
        raise


def plain_name(name: str) -> str:
    """Name of a part without its first slash, in lower case and without escapes: names do not tell these apart."""
    return unquote(name).replace("\\", "/").lstrip("/").lower()


def parse(parser: expat.XMLParserType, part: IO[bytes], name: str) -> None:
    """Parse a part by the parser's handlers.  Raises ValueError if it is no XML, or has a document type.

    The Open Packaging Conventions forbid document types; entities could make a small part endless.
    """

    def refuse(*_: object) -> None:
        raise ValueError(f"{name[:60]} has a document type, which 3MF does not allow")

    parser.StartDoctypeDeclHandler = refuse
    try:
        while chunk := part.read(_CHUNK):
            parser.Parse(chunk, False)
        parser.Parse(b"", True)
    except expat.ExpatError as error:
        raise ValueError(f"{name[:60]} is damaged: {error}") from error
