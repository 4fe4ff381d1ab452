"""What charts look like: colours, papers for light and dark pages, axes without clutter. Figures without global state."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# Okabe and Ito 2008, without black and with yellow last: it is faint on white.
COLOURS = ("#0072B2", "#E69F00", "#009E73", "#D55E00", "#CC79A7", "#56B4E9", "#999999", "#F0E442")
MARKERS = "osD^vPX*"
LIGHT = {"paper": "#ffffff", "ink": "#1a1a1a", "faint": "#8a8a8a"}
DARK = {"paper": "#16181d", "ink": "#e6e6e6", "faint": "#8f949e"}


def theme_of(dark: bool) -> dict[str, str]:
    return DARK if dark else LIGHT


@cache
def _paper_figure() -> type[Figure]:
    from matplotlib import rc_context
    from matplotlib.figure import Figure

    class PaperFigure(Figure):
        """A figure whose PDF, PS and SVG hold their fonts, as papers ask: TrueType outlines (type 42) and text that stays text."""

        def savefig(self, *given: Any, **named: Any) -> None:
            with rc_context({"pdf.fonttype": 42, "ps.fonttype": 42, "svg.fonttype": "none", "pdf.use14corefonts": False}):
                super().savefig(*given, **named)

    return PaperFigure


def new_figure(size: tuple[float, float], dark: bool) -> Figure:
    return _paper_figure()(figsize=size, layout="constrained", facecolor=theme_of(dark)["paper"], dpi=120)


def dress(ax: Axes, dark: bool) -> Axes:
    theme = theme_of(dark)
    ax.set_facecolor(theme["paper"])
    ax.grid(True, which="major", color=theme["faint"], linewidth=0.5, alpha=0.35)
    ax.set_axisbelow(True)
    for side, spine in ax.spines.items():
        spine.set(color=theme["faint"], visible=side in ("left", "bottom"))
    ax.tick_params(which="both", colors=theme["ink"], labelsize=8)
    for text in (ax.xaxis.label, ax.yaxis.label, ax.title):
        text.set(color=theme["ink"], fontsize=9)
    return ax


def add_legend(figure: Figure, axes: Iterable[Axes], dark: bool, columns: int = 5) -> None:
    """Below the axes, in at most so many columns, and no more than there is room for."""
    columns = min(columns, max(1, int(figure.get_figwidth() / 1.9)))  # inches that an entry's words take
    entries = {label: handle for ax in axes for handle, label in zip(*ax.get_legend_handles_labels(), strict=True)}
    legend = figure.legend(
        entries.values(), entries.keys(), loc="outside lower center", ncols=min(len(entries), columns), frameon=False, fontsize=8
    )
    for text in legend.get_texts():
        text.set_color(theme_of(dark)["ink"])
