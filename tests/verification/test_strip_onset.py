"""The strip against the exact onset of folding of a film on a half-space.

Linear triangles, alternating split, 48 columns and 12 film layers per wavelength (2 wavelengths per period,
a substrate 3 wavelengths deep in 28 layers): the critical growth stretch g must be within 1 % of theory, and
the error must fall with the square of the cell size.
"""

from __future__ import annotations

import numpy as np
import pytest
from strip_onset import THICKNESS, SmoothStrip, StripMesh, onset, strip, theory

from gyrify.theory import Bilayer

RATIOS = (1 / 1.36, 1.0, 1.54, 2.0, 3.0)


@pytest.mark.parametrize("loading", ["isotropic", "uniaxial"])
@pytest.mark.parametrize("stiffness_ratio", RATIOS)
def test_onset_is_within_one_per_cent_of_theory(stiffness_ratio: float, loading: str) -> None:
    exact = theory(stiffness_ratio, loading).load
    ours = onset(stiffness_ratio, loading, StripMesh())
    assert ours == pytest.approx(exact, rel=0.01)
    # the mesh is too stiff, never too soft; 2 % of the growth strain itself
    assert 0 < (ours - exact) / (exact - 1) < 0.02


@pytest.mark.parametrize(("stiffness_ratio", "loading"), [(1.0, "isotropic"), (3.0, "uniaxial")])
def test_error_falls_with_the_square_of_the_cell_size(stiffness_ratio: float, loading: str) -> None:
    exact = theory(stiffness_ratio, loading).load
    errors = [onset(stiffness_ratio, loading, StripMesh().refined(f)) - exact for f in (0.5, 1.0)]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.1)
    assert errors[1] - (errors[0] - errors[1]) / 3 == pytest.approx(0.0, abs=5e-4)


@pytest.mark.slow
@pytest.mark.parametrize("loading", ["isotropic", "uniaxial"])
@pytest.mark.parametrize("stiffness_ratio", RATIOS)
def test_finest_mesh(stiffness_ratio: float, loading: str) -> None:
    exact = theory(stiffness_ratio, loading).load
    assert onset(stiffness_ratio, loading, StripMesh().refined(2.0)) == pytest.approx(exact, rel=0.0015)


@pytest.mark.parametrize("waves", [2, 3])
def test_critical_mode_has_the_wavelength_of_theory(waves: int) -> None:
    """As many waves along the contour as wavelengths were put in the period, by the discrete spectrum."""
    mesh = StripMesh(columns=24, n_cortex_layers=6, n_layers=20, waves=waves)
    smooth = SmoothStrip(strip(1.54, "isotropic", mesh))
    g = smooth.onset(theory(1.54, "isotropic").load)
    vector = smooth.tangent(g).lowest().vector
    power = np.abs(np.fft.rfft(vector[smooth.problem.mesh.contour, 1]))
    assert np.argmax(power) == waves
    # the chequerboard of the alternating split repeats every two columns and mirrors the wave, faintly
    mirrored = 12 * waves - waves
    assert power[mirrored] < 0.02 * power[waves]
    assert np.delete(power, [waves, mirrored]).max() < 1e-6 * power[waves]


@pytest.mark.parametrize("depth_waves", [2.0, 4.0])
def test_the_substrate_is_deep_enough(depth_waves: float) -> None:
    """A clamp two wavelengths down is not felt any more: a wave decays by exp(-2 pi) per wavelength."""
    meshes = [StripMesh(24, 6, 18 + round(2 * d), 2, d) for d in (depth_waves, 3.0)]
    one, other = (onset(2.0, "isotropic", mesh) for mesh in meshes)
    assert one == pytest.approx(other, rel=2e-3)


@pytest.mark.parametrize("loading", ["isotropic", "uniaxial"])
def test_smooth_state_is_that_of_theory(loading: str) -> None:
    """Layers stretch across by the exact factors; linear triangles hold such a state without error."""
    g = 1.15
    bilayer = Bilayer(2.0, 0.458, loading=loading, growth_ratio=1e4)
    film, substrate = (bilayer.state(layer, g)[0][0] for layer in ("film", "substrate"))
    smooth = SmoothStrip(strip(2.0, loading, StripMesh(24, 6, 20)))
    smooth.tangent(g)
    points = smooth.problem.mesh.points
    depth = points[:, 1].max()
    expected = (substrate - 1) * np.minimum(points[:, 1], depth - THICKNESS)
    expected += (film - 1) * np.maximum(points[:, 1] - (depth - THICKNESS), 0)
    assert np.abs(smooth.u[:, 0]).max() < 1e-9
    # under "uniaxial" the substrate of the 2-D model grows in the plane, by 1e-4 of the film's strain
    atol = 1e-9 if loading == "isotropic" else 2e-5 * depth
    assert np.abs(smooth.u[:, 1] - expected).max() < atol
