"""Lines of shell blocks that set up a machine: compared with the project's own files, not run.

They would install into the environment of the tests, or repeat what continuous integration does anyway.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable

from blocks import ROOT

_PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
_MAKEFILE = (ROOT / "Makefile").read_text(encoding="utf-8")
_INSTALLS = re.compile(r"^make\b|\b(?:pip|conda|apt|apt-get) install\b")
_TARGETS = set(re.search(r"^\.PHONY: (.*)$", _MAKEFILE, re.MULTILINE)[1].split())  # type: ignore[index]


def _makes(match: re.Match[str]) -> bool:
    """A target of the Makefile, and each is phony: there is no file of that name."""
    return match["target"] in _TARGETS and f"\n{match['target']}:" in _MAKEFILE


def _installs(match: re.Match[str]) -> bool:
    """This project, with extras that it has."""
    extras = {extra for extra in (match["extras"] or "").split(",") if extra}
    return extras <= set(_PROJECT["optional-dependencies"])


def _is_environment(match: re.Match[str]) -> bool:
    """The environment that the Makefile makes."""
    return f"VENV ?= {match['venv']}\n" in _MAKEFILE


def _is_clone(match: re.Match[str]) -> bool:
    return match["name"] == _PROJECT["name"]


def _is_script(match: re.Match[str]) -> bool:
    """A script of the repository; those that write its pages are tested by what they write."""
    return (ROOT / match["path"]).exists()


# Pattern of a whole line, and what must hold for it.
CHECKS: list[tuple[str, Callable[[re.Match[str]], bool]]] = [
    (r"make (?P<target>[\w-]+)(?: [A-Z]+=\S+)?", _makes),
    (r"python (?P<path>(?:benchmarks|docs|tools)[\w./-]*)(?: --?[\w-]+)*", _is_script),
    (r"(?:\S*python3? -m )?pip install (?:-e )?'?\.(?:\[(?P<extras>[\w,-]+)\])?'?", _installs),
    (r"python3 -m venv (?P<venv>\S+)", _is_environment),
    (r"source (?P<venv>\S+)/bin/activate", _is_environment),
    (r"cd (?P<name>gyrify)", _is_clone),
]


def _recipe(target: str) -> list[str]:
    """Commands of gyrify that a target runs; they are run here too."""
    found = re.search(rf"^{target}:.*\n((?:\t.*\n)*)", _MAKEFILE, re.MULTILINE)
    lines = found[1].splitlines() if found else []
    return [line.strip().removeprefix("$(BIN)/") for line in lines if line.startswith("\t$(BIN)/gyrify ")]


def split(script: str) -> tuple[list[str], str]:
    """Faults of the lines that are compared, and the script without them."""
    faults, rest = [], []
    for line in script.splitlines():
        command = re.sub(r"\s+#.*", "", line).strip()
        found = [(re.fullmatch(pattern, command), check) for pattern, check in CHECKS]
        matches = [(match, check) for match, check in found if match]
        if not matches and _INSTALLS.search(command):
            faults.append(f"installs something else: {command}")
        elif not matches:
            rest.append(line)
        elif not any(check(match) for match, check in matches):
            faults.append(f"not what the project has: {command}")
        elif command.startswith("make "):
            rest += _recipe(command.split()[1])
    return faults, "\n".join(rest)
