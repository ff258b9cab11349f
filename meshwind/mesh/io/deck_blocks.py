"""Keywords of Abaqus and CalculiX decks, each with its parameters and its lines of data.

Rules: "Input Syntax Rules" of the Abaqus documentation.  Case and blanks do not matter, a keyword may be shortened,
and a keyword that ends with a comma goes on in the next line.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass

from meshwind.core.errors import BadInputError

READ = ("NODE", "ELEMENT", "PART", "END PART", "ASSEMBLY", "END ASSEMBLY", "INSTANCE", "END INSTANCE", "SYSTEM", "NGEN",
        "ELGEN", "INCLUDE")  # fmt: skip
"""Keywords that are read, or refused as they read another file."""
NOT_READ = ("NFILL", "NCOPY", "NMAP", "ELCOPY", "IMPORT", "SYMMETRIC MODEL GENERATION")
"""Keywords that make or move nodes or elements, and are not read."""
_FULL = {name.replace(" ", ""): name for name in (*READ, *NOT_READ)}
_OTHERWISE = {"NODES": "NODE", "ELEMENTS": "ELEMENT"}
"""Keywords as CalculiX also takes them."""
_SHORTEST = 4
"""Least number of letters of a keyword that is shortened."""
_LONGEST = 10_000
"""Largest number of characters of a keyword with its parameters."""
_WORD = re.compile(r"""((?:"[^"]*"|'[^']*'|[^,"']|["'])*)(?:,|$)""")


@dataclass(frozen=True)
class Block:
    """A keyword of a file, the number of its line, its parameters, and its data, which begin in line `first`."""

    file: str
    key: str
    line: int
    parameters: dict[str, str]
    data: bytes
    first: int

    def value(self, name: str) -> str | None:
        """Value of a parameter, which may be shortened to three letters; None if it is not given."""
        if name in self.parameters:
            return self.parameters[name]
        return next((text for key, text in self.parameters.items() if len(key) > 2 and name.startswith(key)), None)

    def name(self, parameter: str = "NAME") -> str:
        """Value of a parameter that is a name: in capitals and without blanks, but for one in quotation marks."""
        given = (self.value(parameter) or "").strip()
        return given[1:-1] if _is_quoted(given) else "".join(given.upper().split())

    def refusal(self, words: str) -> BadInputError:
        """Error that names the keyword and its line; words: what is wrong, and what to do."""
        return BadInputError(f"{self.file}: *{self.key} in line {self.line} {words}")


def blocks(content: bytes, file: str) -> Iterator[Block]:
    """The keywords of a deck, whose lines end with line feeds."""
    held: tuple[str, dict[str, str], int, int, int] | None = None
    line, counted = 1, 0
    for start, end, text in _keywords(content):
        if held is not None:
            key, parameters, at, first, begin = held
            yield Block(file, key, at, parameters, content[begin:start], first)
        line, counted = line + content.count(b"\n", counted, start), start
        after = line + content.count(b"\n", start, end)
        held = (*_keyword(text), line, after, end)
    if held is not None:
        key, parameters, at, first, begin = held
        yield Block(file, key, at, parameters, content[begin:], first)


def _keywords(content: bytes) -> Iterator[tuple[int, int, bytes]]:
    """Where the lines of each keyword start, where its data start, and its text."""
    at, size = 0, len(content)
    while (star := content.find(b"*", at)) >= 0:
        start = content.rfind(b"\n", at, star) + 1 or at
        at = _next_line(content, star)
        if content[start:star].strip() or content[star + 1 : star + 2] == b"*":
            continue  # a star in a line of data, or a remark
        text = content[star + 1 : min(at, star + _LONGEST)].strip()
        while text.endswith(b",") and at < size and len(text) < _LONGEST:
            end = _next_line(content, at)
            more = content[at : min(end, at + _LONGEST)].strip()
            if more and not more.startswith(b"**"):
                if not (more[:1].isalpha() or more[:1] in b"\"'"):
                    break  # numbers are data: the comma is one too many
                text += more
            at = end
        yield start, at, text


def _next_line(content: bytes, at: int) -> int:
    return content.find(b"\n", at) + 1 or len(content)


def _keyword(text: bytes) -> tuple[str, dict[str, str]]:
    """Keyword in full, and its parameters, from the text after the star."""
    words = [word.strip() for word in _WORD.findall(text.decode("utf-8", "replace"))]
    pairs = (word.partition("=") for word in words[1:] if word)
    parameters = {"".join(name.upper().split()): value.strip() for name, _, value in pairs}
    given = " ".join(words[0].upper().split())
    close = given.replace(" ", "")
    full = [name for short, name in _FULL.items() if len(close) >= _SHORTEST and short.startswith(close)]
    return _FULL.get(close) or _OTHERWISE.get(close) or (full[0] if len(full) == 1 else given), parameters


def _is_quoted(text: str) -> bool:
    return len(text) > 1 and text[0] == text[-1] and text[0] in "\"'"
