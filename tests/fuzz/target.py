"""What can be fuzzed: a name, good inputs to begin with, and a reader of bytes."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import Final

CORPUS: Final = Path(__file__).parent / "corpus"


@dataclass(frozen=True)
class Target:
    """One reader.

    Attributes
    ----------
    name : str
        What it is called; its seeds are the files of this name in the corpus.
    what : str
        What is read, for the page.
    prepare : callable
        Given an empty folder, returns the reader of one input; the reader may write below the folder only.
    around : callable
        Context in which inputs are read.
    words : tuple of bytes
        Words that mean something to the reader.
    """

    name: str
    what: str
    prepare: Callable[[Path], Callable[[bytes], object]]
    around: Callable[[], AbstractContextManager[None]] = nullcontext
    words: tuple[bytes, ...] = ()

    def seeds(self) -> list[bytes]:
        """Inputs to begin with."""
        return [file.read_bytes() for file in sorted(CORPUS.glob(f"{self.name}-*.txt"))]
