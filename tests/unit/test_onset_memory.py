"""Factors are freed with the search that made them, not by a collection of cycles some time later."""

from __future__ import annotations

import gc
import weakref

import pytest

from gyrify.config import Config
from gyrify.model.slice import Slice
from gyrify.run.onset.onset_search import OnsetSearch
from gyrify.threshold.stability_scan import StabilityScan


@pytest.fixture
def no_collection():
    """Python frees by counting references alone."""
    gc.disable()
    yield
    gc.enable()


@pytest.mark.usefixtures("no_collection")
def test_a_search_frees_its_factors(tiny: Config) -> None:
    search = OnsetSearch(Slice(tiny))
    search.follow(0.2)
    system = weakref.ref(search._lowest.system)
    del search
    assert system() is None


@pytest.mark.usefixtures("no_collection")
def test_a_scan_frees_its_factors(tiny: Config) -> None:
    scan = StabilityScan(tiny, "growth.ratio")
    scan.scan([1.2, 1.4])
    system = weakref.ref(scan._system)
    del scan
    assert system() is None
