"""Licences and versions of everything that gyrify runs with.

    python tools/audit.py licences     licence of every run-time dependency; exit code 1 if one is not allowed
    python tools/audit.py pins         whether constraints.txt pins what is installed for the extras
    python tools/audit.py vulnerable   known vulnerabilities of the pins, by pip-audit (needs its index)

Licences are read from the metadata of the installed packages, along the dependencies of gyrify and its extras
but `test` and `docs`, which are not there when it runs.
"""

from __future__ import annotations

import argparse
import re
import subprocess
import sys
import tomllib
from collections import deque
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path
from typing import Final

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

ROOT: Final = Path(__file__).resolve().parents[1]
RUN_TIME: Final = ("fast", "export", "surface", "notebook", "cluster", "video")
ALL: Final = (*RUN_TIME, "test", "docs")
PERMISSIVE: Final = re.compile(
    r"MIT|BSD|Apache|PSF|Python Software Foundation|ISC|HPND|Zlib|CC0|MPL|Mozilla|Unlicense|Public Domain"
)
COPYLEFT: Final = re.compile(r"(?<![L])A?GPL|GNU (?:Affero )?General Public", re.IGNORECASE)
# Packages whose metadata do not settle the matter, and what does.
NAMED: Final = {
    "docutils": "public domain; the GPL of its metadata is that of an editor mode, not in the wheel",
    "imageio-ffmpeg": "BSD-2-Clause; brings an ffmpeg program under the GPL, run as its own process",
    "intel-cmplr-lib-ur": "Intel End User License Agreement (part of MKL); optional, not free software",
    "intel-openmp": "Intel End User License Agreement (part of MKL); optional, not free software",
    "ipctk": "MIT, by its repository; its metadata say nothing",
    "mkl": "Intel Simplified Software License; optional, free to use and pass on, not free software",
    "netgen-mesher": "LGPL-2.1; optional, a library of its own in its wheel",
    "netgen-occt": "LGPL-2.1 with an exception (Open CASCADE), comes with netgen-mesher; optional",
    "onemkl-license": "Intel Simplified Software License (part of MKL); optional",
    "tbb": "Apache-2.0 (oneTBB, part of MKL); optional",
    "tcmlib": "Intel Simplified Software License (part of MKL); optional",
    "umf": "Apache-2.0 WITH LLVM-exception (part of MKL); optional",
}


@dataclass(frozen=True)
class Licence:
    """One package and what its metadata say."""

    name: str
    version: str
    stated: str

    @property
    def fault(self) -> str:
        """What is wrong with it; empty for nothing."""
        if self.name in NAMED:
            return ""
        if COPYLEFT.search(self.stated):
            return "copyleft"
        return "" if PERMISSIVE.search(self.stated) else "unknown"


def stated_licence(package: metadata.Distribution) -> str:
    """Licence expression, else classifiers, else the first line of the licence field."""
    found = package.metadata.get("License-Expression")
    classifiers = [
        text.rpartition(" :: ")[2]
        for text in package.metadata.get_all("Classifier") or []
        if text.startswith("License ::") and not text.endswith("OSI Approved")
    ]
    first = (package.metadata.get("License") or "").strip().splitlines()
    return found or "; ".join(classifiers) or (first[0][:60] if first else "")


def required(extras: tuple[str, ...]) -> set[str]:
    """Names of all installed packages that gyrify needs with some extras, by its pyproject.toml."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    queue = deque(project["dependencies"])
    for extra in extras:
        queue.extend(project["optional-dependencies"][extra])
    found: dict[str, set[str]] = {}
    while queue:
        requirement = Requirement(queue.popleft())
        name, wanted = str(canonicalize_name(requirement.name)), {"", *requirement.extras}
        new = wanted - found.get(name, set())
        if not new or not _applies(requirement):
            continue
        try:
            further = map(Requirement, metadata.requires(name) or [])
        except metadata.PackageNotFoundError:
            continue  # an extra that is not installed
        found.setdefault(name, set()).update(new)
        queue.extend(_bare(item) for item in further if _applies(item, new))
    return set(found)


def _applies(requirement: Requirement, extras: Iterable[str] = ("",)) -> bool:
    """Whether a requirement holds on this machine, for one of some extras."""
    marker = requirement.marker
    return marker is None or any(marker.evaluate({"extra": extra}) for extra in extras)


def _bare(requirement: Requirement) -> str:
    """A requirement without its marker."""
    extras = f"[{','.join(sorted(requirement.extras))}]" if requirement.extras else ""
    return f"{requirement.name}{extras}"


def licences() -> Iterator[Licence]:
    """Licence of every package that gyrify may run with, in order of their names."""
    for name in sorted(required(RUN_TIME)):
        package = metadata.distribution(name)
        yield Licence(str(name), package.version, stated_licence(package))


def pins(path: Path = ROOT / "constraints.txt") -> dict[str, str]:
    """Pinned version of every package in a file of constraints."""
    lines = (line.partition("#")[0].strip() for line in path.read_text(encoding="utf-8").splitlines())
    pairs = (line.split("==") for line in lines if line)
    return {str(canonicalize_name(name)): version for name, version in pairs}


def unpinned() -> list[str]:
    """What is installed for the extras and is not pinned, or at another version."""
    pinned = pins()
    needed = {name: metadata.version(name) for name in required(ALL)}
    return [
        f"{name}: installed {version}, pinned {pinned.get(name, 'nowhere')}"
        for name, version in sorted(needed.items())
        if pinned.get(name) != version
    ]


def _vulnerable() -> int:
    command = [sys.executable, "-m", "pip_audit", "--no-deps", "--disable-pip", "-r", "constraints.txt"]
    return subprocess.run(command, cwd=ROOT, check=False).returncode


def main() -> int:
    """Run the command line."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("what", choices=("licences", "pins", "vulnerable"))
    what = parser.parse_args().what
    if what == "vulnerable":
        return _vulnerable()
    if what == "pins":
        missing = unpinned()
        print("\n".join(missing) or f"All {len(required(ALL))} packages are pinned.")
        return 1 if missing else 0
    found = list(licences())
    for item in found:
        note = NAMED.get(item.name, item.stated)
        print(f"{item.fault.upper() or 'ok':8} {item.name} {item.version}: {note}")
    wrong = [item for item in found if item.fault]
    print(f"{len(found)} packages, {len(wrong)} not allowed.")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
