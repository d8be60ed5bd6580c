"""Pictures of the exact onset: neutral and critical curves of the bilayer, and of the growing annulus."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from gyrify.theory.annulus import Annulus, base_state
from gyrify.theory.half_space import (
    Bilayer,
    Loading,
    asymptotic_wrinkle,
    critical_surface,
    critical_wrinkle,
    neutral_curve,
)
from gyrify.theory.margin import scaled
from gyrify.theory.mode_numbers import dispersion
from gyrify.theory.onset import stability_map

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# Okabe and Ito's colours without yellow, told apart by every common colour vision.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#000000")
STYLES = ("-", "--", "-.", ":")
_LOADING_NAMES = {
    "compression": "whole bilayer compressed",
    "uniaxial": "film grows along x",
    "isotropic": "film grows in all directions, z blocked",
    "plane": "film grows in the plane",
    "tangential": "film grows along x and z, z blocked",
}


def _figure(columns: int, width: float = 5.2, height: float = 3.9) -> tuple[Figure, list[Axes]]:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width * columns, height), layout="constrained")
    panels = list(figure.subplots(1, columns, squeeze=False)[0])
    for axes in panels:
        axes.spines[["top", "right"]].set_visible(False)
        axes.grid(True, color="0.92", linewidth=0.7)
        axes.set_axisbelow(True)
    return figure, panels


def ratio_name(ratio: float) -> str:
    """A ratio written the shorter way, as 1/1.36 or as 1.54."""
    inverse = float(Fraction(1.0 / ratio).limit_denominator(1000))
    return min(f"1/{inverse:g}", f"{ratio:g}", key=len)


def neutral_curves(stiffness_ratios: Sequence[float], bilayer: Bilayer | None = None) -> Figure:
    """Critical load of each wave on a bilayer, its minimum marked, with the surface limit.

    Parameters
    ----------
    stiffness_ratios : sequence of float
        Film / substrate [-]; one curve each, at most seven.
    bilayer : Bilayer, optional
        The other parameters; an incompressible film that grows in all directions by default.

    Returns
    -------
    Figure
        Load g against k h.
    """
    bilayer = Bilayer() if bilayer is None else bilayer
    figure, (axes,) = _figure(1, width=6.4)
    waves = np.geomspace(0.05, 8.0, 90)
    for colour, ratio in zip(COLOURS, stiffness_ratios, strict=False):
        case = replace(bilayer, stiffness_ratio=ratio)
        axes.plot(waves, neutral_curve(case, waves), color=colour, label=ratio_name(ratio))
        first = critical_wrinkle(case)
        if not first.at_edge:
            axes.plot(first.scaled_thickness, first.load, "o", color=colour, markersize=5)
    surface = critical_surface(bilayer).load
    axes.axhline(surface, color="0.3", linestyle=":")
    axes.text(waves[-1], surface, "surface limit ", ha="right", va="bottom", color="0.3", fontsize=9)
    axes.set(xscale="log", xlim=(waves[0], waves[-1]), ylim=(1.0, 1.0 + 1.25 * (surface - 1.0)))
    axes.set_xlabel("wave number × film thickness, reference  k h  [–]")
    axes.set_ylabel("critical load  g  [–]")
    axes.set_title(f"Neutral curves: {_LOADING_NAMES[bilayer.loading]}", fontsize=10)
    axes.legend(title="film / substrate stiffness", fontsize=8, title_fontsize=8, loc="lower right", ncols=2)
    return figure


def critical_curves(
    stiffness_ratios: Sequence[float], poisson_ratios: Sequence[float] = (0.5, 0.458)
) -> Figure:
    """Critical compression and wavelength of a bilayer against the stiffness ratio.

    Parameters
    ----------
    stiffness_ratios : sequence of float
        Film / substrate [-], increasing.
    poisson_ratios : sequence of float
        nu [-]; one line style each, at most four.

    Returns
    -------
    Figure
        Compression 1 - 1/g, and wavelength / film thickness, for three loadings.
    """
    figure, (left, right) = _figure(2, height=4.8)
    loadings: tuple[Loading, ...] = ("compression", "uniaxial", "isotropic")
    for colour, loading in zip(COLOURS, loadings, strict=False):
        for style, nu in zip(STYLES, poisson_ratios, strict=False):
            onsets = [critical_wrinkle(Bilayer(ratio, nu, loading=loading)) for ratio in stiffness_ratios]
            name = f"{_LOADING_NAMES[loading]}, ν = {nu:g}"
            left.plot(stiffness_ratios, [w.strain for w in onsets], style, color=colour, label=name)
            length = [np.nan if w.at_edge else w.wavelength for w in onsets]
            right.plot(stiffness_ratios, length, style, color=colour)
    limits = [asymptotic_wrinkle(ratio) for ratio in stiffness_ratios]
    left.plot(stiffness_ratios, [w.strain for w in limits], ":", color="0.3", label="large-contrast limit")
    right.plot(stiffness_ratios, [w.wavelength for w in limits], ":", color="0.3")
    for axes in (left, right):
        axes.set(xscale="log", yscale="log", xlim=(stiffness_ratios[0], stiffness_ratios[-1]))
        axes.set_xlabel("film / substrate stiffness  [–]")
        axes.xaxis.set_major_formatter("{x:g}")
        axes.yaxis.set_minor_formatter("")
    left.set_ylim(top=0.7)
    for axes, ticks in ((left, (0.01, 0.02, 0.05, 0.1, 0.2, 0.5)), (right, (3, 5, 10, 20))):
        axes.set_yticks(ticks, labels=[f"{tick:g}" for tick in ticks])
    left.set_ylabel("critical compression  1 − 1/g  [–]")
    right.set_ylabel("wavelength / film thickness, deformed  [–]")
    figure.legend(*left.get_legend_handles_labels(), loc="outside lower center", fontsize=8, ncols=2)
    return figure


def annulus_dispersion(annulus: Annulus, growth_times: Sequence[float], last_mode: int = 60) -> Figure:
    """Stability of the annulus against each mode at several growth times.

    Parameters
    ----------
    annulus : Annulus
        The parameters.
    growth_times : sequence of float
        t [time]; one curve each, at most seven.
    last_mode : int
        Highest mode number n.

    Returns
    -------
    Figure
        Scaled lowest eigenvalue against n.
    """
    figure, (axes,) = _figure(1, width=6.4)
    modes = np.arange(2, last_mode + 1)
    for colour, time in zip(COLOURS, growth_times, strict=False):
        curve = scaled(annulus, dispersion(annulus, time, modes), modes)
        axes.plot(modes, curve, color=colour, label=f"{time:g}")
    axes.axhline(0.0, color="0.3", linewidth=1.0)
    axes.set(xlim=(modes[0], modes[-1]), ylim=(-1.6, 3.0))
    axes.set_xlabel("mode number  n  [–]")
    axes.set_ylabel("lowest eigenvalue / μ (n / outer radius)²  [–]")
    stiffness = ratio_name(annulus.stiffness_ratio)
    axes.set_title(
        f"Annulus, stiffness ratio {stiffness}, growth ratio {annulus.growth_ratio:g}", fontsize=10
    )
    axes.legend(title="growth time", fontsize=8, title_fontsize=8, loc="upper right")
    return figure


def annulus_neutral_curves(
    annulus: Annulus,
    stiffness_ratios: Sequence[float],
    surface_ratios: Mapping[float, float],
    growth_ratios: Sequence[float],
) -> Figure:
    """Critical growth ratio of each mode at the final growth time.

    Parameters
    ----------
    annulus : Annulus
        The other parameters.
    stiffness_ratios : sequence of float
        Cortex / white matter [-]; one curve each, at most seven.
    surface_ratios : mapping from float to float
        Critical growth ratio of the surface limit by stiffness ratio [-], where it comes first.
    growth_ratios : sequence of float
        Growth ratios scanned [-].

    Returns
    -------
    Figure
        Growth ratio against n.
    """
    from matplotlib.lines import Line2D

    figure, (axes,) = _figure(1, width=6.4)
    modes = np.unique(np.geomspace(3, 120, 45).round().astype(int))
    handles = []
    for colour, ratio in zip(COLOURS, stiffness_ratios, strict=False):
        case = replace(annulus, stiffness_ratio=ratio)
        margin = stability_map(case, "growth_ratio", growth_ratios, modes.tolist())
        axes.contour(modes, growth_ratios, margin, levels=[0.0], colors=[colour])
        handles.append(Line2D([], [], color=colour, label=ratio_name(ratio)))
        if ratio in surface_ratios:
            axes.axhline(surface_ratios[ratio], color=colour, linestyle=":")
    if surface_ratios:
        handles.append(Line2D([], [], color="0.3", linestyle=":", label="surface limit"))
    axes.set(xscale="log", xlim=(3, 120), ylim=(growth_ratios[0], growth_ratios[-1]))
    axes.set_xticks([3, 5, 10, 20, 50, 100], labels=["3", "5", "10", "20", "50", "100"])
    axes.minorticks_off()
    axes.set_xlabel("mode number  n  [–]")
    axes.set_ylabel("critical growth ratio  [–]")
    axes.set_title(f"Annulus at growth time {annulus.duration:g}: unstable above each curve", fontsize=10)
    figure.legend(
        handles=handles, title="stiffness ratio", fontsize=8, title_fontsize=8, loc="outside right center"
    )
    return figure


def base_states(annulus: Annulus, growth_times: Sequence[float]) -> Figure:
    """Displacement and elastic hoop stretch of the smooth annulus across its wall.

    Parameters
    ----------
    annulus : Annulus
        The parameters.
    growth_times : sequence of float
        t [time]; one curve each, at most seven.

    Returns
    -------
    Figure
        r - R [mm] and (r/R) / growth stretch [-] against R [mm].
    """
    figure, (left, right) = _figure(2)
    places = np.linspace(annulus.inner_radius, annulus.outer_radius, 601)
    for colour, time in zip(COLOURS, growth_times, strict=False):
        state = base_state(annulus, time)
        left.plot(places, state.radius(places) - places, color=colour, label=f"{time:g}")
        elastic = state.stretches(places)[:, 1] / annulus.growth(places, time)[:, 1]
        right.plot(places, elastic, color=colour)
    for axes in (left, right):
        axes.axvline(annulus.interface_radius, color="0.5", linewidth=0.8, linestyle="--")
        axes.set_xlim(places[0], places[-1])
        axes.set_xlabel("reference radius  R  [mm]")
        axes.text(
            annulus.interface_radius, 0.02, "interface ", transform=axes.get_xaxis_transform(), ha="right"
        )
    left.set_ylabel("displacement  r − R  [mm]")
    right.set_ylabel("elastic hoop stretch  [–]")
    left.legend(title="growth time", fontsize=8, title_fontsize=8, loc="upper left")
    return figure
