"""Quantile residuals of a fit, and their figure where the report has none."""

import math
from statistics import NormalDist

from .errors import InputError

_blue, _red, _grey = "#2f7fd6", "#e0592a", "#8a8f98"


def residuals(fit, kind):
    """A frame of each observation's residual, and whether it is censored."""
    import pandas

    if kind not in ("score", "cox-snell"):
        raise InputError(f"kind is {kind!r}; it is 'score' or 'cox-snell'")
    scores, censored, noun = fit._live().residuals()
    if kind == "cox-snell":
        scores = [-math.log(math.erfc(each / math.sqrt(2)) / 2) for each in scores]
    index = pandas.RangeIndex(1, len(scores) + 1, name=noun)
    return pandas.DataFrame({"residual": scores, "censored": [each == 1 for each in censored]}, index=index)


def _layer(mark, points, label, shown):
    """``shown``: labels with their colours."""
    def axis(field, title):
        return {"field": field, "type": "quantitative", "title": title, "scale": {"zero": False, "nice": True}}

    values = "\n".join(["x,y", *(f"{x:.6g},{y:.6g}" for x, y in points)])
    colour = {"datum": label, "type": "nominal", "title": None, "scale": {"domain": list(shown), "range": list(shown.values())}}
    return {"data": {"values": values, "format": {"type": "csv"}}, "mark": mark,
            "encoding": {"x": axis("x", "Standard normal quantile"), "y": axis("y", "Residual"), "color": colour}}


def residual_figure(fit):
    """Residuals against standard normal quantiles, as a figure of a report."""
    frame = residuals(fit, "score").sort_values("residual", kind="stable")
    count = len(frame)
    shift = 3 / 8 if count <= 10 else 1 / 2  # Blom; Hazen
    places = [NormalDist().inv_cdf((i - shift) / (count + 1 - 2 * shift)) for i in range(1, count + 1)]
    points = list(zip(places, frame["residual"], frame["censored"]))
    shown = {"standard normal": _grey, "observations": _red}
    if frame["censored"].any():
        shown["censored"] = _blue
    ends = [(places[0], places[0]), (places[-1], places[-1])]
    layers = [_layer({"type": "line", "strokeWidth": 2}, ends, "standard normal", shown)]
    for label, held in (("observations", False), ("censored", True)):
        of = [(x, y) for x, y, each in points if each == held]
        if of:
            mark = {"type": "point", "filled": True, "size": 50, "opacity": 1, **({"shape": "triangle-right"} if held else {})}
            layers.append(_layer(mark, of, label, shown))
    return {"id": "residuals", "title": "Quantile residuals",
            "caption": "Standard normal if the model is right; a censored one is in the middle of the probability that it leaves open.",
            "specification": {"$schema": "https://vega.github.io/schema/vega-lite/v5.json", "height": 280,
                              "description": "Quantile residuals against standard normal quantiles", "layer": layers}}
