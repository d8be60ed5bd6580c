"""Text from files and names in the page of a report: shown as text, never markup."""

from __future__ import annotations

import json
from collections.abc import Callable
from html.parser import HTMLParser
from pathlib import Path
from unittest import mock

from target import Target

from gyrify.report.html import assembly

# Elements of a page with one payload, whatever the text in it.
_SCRIPTS = 3


class _Reader(HTMLParser):
    """Counts elements, and keeps the document that scripts read."""

    def __init__(self) -> None:
        super().__init__(convert_charrefs=True)
        self.tags: list[str] = []
        self.document = ""
        self._inside = False

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self._inside = tag == "script" and ("type", "application/json") in attrs

    def handle_endtag(self, tag: str) -> None:  # noqa: ARG002
        self._inside = False

    def handle_data(self, data: str) -> None:
        if self._inside:
            self.document += data


def _page(folder: Path) -> Callable[[bytes], object]:  # noqa: ARG001
    with mock.patch.object(assembly, "_joined", return_value="/* left out: the same in every page */"):
        plain = _parsed(assembly.page({"a": "b"}, {"payload-0": "AAAA"}, ("run.js",)))

    def read(data: bytes) -> None:
        text = data.decode("utf-8", "surrogateescape")
        document = {"name": text, "reason": [text, {text: text}]}
        with mock.patch.object(assembly, "_joined", return_value="/* left out: the same in every page */"):
            found = _parsed(assembly.page(document, {"payload-0": "AAAA"}, ("run.js",)))
        assert found.tags == plain.tags, "markup"
        assert found.tags.count("script") == _SCRIPTS
        assert json.loads(found.document) == document, "text"

    return read


def _parsed(text: str) -> _Reader:
    reader = _Reader()
    reader.feed(text)
    reader.close()
    return reader


TARGETS = (
    Target(
        "page",
        "`gyrify report`, text of any name or reason",
        _page,
        words=(
            b"<img src=x onerror=alert(1)>",
            b"</script>",
            b"<!--",
            b"-->",
            b"]]>",
            b"&lt;",
            b"@@",
            b"\\u003c",
        ),
    ),
)
