"""Scenes for the bad inputs of a run folder: each sets up one misfortune in the working folder."""

from __future__ import annotations

import contextlib
import functools
import json
import os
import sqlite3
import tempfile
from collections.abc import Iterator
from itertools import permutations
from pathlib import Path

from filelock import FileLock

from gyrify.config import Config
from gyrify.run.simulation import simulate

TINY = {
    "mesh.n_around": 48,
    "mesh.n_layers": 6,
    "mesh.n_cortex_layers": 2,
    "solver.increments": 8,
}
SETTINGS = tuple(word for key, value in TINY.items() for word in ("--set", f"{key}={value}"))
RUN = ("run", *SETTINGS, "--quiet", "--out")
NOBODY = 65534


@functools.cache
def journal_bytes() -> bytes:
    """Journal of a complete run; it also loads all that a run needs."""
    with tempfile.TemporaryDirectory() as folder:
        simulate(Config.preset("reference-slice").with_overrides(TINY), folder)
        return (Path(folder) / "journal.sqlite").read_bytes()


def stored(folder: Path) -> Path:
    """Put a complete run into ``run``, and return its journal."""
    journal = folder / "run" / "journal.sqlite"
    journal.parent.mkdir()
    journal.write_bytes(journal_bytes())
    return journal


def file_in_the_way(folder: Path) -> None:
    """Make ``notes.txt`` a file."""
    (folder / "notes.txt").write_text("mine")


def other_version(folder: Path) -> None:
    """Journal of a format yet to come."""
    with contextlib.closing(sqlite3.connect(stored(folder))) as connection:
        connection.execute("PRAGMA user_version = 99")


def other_program(folder: Path) -> None:
    """A database of another program."""
    (folder / "run").mkdir()
    with contextlib.closing(sqlite3.connect(folder / "run" / "journal.sqlite")) as connection:
        connection.execute("CREATE TABLE birds (name TEXT)")


def overwritten(folder: Path) -> None:
    """Text in place of the journal."""
    stored(folder).write_text("notes of the day\n" * 100)


def emptied(folder: Path) -> None:
    """A journal without a byte."""
    stored(folder).write_bytes(b"")


def truncated(folder: Path) -> None:
    """Half a journal."""
    journal = stored(folder)
    journal.write_bytes(journal_bytes()[: len(journal_bytes()) // 2])


def flip_state(folder: Path) -> None:
    """One bit of a stored displacement is another."""
    journal = stored(folder)
    with contextlib.closing(sqlite3.connect(journal)) as connection:
        query = "SELECT displacement FROM increments WHERE number = 5"
        (displacement,) = connection.execute(query).fetchone()
    flip(journal, displacement[800:816])


def flip_config(folder: Path) -> None:
    """One bit of the stored configuration is another."""
    flip(stored(folder), b"increments = 8")


def flip(file: Path, found: bytes) -> None:
    """Change the lowest bit of the last byte of something that the file holds."""
    data = bytearray(file.read_bytes())
    data[data.index(found) + len(found) - 1] ^= 1
    file.write_bytes(data)


@contextlib.contextmanager
def in_use(folder: Path) -> Iterator[None]:
    """Another process holds ``run``."""
    stored(folder)
    owner = folder / "run" / "run.owner.json"
    with FileLock(folder / "run" / "run.lock"):
        owner.write_text(json.dumps({"pid": 4242, "host": "node-7"}))
        yield


@contextlib.contextmanager
def read_only(folder: Path) -> Iterator[None]:
    """Nobody may write to ``locked``, not even the superuser."""
    journal_bytes()
    locked = folder / "locked"
    locked.mkdir(mode=0o555)
    folder.chmod(0o755)
    is_root = os.geteuid() == 0
    if is_root:
        os.seteuid(NOBODY)
    try:
        yield
    finally:
        if is_root:
            os.seteuid(0)


@contextlib.contextmanager
def full_disk(folder: Path, room: int) -> Iterator[None]:  # noqa: ARG001
    """No file of this process may grow beyond so many bytes."""
    import resource

    journal_bytes()
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (room, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


def write_tetrahedron(folder: Path, n_faces: int = 4) -> None:
    """Write a regular tetrahedron with edges of 28 mm, or some of its faces, as brain.off and surface.stl."""
    corners = [(10, 10, 10), (10, -10, -10), (-10, 10, -10), (-10, -10, 10)]
    faces = [(0, 1, 2), (0, 3, 1), (0, 2, 3), (1, 3, 2)][:n_faces]
    lines = ["OFF", f"4 {n_faces} 0", *(" ".join(map(str, point)) for point in corners)]
    (folder / "brain.off").write_text("\n".join([*lines, *("3 " + " ".join(map(str, f)) for f in faces)]))
    text = ["solid"]
    for face in faces:
        text += [
            "facet normal 0 0 0",
            "outer loop",
            *("vertex " + " ".join(map(str, corners[i])) for i in face),
        ]
        text += ["endloop", "endfacet"]
    for name in ("surface.stl", "brain.stl"):
        (folder / name).write_text("\n".join([*text, "endsolid"]) + "\n")


def write_volume(folder: Path, share: float = 1.0) -> None:
    """Write a cube of 28 mm as brain.mesh, of 27 cubes of six tetrahedra, the middle one labelled 2."""
    places = [(i, j, k) for i in range(4) for j in range(4) for k in range(4)]
    lines = ["64", *(" ".join(f"{28 * x / 3 - 14:.6f}" for x in place) for place in places), "162"]
    for low in ((i, j, k) for i in range(3) for j in range(3) for k in range(3)):
        for axes in permutations(range(3)):
            path = [list(low)]
            for axis in axes:
                path.append([x + (n == axis) for n, x in enumerate(path[-1])])
            corners = " ".join(str(places.index(tuple(place)) + 1) for place in path)
            lines.append(f"{2 if low == (1, 1, 1) else 1} {corners}")
    text = "\n".join(lines) + "\n"
    (folder / "brain.mesh").write_text(text[: int(share * len(text))])
