"""The page on the architecture is what the code is."""

from __future__ import annotations

import re
from pathlib import Path

from test_imports import IMPORTS, LAYERS, SOURCE, layer

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")


def rows() -> dict[str, set[str]]:
    """What each package imports, as the page has it, in its order."""
    table = re.search(r"<!-- packages -->\n(.*?)<!-- end -->", PAGE, re.DOTALL)
    assert table is not None
    lines = [line.split("|") for line in table[1].splitlines() if line.startswith("| `")]
    return {cells[1].strip().strip("`"): set(re.findall(r"`(\w+)`", cells[3])) for cells in lines}


def test_every_package_stands_on_the_page_in_the_order_of_the_layers() -> None:
    places = {path.stem for path in SOURCE.iterdir() if path.stem not in ("__init__", "py", "__pycache__")}
    told = list(rows())
    assert set(told) == places == set.union(*LAYERS)
    assert [layer(name) for name in told] == sorted(layer(name) for name in told)


def test_what_a_package_imports_is_what_the_page_says() -> None:
    found: dict[str, set[str]] = {name: set() for name in rows()}
    for i in IMPORTS:
        if i.importer not in ("gyrify", i.imported) and i.imported != "gyrify":
            found[i.importer].add(i.imported)
    told = rows()
    told["cli"] = found["cli"]
    assert told == found


def test_lists_and_examples_that_it_names_are_there() -> None:
    for path, name in re.findall(r"`([\w/]+\.py)`, `([A-Z]+)`", PAGE):
        assert re.search(rf"^{name}: Final", (SOURCE / path).read_text(encoding="utf-8"), re.MULTILINE)
    examples = re.findall(r"`(examples/\w+\.py)`", PAGE)
    assert len(examples) >= 3
    for path in examples:
        text = (ROOT / path).read_text(encoding="utf-8")
        assert len(text.splitlines()) <= 60
