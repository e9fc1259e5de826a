"""Figures on matplotlib axes."""

import math

from .marks import marks_of, ticks_of

_symbols = {"triangle-right": ">", "triangle-left": "<"}


def _held(columns):
    count = len(next(iter(columns.values()), ()))
    rows = [i for i in range(count) if all(math.isfinite(column[i]) for column in columns.values())]
    return {name: [column[i] for i in rows] for name, column in columns.items()}


def _draw(ax, mark, order):
    columns = _held(mark.columns)
    if not columns or not next(iter(columns.values())):
        return
    style = {"color": mark.colour, "alpha": mark.opacity, "label": mark.label or None, "zorder": 2 + 0.01 * order}
    points = 0.75  # of a pixel
    line = {**style, "linewidth": mark.width * points, "linestyle": "--" if mark.dashed else "-"}
    if mark.kind == "line":
        ax.plot(columns["x"], columns["y"], **line, drawstyle="steps-post" if mark.steps else "default")
    elif mark.kind == "area" and "x2" in columns:
        ax.fill_betweenx(columns["y"], columns["x2"], columns["x"], **style, linewidth=0)
    elif mark.kind == "area":
        ax.fill_between(columns["x"], columns["y"], columns.get("y2", 0), **style, linewidth=0)
    elif mark.kind == "point":
        ax.scatter(columns["x"], columns["y"], s=mark.size * points**2, marker=_symbols.get(mark.shape, "o"), **style)
    elif mark.kind == "rule" and "y2" in columns:
        ax.vlines(columns["x"], columns["y"], columns["y2"], **{**line, "colors": line.pop("color")})
    elif mark.kind == "rule" and "x" in columns:
        for i, at in enumerate(columns["x"]):
            ax.axvline(at, **{**line, "label": line["label"] if i == 0 else None})
    elif mark.kind == "rule":
        for i, at in enumerate(columns["y"]):
            ax.axhline(at, **{**line, "label": line["label"] if i == 0 else None})
    elif mark.kind == "rect":
        _cells(ax, columns, mark, style)
    elif mark.kind == "text":
        for x, y in zip(columns["x"], columns["y"]):
            ax.annotate(mark.text, (x, y), xytext=(-5, 4), textcoords="offset points", ha="right", color=mark.colour)


def _cells(ax, columns, mark, style):
    """Rectangles, each with its own opacity where it is a density."""
    opacity = columns.get("opacity")
    bottoms = columns.get("y2", [0.0] * len(columns["x"]))
    widths = [b - a for a, b in zip(columns["x"], columns.get("x2", columns["x"]))]
    heights = [top - bottom for top, bottom in zip(columns["y"], bottoms)]
    for_each = {k: v for k, v in style.items() if k not in ("alpha", "color")}
    colours = [(mark.colour, each) for each in opacity] if opacity else None
    if colours:
        from matplotlib.colors import to_rgba

        ax.bar(columns["x"], heights, widths, bottoms, align="edge", color=[to_rgba(*each) for each in colours], linewidth=0, **for_each)
    else:
        ax.bar(columns["x"], heights, widths, bottoms, align="edge", **style, linewidth=0)


def draw(ax, specification, title):
    """One figure on these axes."""
    marks, across, up = marks_of(specification)
    for order, mark in enumerate(marks):  # in the order of the figure, whatever their kind
        _draw(ax, mark, order)
    for axis, name in ((across, "x"), (up, "y")):
        if axis.logarithmic:
            getattr(ax, f"set_{name}scale")("log")
        getattr(ax, f"set_{name}lim")(axis.low, axis.high)
        getattr(ax, f"set_{name}label")(axis.title)
        if axis.ticks is not None or axis.logarithmic or not axis.numbers:
            getattr(ax, f"set_{name}ticks")([], minor=True)
            found = ticks_of(axis)
            getattr(ax, f"set_{name}ticks")([at for at, _ in found])
            getattr(ax, f"set_{name}ticklabels")([label for _, label in found])
    ax.set_title(title)
    if any(mark.label for mark in marks):
        ax.legend(frameon=False)
