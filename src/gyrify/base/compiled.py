"""Numba's ``njit`` as the kernels use it: what is compiled is kept, on whatever machine this is.

Numba keeps compiled functions beside their source, or in the user's cache folder, and refuses to begin where
it can write to neither: in a container with a foreign user, in a read-only installation without a home. They
then go to a temporary folder. A cache that cannot be written or read later costs time, never a run.
"""

from __future__ import annotations

import os
import sys
import uuid
from collections.abc import Callable
from typing import Any

import numba

from gyrify.base.scratch import scratch_folder

# Numba numbers what it stores: two processes that begin at once give the same number to different functions,
# and would load each other's code. With names of its own, no process writes over what another has stored.
_PROCESS = uuid.uuid4().hex[:12]
_NO_FOLDER = "no locator"
_is_told = False


def njit(**options: Any) -> Callable[[Callable[..., Any]], Any]:
    """Compile a function when it is first called, or load it from a cache; see ``numba.njit``.

    Parameters
    ----------
    **options : object
        As those of ``numba.njit``.

    Returns
    -------
    callable
        The decorator.
    """

    def decorate(function: Callable[..., Any]) -> Any:
        _avoid_a_home_that_is_none()
        for _ in ("where numba keeps it", "elsewhere"):
            try:
                return _guarded(numba.njit(**options)(function))
            except RuntimeError as fault:
                if _NO_FOLDER not in str(fault):
                    raise
            if not _keep_elsewhere():
                break
        return numba.njit(**{**options, "cache": False})(function)

    return decorate


def overload(function: Callable[..., Any], **options: Any) -> Callable[[Callable[..., Any]], Any]:
    """Say what a function is in compiled code, by the types of its arguments; see ``numba.extending``."""
    from numba.extending import overload as numba_overload

    return numba_overload(function, **options)  # type: ignore[no-any-return]


def _avoid_a_home_that_is_none() -> None:
    """For a user without a home, numba would make a folder named ``~`` in the current one."""
    is_homeless = os.path.expanduser("~").startswith("~")
    if is_homeless and not numba.config.CACHE_DIR and not os.access(os.path.dirname(__file__), os.W_OK):
        _keep_elsewhere()


def _keep_elsewhere() -> bool:
    """Have numba keep what it compiles in the temporary folder, here and in processes begun from here."""
    folder = scratch_folder()
    if folder is None or str(folder) == numba.config.CACHE_DIR:  # not even there
        _tell("nothing compiled can be kept, and every process compiles anew (up to a minute)")
        return False
    numba.config.CACHE_DIR = os.environ["NUMBA_CACHE_DIR"] = str(folder)
    _tell(f"compiled kernels are kept in {folder}")
    return True


def _tell(what: str) -> None:
    """Say it on stderr, once in each process."""
    global _is_told
    if not _is_told:
        sys.stderr.write(
            f"gyrify: Neither the installation nor the cache folder of the user can be written: {what}. "
            "Set NUMBA_CACHE_DIR to choose a folder.\n"
        )
    _is_told = True


def _guarded(dispatcher: Any) -> Any:
    """Make the cache of a compiled function fit for many processes, and for disks that fail."""
    cache: Any = getattr(dispatcher, "_cache", None)
    file = getattr(cache, "_cache_file", None)
    if file is None:  # nothing is kept, or another numba keeps it in another way
        return dispatcher
    name_of, load, save = file._data_name, cache.load_overload, cache.save_overload

    def own_name(number: int) -> str:
        return f"{name_of(number).removesuffix('.nbc')}.{_PROCESS}.nbc"

    def load_or_none(*arguments: Any) -> Any:
        try:
            return load(*arguments)
        except Exception:  # what is damaged is compiled again
            return None

    def try_to_save(*arguments: Any) -> None:
        try:
            save(*arguments)
        except Exception:  # a full disk, or an index that is damaged
            return

    file._data_name = own_name
    cache.load_overload, cache.save_overload = load_or_none, try_to_save
    return dispatcher
