"""Kernels that are compiled once and kept: where nothing can be written, and by many processes at once."""

from __future__ import annotations

import os
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest

from gyrify.base import scratch

# Two kinds of one function, as kernels of two elements are: numba keeps both under one name.
KERNELS = """
from gyrify.base.compiled import njit
def kernel(n):
    @njit(cache=True)
    def add(x):
        return x + n
    return add
"""


@pytest.fixture
def kernels(tmp_path: Path) -> Path:
    (tmp_path / "kernels.py").write_text(KERNELS)
    return tmp_path


def begin(folder: Path, code: str, **variables: str) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-c", textwrap.dedent(code)],
        env={
            **os.environ,
            "PYTHONPATH": f"{folder}{os.pathsep}{os.environ.get('PYTHONPATH', '')}",
            **variables,
        },
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def answer(process: subprocess.Popen[str]) -> tuple[str, str]:
    printed, said = process.communicate(timeout=300)
    assert process.returncode == 0, said
    return printed.strip(), said


def test_processes_that_begin_at_once_never_get_each_others_code(kernels: Path) -> None:
    """Both find the cache empty and number what they store; the later index meets the earlier one's code.

    They wait for one another by files: the number is chosen by both; one writes its index, the other its
    index and its code, and then the first its code.
    """
    meeting = """
        import pathlib, time
        import numba.core.caching as caching
        file = caching.IndexDataCacheFile
        save_index, save_data = file._save_index, file._save_data
        here = pathlib.Path({folder!r})
        def reach(place):
            (here / place).touch()
        def wait_for(place):
            while not (here / place).exists():
                time.sleep(0.01)
        def index(self, overloads):
            reach("{me} has chosen")
            wait_for("{other} has chosen")
            if {is_later}:
                wait_for("{other} has an index")
            save_index(self, overloads)
            reach("{me} has an index")
        def data(self, *arguments):
            if not {is_later}:
                wait_for("{other} is done")
            save_data(self, *arguments)
            reach("{me} is done")
        file._save_index, file._save_data = index, data
        import kernels
        print(kernels.kernel({me})(100))
    """
    cache = str(kernels / "cache")
    given = {"folder": str(kernels)}
    first = begin(kernels, meeting.format(me=10, other=20, is_later=False, **given), NUMBA_CACHE_DIR=cache)
    second = begin(kernels, meeting.format(me=20, other=10, is_later=True, **given), NUMBA_CACHE_DIR=cache)
    assert [answer(process)[0] for process in (first, second)] == ["110", "120"]
    again = "import kernels; print([kernels.kernel(n)(100) for n in (1, 10, 20)])"
    crowd = [begin(kernels, again, NUMBA_CACHE_DIR=cache) for _ in range(4)]
    assert {answer(process)[0] for process in crowd} == {"[101, 110, 120]"}


def test_what_is_damaged_is_compiled_again(kernels: Path) -> None:
    code, cache = "import kernels; print(kernels.kernel(1)(1))", kernels / "cache"
    assert answer(begin(kernels, code, NUMBA_CACHE_DIR=str(cache)))[0] == "2"
    files = [path for path in cache.rglob("*") if path.is_file()]
    assert len(files) == 2
    for path in files:
        path.write_bytes(path.read_bytes()[:-20])
    assert answer(begin(kernels, code, NUMBA_CACHE_DIR=str(cache)))[0] == "2"


@pytest.mark.parametrize("is_lost", [False, True], ids=["temporary folder", "nowhere"])
def test_where_numba_finds_no_folder(kernels: Path, is_lost: bool) -> None:
    """One line, and the function works; in the temporary folder, or compiled for this process alone."""
    code = f"""
        import numba.core.caching as caching
        own = caching.CacheImpl._locator_classes
        for locator in own:
            if locator.__name__.strip("_") != "UserProvidedCacheLocator" or {is_lost}:
                locator.from_function = classmethod(lambda *_: None)
        import kernels
        print(kernels.kernel(1)(1), kernels.kernel(2)(1))
        import os
        print(os.environ.get("NUMBA_CACHE_DIR"))
    """
    variables = {"NUMBA_CACHE_DIR": "", "TMPDIR": str(kernels)}
    printed, said = answer(begin(kernels, code, **variables))
    assert printed.splitlines()[0] == "2 3"
    assert said.count("\n") == 1
    if not is_lost:
        assert printed.splitlines()[1] == str(kernels / f"gyrify-{os.getuid()}")
        assert "compiled kernels are kept in" in said


def test_a_cache_that_cannot_be_written_costs_no_run(kernels: Path) -> None:
    """A full disk, or a quota that is used up, while a function is being kept."""
    code = """
        import numba.core.caching as caching
        def full(self, *_):
            raise OSError(28, "No space left on device")
        caching.IndexDataCacheFile.save = full
        import kernels
        print(kernels.kernel(1)(1))
    """
    assert answer(begin(kernels, code, NUMBA_CACHE_DIR=str(kernels / "cache")))[0] == "2"


@pytest.mark.skipif(not hasattr(os, "geteuid"), reason="permissions of POSIX")
class TestScratchFolder:
    """A folder for compiled code, which nobody else may have a hand in."""

    @pytest.fixture(autouse=True)
    def temporary(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
        monkeypatch.setattr(scratch.tempfile, "tempdir", str(tmp_path))
        scratch.scratch_folder.cache_clear()
        yield tmp_path
        scratch.scratch_folder.cache_clear()

    def test_is_the_users_alone(self, temporary: Path) -> None:
        folder = scratch.scratch_folder()
        assert folder == temporary / f"gyrify-{os.getuid()}"
        assert folder.stat().st_mode & 0o777 == 0o700

    @pytest.mark.parametrize("kind", ["writable by all", "link", "file", "of another user"])
    def test_is_another_one_where_it_might_be_tampered_with(self, temporary: Path, kind: str) -> None:
        path = temporary / f"gyrify-{os.getuid()}"
        if kind == "link":
            (temporary / "elsewhere").mkdir()
            path.symlink_to(temporary / "elsewhere")
        elif kind == "file":
            path.write_text("")
        else:
            path.mkdir()
            path.chmod(0o777 if kind == "writable by all" else 0o700)
        if kind == "of another user":
            if os.geteuid() != 0:
                pytest.skip("only the administrator can give a folder away")
            os.chown(path, 12345, 12345)
        folder = scratch.scratch_folder()
        assert folder is not None
        assert folder != path
        assert folder.stat().st_mode & 0o777 == 0o700

    def test_may_be_nowhere(self, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(scratch.tempfile, "tempdir", "/dev/null/none")
        assert scratch.scratch_folder() is None
