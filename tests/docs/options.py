"""Commands that cannot be run in a test: they and their options must exist at least."""

from __future__ import annotations

import shlex

import install_lines
from cyclopts import App

from gyrify.cli.app import app


def unknown_options(script: str) -> list[str]:
    """Commands and options of gyrify in a script that there are not, and lines that fail their check."""
    unknown, rest = install_lines.split(script.replace("\\\n", " "))
    for line in rest.splitlines():
        words = shlex.split(line, comments=True)
        if "gyrify" in words:
            unknown += _unknown(words[words.index("gyrify") + 1 :])
    return unknown


def _unknown(words: list[str]) -> list[str]:
    command, names = app, []
    while words and words[0] in command and not words[0].startswith("-"):
        names.append(words[0])
        command = command[words.pop(0)]
    if not names and words[:1] in (["--version"], ["--help"]):
        return []
    if not names:
        return [f"gyrify {' '.join(words[:1])}"]
    used = [word.partition("=")[0] for word in words if word.startswith("--")]
    return [f"gyrify {' '.join(names)} {option}" for option in used if option not in _options(command)]


def _options(command: App) -> set[str]:
    return {name for argument in command.assemble_argument_collection() for name in argument.names}
