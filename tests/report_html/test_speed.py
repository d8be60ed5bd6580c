"""What a standard run costs a reader: bytes, time to the first paint, frames per second without a GPU."""

from __future__ import annotations

import pytest

from gyrify.config import Config
from gyrify.report.html import run_page
from gyrify.run.simulation import simulate

# Draws frame after frame as fast as it can, and waits each time until the pixels are there.
FRAMES_PER_SECOND = """() => {
  const { viewer, model } = gyrify.panel;
  const { gl } = viewer;
  const pixel = new Uint8Array(4);
  const n = 90;
  const start = performance.now();
  for (let k = 0; k < n; k += 1) {
    viewer.state.frame = k % model.nFrames;
    viewer.drawNow();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
  }
  return (1000 * n) / (performance.now() - start);
}"""
FIRST_PAINT = "performance.getEntriesByName('first-contentful-paint')[0].startTime"


@pytest.mark.slow
def test_a_standard_run_is_small_and_quick(browser, record_property) -> None:
    text = run_page(simulate(Config.preset("reference-slice")), "standard run")
    record_property("bytes", len(text))
    assert len(text) <= 3_000_000
    paints, rates = [], []
    for _ in range(3):  # the best of three: other processes must not decide
        opened = browser.open(text)
        opened.wait("performance.getEntriesByName('first-contentful-paint').length > 0")
        paints.append(opened.run(FIRST_PAINT))
        opened.run(f"({FRAMES_PER_SECOND})()")  # compiles the shaders, and decodes the fields
        rates.append(opened.run(f"({FRAMES_PER_SECOND})()"))
    record_property("first paint [ms]", min(paints))
    record_property("frames per second", max(rates))
    print(f"{len(text)} bytes, first paint {min(paints):.0f} ms, {max(rates):.0f} frames per second")
    assert min(paints) < 1000.0
    assert max(rates) >= 30.0


# The same while the scene turns, whole or cut open.
TURNS_PER_SECOND = """() => {
  const { viewer } = gyrify.panel;
  const pixel = new Uint8Array(4);
  const n = 60;
  const start = performance.now();
  for (let k = 0; k < n; k += 1) {
    viewer.camera.turn(3, 0);
    viewer.drawNow();
    viewer.gl.readPixels(0, 0, 1, 1, viewer.gl.RGBA, viewer.gl.UNSIGNED_BYTE, pixel);
  }
  return (1000 * n) / (performance.now() - start);
}"""
BRAIN = {
    "geometry.shape": "ellipsoid",
    "geometry.semi_axes": (36.0, 30.0, 24.0),
    "geometry.hole_fraction": 0.0,
    "geometry.cortical_thickness": 1.5,
    "mesh.edge_length": 2.8,
    "mesh.n_layers": 8,
    "mesh.n_cortex_layers": 2,
    "mesh.element": "mean_dilatation",
    "growth.law": "area",
    "growth.profile": "sigmoid",
    "growth.rate": 0.003658,
    "growth.ratio": 1e4,
    "material.stiffness_ratio": 0.857,
    "dissipation.number": 0.2,
    "solver.increments": 50,
    "stability.detect": False,
}


@pytest.mark.slow
def test_a_brain_of_40_000_tetrahedra_is_small_and_turns_smoothly(browser, record_property) -> None:
    history = simulate(Config().with_overrides(BRAIN))
    assert history.mesh.n_cells > 40_000
    text = run_page(history, "brain")
    record_property("bytes", len(text))
    assert len(text) <= 6_000_000
    opened = browser.open(text)
    assert opened.run("gyrify.panel.model.nFrames") == 51
    for axis in ("whole", "x"):
        opened.run(f"document.querySelector('.cut-bar input[value={axis}]').click()")
        rates = [opened.run(f"({TURNS_PER_SECOND})()") for _ in range(4)]
        record_property(f"turns per second, cut: {axis}", max(rates))
        print(f"{len(text)} bytes, cut {axis}: {max(rates):.0f} frames per second")
        assert max(rates) >= 30.0
