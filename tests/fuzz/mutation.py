"""Hostile inputs from good ones: bytes flipped, lines mixed, numbers and words replaced by awkward ones."""

# ruff: noqa: E501

from __future__ import annotations

import random
import re
from collections.abc import Callable, Sequence
from typing import Final

AWKWARD_NUMBERS: Final = (
    b"nan", b"inf", b"-inf", b"0", b"-0", b"-1", b"1e308", b"1e-308", b"1e999", b"4294967296", b"-9223372036854775809",
    b"18446744073709551616", b"0x7fffffffffffffff", b"9" * 400, b"1_000", b"1/0", b"1/1.36", b"1e5/1e-300", b"00", b"+5",
    b"0.1", b"2", b"100000", b"true",
)  # fmt: skip
AWKWARD_WORDS: Final = (
    b"../../escape", b"/etc/passwd", b"..", b".", b"\x00", b"\xff\xfe", b"\xed\xa0\x80", b"\xef\xbb\xbf", b"\r\n", b"\x1b[31m",
    b"\xe2\x80\xae", b"__import__('os').system('touch pwned')", b"'; DROP TABLE meta; --", b"${HOME}", b"$(touch pwned)", b"%s%n",
    b"</script><script>", b"[" * 500, b"{" * 500, b'{"a":' * 400, b"a." * 300, b"'''", b'"""', b"x" * 300, b"\xf0\x9f\xa7\xa0",
    b"{}", b"[]", b"null", b'""', b"1979-05-27T07:32:00Z", b"=", b"#", b"--", b"con", b"~root", b"file:///etc/passwd",
)  # fmt: skip
_NUMBER: Final = re.compile(rb"[-+]?\d+(?:\.\d*)?(?:[eE][-+]?\d+)?")
_WORD: Final = re.compile(rb"[A-Za-z_][\w.]*|\"[^\"\n]*\"")
LARGEST: Final = 70_000


class Mutator:
    """A source of inputs.

    Parameters
    ----------
    seeds : sequence of bytes
        Good inputs, and bad ones that once were trouble.
    seed : int
        Seed of every choice.
    words : sequence of bytes
        Words that mean something to the reader.
    """

    def __init__(self, seeds: Sequence[bytes], seed: int, words: Sequence[bytes] = ()) -> None:
        self.random = random.Random(seed)
        self.seeds, self.pool = tuple(seeds), list(seeds)
        found = {match for text in seeds for match in _WORD.findall(text) if len(match) < 80}
        self.words = (*sorted(found), *words, *AWKWARD_WORDS)
        self._ways: tuple[Callable[[bytes], bytes], ...] = (
            self._number,
            self._number,
            self._word,
            self._word,
            self._line,
            self._splice,
            self._flip,
            self._insert,
            self._cut,
            self._repeat,
        )

    def next(self) -> bytes:
        """The next input; one in fifty is noise without a model."""
        if self.random.random() < 0.02:
            return self.random.randbytes(self.random.randrange(200))
        data = self.random.choice(self.seeds if self.random.random() < 0.5 else self.pool)
        for _ in range(self.random.choice((1, 1, 1, 2, 2, 3, 5))):
            data = self.random.choice(self._ways)(data)
        return data[:LARGEST]

    def keep(self, data: bytes) -> None:
        """Build on an input that got further than others; an old one makes room."""
        if len(self.pool) < 2000:
            self.pool.append(data)
        else:
            self.pool[self.random.randrange(len(self.pool))] = data

    def _exchange(self, pattern: re.Pattern[bytes], data: bytes, choices: Sequence[bytes]) -> bytes:
        found = list(pattern.finditer(data))
        if not found:
            return self._insert(data)
        match = self.random.choice(found)
        return data[: match.start()] + self.random.choice(choices) + data[match.end() :]

    def _number(self, data: bytes) -> bytes:
        return self._exchange(_NUMBER, data, AWKWARD_NUMBERS)

    def _word(self, data: bytes) -> bytes:
        return self._exchange(_WORD, data, self.words)

    def _line(self, data: bytes) -> bytes:
        """Move, drop or double a line."""
        lines = data.split(b"\n")
        line = lines.pop(self.random.randrange(len(lines)))
        for _ in range(self.random.randrange(3)):
            lines.insert(self.random.randrange(len(lines) + 1), line)
        return b"\n".join(lines)

    def _splice(self, data: bytes) -> bytes:
        other = self.random.choice(self.pool)
        return data[: self._place(data)] + other[self._place(other) :]

    def _flip(self, data: bytes) -> bytes:
        if not data:
            return b"\x00"
        place = self.random.randrange(len(data))
        return data[:place] + bytes([data[place] ^ (1 << self.random.randrange(8))]) + data[place + 1 :]

    def _insert(self, data: bytes) -> bytes:
        place = self._place(data)
        return data[:place] + self.random.choice(self.words) + data[place:]

    def _cut(self, data: bytes) -> bytes:
        start = self._place(data)
        return data[:start] + data[start + self.random.randrange(1, 40) :]

    def _repeat(self, data: bytes) -> bytes:
        start = self._place(data)
        piece = data[start : start + self.random.randrange(1, 60)]
        return data[:start] + piece * self.random.choice((2, 3, 50)) + data[start:]

    def _place(self, data: bytes) -> int:
        return self.random.randrange(len(data) + 1)
