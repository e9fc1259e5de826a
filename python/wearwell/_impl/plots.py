"""Plots of a fit: the figures of its report."""

import html
import json
import re

from .errors import InputError

# What people ask for, and the figures of the report that show it: the first that exists, or all that match where there is a *.
_aliases = {
    "life": ("life", "remaining-lives", "lives", "life-stress-*", "probability-paper"),
    "probability": ("probability-paper", "failure-probability"),
    "curve": ("sn-curve", "history", "path-*-0", "failure-probability", "life-stress-*", "probability-paper"),
    "hazard": ("hazard",),
    "posterior": ("belief-*",),
    "pairs": ("draws-*",),
    "residuals": ("check",),
    "paths": ("path-*",),
    "trace": ("trace-*",),
    "chains": ("chains-*",),
}
_mime = "application/vnd.vegalite.v5+json"


class Plot:
    """A picture of a fit: one figure of its report, or several side by side.

    ``Fit.plot`` makes it. As the last expression of a cell, a notebook draws it; ``Fit.plot(name, ax=ax)`` draws on
    matplotlib's axes instead.

    Attributes
    ----------
    name : str
        What was asked for.
    figures : list of str
        Names of the figures of the report that it holds.

    Examples
    --------
    >>> import wearwell as ww
    >>> fit = ww.fit("examples/joint/study.toml", seed=1)
    >>> fit.plot("posterior")
    <wearwell.Plot 'posterior': belief-k, belief-sigma>
    """

    def __init__(self, name, figures):
        self.name, self._figures = name, figures
        self.figures = [each["id"] for each in figures]

    def to_dict(self):
        """The Vega-Lite specification, for Altair and the Vega editor.

        Returns
        -------
        dict
            A specification that holds its data; several figures are concatenated.

        Examples
        --------
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/joint/study.toml", seed=1)
        >>> fit.plot("life").to_dict()["$schema"]
        'https://vega.github.io/schema/vega-lite/v5.json'
        """
        several = len(self._figures) > 1
        parts = []
        for each in self._figures:
            part = {**json.loads(json.dumps(each["specification"])), "width": 300 if several else 480, "title": each["title"]}
            part.pop("$schema", None)
            if several:  # names of parameters are those of the whole
                for layer in part["layer"]:
                    layer.pop("params", None)
            parts.append(part)
        head = {"$schema": "https://vega.github.io/schema/vega-lite/v5.json"}
        if not several:
            return {**head, **parts[0]}
        return {**head, "concat": parts, "columns": 2, "resolve": {"scale": {"color": "independent"}, "legend": {"color": "independent"}}}

    def to_html(self):
        """The pictures as HTML with SVG, without scripts.

        Returns
        -------
        str
            A figure with title and caption for each.

        Examples
        --------
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/joint/study.toml", seed=1)
        >>> "<svg" in fit.plot("life").to_html()
        True
        """
        from .svg import svg_of

        out = []
        for each in self._figures:
            caption = f"<figcaption>{html.escape(each['caption'])}</figcaption>" if each.get("caption") else ""
            out.append(f"<figure style='display:inline-block;margin:0.5em;max-width:36em'><b>{html.escape(each['title'])}</b>"
                       f"{svg_of(each['specification'], 300 if len(self._figures) > 1 else 480)}{caption}</figure>")
        return "<div>" + "".join(out) + "</div>"

    def draw(self, ax):
        """Draw on matplotlib's axes.

        Parameters
        ----------
        ax : matplotlib.axes.Axes or sequence of them
            The axes, one for each figure.

        Returns
        -------
        matplotlib.axes.Axes or sequence of them
            ``ax``.

        Raises
        ------
        InputError
            If there are fewer axes than figures, or ``ax`` is something else.

        Examples
        --------
        ``ax`` is that of ``figure, ax = matplotlib.pyplot.subplots()``:

        >>> import wearwell as ww
        >>> plot = ww.fit("examples/joint/study.toml", seed=1).plot("posterior")
        >>> try:
        ...     plot.draw([])
        ... except ww.InputError as error:
        ...     print(error)
        ax: 0 axes for the 2 figures belief-k, belief-sigma; make them with matplotlib.pyplot.subplots(1, 2)
        """
        from .matplotlib import draw

        axes = list(ax.flat) if hasattr(ax, "flat") else list(ax) if hasattr(ax, "__iter__") else [ax]
        if len(axes) < len(self._figures):
            raise InputError(f"ax: {len(axes)} axes for the {len(self._figures)} figures {', '.join(self.figures)}; make them with "
                             f"matplotlib.pyplot.subplots(1, {len(self._figures)})")
        other = next((each for each in axes if not hasattr(each, "fill_between")), None)
        if other is not None:
            raise InputError(f"ax: {type(other).__name__} is no axes of matplotlib; figure, ax = matplotlib.pyplot.subplots() makes them")
        for each, one in zip(self._figures, axes):
            draw(one, each["specification"], each["title"])
        return ax

    def _repr_mimebundle_(self, include=None, exclude=None):
        return {_mime: self.to_dict(), "text/html": self.to_html(), "text/plain": repr(self)}

    def __repr__(self):
        return f"<wearwell.Plot {self.name!r}: {', '.join(self.figures)}>"


def figures_of(report):
    """The figures of a report in their order."""
    def within(part):
        if isinstance(part, dict):
            if "specification" in part:
                yield part
            for each in part.values():
                yield from within(each)
        elif isinstance(part, list):
            for each in part:
                yield from within(each)

    found = {}
    for each in within(report["sections"]):
        found.setdefault(each["id"], each)
    return found


def names_of(figures):
    """What can be asked for: common names first, then those of the report."""
    return [alias for alias in _aliases if alias not in figures and _of_alias(figures, alias)] + list(figures)


def _of_alias(figures, alias):
    for pattern in _aliases.get(alias, ()):
        expression = re.compile(re.escape(pattern).replace(r"\*", ".*") + r"\Z")
        found = [each for name, each in figures.items() if expression.match(name)]
        if found:
            return found
    return []


def has_plot(figures, name):
    """Whether the report has a figure of this name, or one that shows what the name asks for."""
    return name in figures or bool(_of_alias(figures, name))


def plot_of(figures, name, known=None):
    if name is None:
        name = next(iter(figures), None)
    found = [figures[name]] if name in figures else _of_alias(figures, name) if isinstance(name, str) else []
    if not found:
        raise InputError(f"plot: {name!r} is not a plot of this fit; it has {', '.join(known or names_of(figures))}")
    return Plot(name, found)
