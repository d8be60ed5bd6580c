"""A short campaign: mutated and generated inputs for every reader, in seconds."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from guard import Outcome, confined, guarded, is_clear
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from mutation import Mutator
from targets import TARGETS

from gyrify.errors import ConfigError

INPUTS = {"command": 60, "history": 120}
VALUES = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=20),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=12), inner, max_size=3),
    max_leaves=6,
)


@pytest.fixture(params=TARGETS, scope="module")
def read(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple]:
    """Target, folder and reader."""
    target, folder = TARGETS[request.param], tmp_path_factory.mktemp(request.param)
    reader = target.prepare(folder)
    with target.around():
        for data in target.seeds():
            assert not guarded(reader, data, folder, limit=120.0).is_fault
        yield target, folder, reader


def test_mutated_inputs_are_read_or_refused(read: tuple) -> None:
    target, folder, reader = read
    source, kinds = Mutator(target.seeds(), 7, target.words), set()
    for _ in range(INPUTS.get(target.name, 200)):
        data = source.next()
        outcome = guarded(reader, data, folder, limit=10.0)
        assert not outcome.is_fault, (outcome, data)
        kinds.add(outcome.kind)
    assert kinds <= {"read", "refused"}
    assert len(target.seeds()) >= 2


@pytest.mark.parametrize("name", ["config", "study", "summary", "point"])
def test_generated_tables_are_read_or_refused(name: str, tmp_path: Path) -> None:
    reader = TARGETS[name].prepare(tmp_path)

    @settings(max_examples=60, deadline=None, suppress_health_check=list(HealthCheck))
    @given(st.dictionaries(st.sampled_from(("growth", "seed", "design", "base", "format", "pid")), VALUES))
    def check(table: dict[str, object]) -> None:
        data = json.dumps(table).encode()
        lines = "\n".join(f"{key} = {json.dumps(value)}" for key, value in table.items()).encode()
        for text in (data, lines):
            assert not guarded(reader, text, tmp_path, limit=10.0).is_fault

    with TARGETS[name].around():
        check()


def _raise(error: BaseException) -> None:
    raise error


@pytest.mark.parametrize(
    ("act", "kind"),
    [
        (lambda _: None, "read"),
        (lambda _: _raise(ConfigError("It is wrong.", "Mend it.")), "refused"),
        (lambda _: _raise(ConfigError("\x1b[31m red")), "message"),
        (lambda _: _raise(KeyError("x")), "crash"),
        (lambda _: _raise(MemoryError()), "memory"),
        (lambda _: [None for _ in iter(int, 1)], "hang"),
        (lambda _: Path("../outside.txt").write_text("x"), "escape"),
        (lambda _: __import__("pickle").loads(b"cos\nsystem\n."), "escape"),
        (lambda _: __import__("os").system("true"), "escape"),
    ],
)
def test_the_guard_sees_every_fault(act, kind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "in").mkdir()
    monkeypatch.chdir(tmp_path / "in")
    outcome = guarded(act, b"", tmp_path / "in", limit=0.3)
    assert isinstance(outcome, Outcome)
    assert outcome.kind == kind, outcome
    assert outcome.is_fault == (kind not in ("read", "refused"))
    assert not (tmp_path / "outside.txt").exists()


def test_waiting_is_a_hang_but_a_process_that_was_stopped_did_not_wait(tmp_path: Path) -> None:
    wakes = "import os, sys, time; time.sleep(2.5); os.kill(int(sys.argv[1]), 18)"
    waker = subprocess.Popen([sys.executable, "-c", wakes, str(os.getpid())])
    stopped = guarded(lambda _: os.kill(os.getpid(), signal.SIGSTOP), b"", tmp_path, limit=0.05)
    assert waker.wait() == 0
    assert stopped.kind == "read"
    assert (
        guarded(lambda _: [time.sleep(1.0) for _ in iter(int, 1)], b"", tmp_path, limit=0.05).kind == "hang"
    )


def test_the_guard_lets_go_afterwards(tmp_path: Path) -> None:
    with confined(tmp_path / "nowhere"), pytest.raises(PermissionError):
        (tmp_path / "x").write_text("x")
    (tmp_path / "x").write_text("x")
    assert is_clear("A plain message.")
    assert not is_clear("Traceback (most recent call last)")
