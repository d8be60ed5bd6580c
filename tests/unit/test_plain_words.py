"""Messages are in plain English: no phrase that readers have stumbled over, anywhere in the package."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import gyrify

SOURCE = Path(gyrify.__file__).parent
# What readers of English as a second language did not follow, and words like it.
UNCLEAR = (
    r"\bis none\b",
    r"\bnone of (a|the mesh)\b",
    r"without a word",
    r"\bfor want of\b",
    r"\b(is|are) no (?!longer|way|kind)\w+ of (a|the)\b",
    r"\bby degrees\b",
    r"\bthere twice\b",
    r"\bMind that\b",
    r"\b[Mm]end\b",
    r"\bknows? no\b",
    r"\bof no known\b",
)


def messages(file: Path) -> list[str]:
    """Texts of a file that are neither documentation nor a part of another text."""
    tree = ast.parse(file.read_text(encoding="utf-8"))
    left_out = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            left_out.add(id(node.value))
        if isinstance(node, ast.JoinedStr):
            left_out |= {id(value) for value in node.values}
    found = []
    for node in ast.walk(tree):
        if id(node) in left_out:
            continue
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            found.append(node.value)
        if isinstance(node, ast.JoinedStr):
            parts = (value.value if isinstance(value, ast.Constant) else "…" for value in node.values)
            found.append("".join(map(str, parts)))
    return found


def test_no_message_has_words_that_readers_stumbled_over() -> None:
    all_messages = {file: messages(file) for file in SOURCE.rglob("*.py")}
    assert sum(map(len, all_messages.values())) > 1000
    unclear = [
        f"{file.relative_to(SOURCE)}: {text}"
        for file, texts in all_messages.items()
        for text in texts
        for pattern in UNCLEAR
        if re.search(pattern, text)
    ]
    assert unclear == []


def test_such_words_are_seen(tmp_path: Path) -> None:
    file = tmp_path / "bad.py"
    file.write_text('"""is none of a run."""\nraise ValueError(f"Increment {1} is none of a run.")\n')
    (text,) = messages(file)
    assert text == "Increment … is none of a run."
    assert any(re.search(pattern, text) for pattern in UNCLEAR)
