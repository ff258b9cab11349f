"""Keywords of Abaqus and CalculiX decks, each with its parameters and its lines of data.

Rules: "Input Syntax Rules" of the Abaqus documentation.  Case and blanks do not matter, a keyword may be shortened,
and a keyword that ends with a comma goes on in the next line.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property, lru_cache

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
    """A keyword of a file, the number of its line, its text with the parameters, and its data, from line `first` on."""

    file: str
    key: str
    line: int
    text: bytes
    data: bytes
    first: int

    @cached_property
    def parameters(self) -> dict[str, str]:
        """Values of the parameters by their names in capitals; "" for one without a value."""
        words = [word.strip() for word in _WORD.findall(_printable(self.text))]
        pairs = (word.partition("=") for word in words[1:] if word)
        return {"".join(name.upper().split()): value.strip() for name, _, value in pairs}

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
    found = _keywords(content)
    now = next(found, None)
    line, counted = 1, 0
    while now is not None:
        start, begin, text = now
        now = next(found, None)
        line += content.count(b"\n", counted, start)
        first = line + content.count(b"\n", start, begin)
        data = content[begin : len(content) if now is None else now[0]]
        yield Block(file, _full(text.partition(b",")[0]), line, text, data, first)
        line, counted = first, begin


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


@lru_cache(1000)
def _full(word: bytes) -> str:
    """Keyword in full and in capitals."""
    given = " ".join(_printable(word).upper().split())
    close = given.replace(" ", "")
    full = [name for short, name in _FULL.items() if len(close) >= _SHORTEST and short.startswith(close)]
    return _FULL.get(close) or _OTHERWISE.get(close) or (full[0] if len(full) == 1 else given)


def _printable(text: bytes) -> str:
    """Text whose tabs and other characters that cannot be printed are blanks."""
    given = text.decode("utf-8", "backslashreplace")
    return given if given.isprintable() else "".join(each if each.isprintable() else " " for each in given)


def _is_quoted(text: str) -> bool:
    return len(text) > 1 and text[0] == text[-1] and text[0] in "\"'"
