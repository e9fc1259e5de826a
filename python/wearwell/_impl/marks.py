"""Figures of the report as marks and axes: what a Vega-Lite specification of the report says, for other ways to draw it."""

import json
import math
import re
from typing import NamedTuple

_nan = float("nan")
_named = re.compile(r'abs\(datum\.value-\(([^)]*)\)\)<1e-9\?("(?:[^"\\]|\\.)*")')


class Axis(NamedTuple):
    """An axis: ``ticks`` are pairs of position and label, None where numbers are the labels."""

    title: str
    logarithmic: bool
    low: float
    high: float
    ticks: list
    numbers: bool


class Mark(NamedTuple):
    """Marks of one kind and colour; ``columns`` are lists of numbers by name."""

    kind: str
    columns: dict
    colour: str
    opacity: float
    width: float
    dashed: bool
    size: float
    shape: str
    label: str
    text: str
    steps: bool


def _columns(data):
    values = data.get("values", "")
    if not isinstance(values, str):
        return {}
    heading, *lines = values.split("\n")
    rows = [line.split(",") for line in lines]
    return {name: [float(row[i]) if row[i] else _nan for row in rows] for i, name in enumerate(heading.split(","))}


def _mark(layer):
    mark, encoding = layer["mark"], layer["encoding"]
    held = _columns(layer["data"])
    columns = {channel: held[encoding[channel]["field"]] for channel in ("x", "y", "x2", "y2", "opacity")
               if encoding.get(channel, {}).get("field") in held}
    colour = next((mark[paint] for paint in ("stroke", "fill", "color") if paint in mark), "#2f7fd6")
    label = encoding.get("color", {}).get("datum", "")
    if label:
        scale = encoding["color"]["scale"]
        colour = scale["range"][scale["domain"].index(label)]
    opacity = mark.get("opacity", 1)
    if "opacity" in columns:  # a density between the ends of its scale
        scale = encoding["opacity"]["scale"]
        (low, high), (least, most) = scale["domain"], scale["range"]
        columns["opacity"] = [least + (most - least) * min(max((each - low) / ((high - low) or 1), 0), 1) for each in columns["opacity"]]
    return Mark(mark["type"], columns, colour, opacity, mark.get("strokeWidth", 2), "strokeDash" in mark, mark.get("size", 50),
                mark.get("shape", "circle"), label, mark.get("text", ""), mark.get("interpolate") == "step-after")


def _ends(marks, channel, logarithmic):
    values = [each for mark in marks for name in (channel, channel + "2") for each in mark.columns.get(name, ())
              if math.isfinite(each) and (each > 0 or not logarithmic)]
    if any(mark.kind == "area" and channel == "y" and "y2" not in mark.columns and "x2" not in mark.columns for mark in marks) and not logarithmic:
        values.append(0.0)
    return (min(values), max(values)) if values else (1.0, 2.0)


def _axis(layers, marks, channel):
    encoding = next((layer["encoding"][channel] for layer in layers if "scale" in layer["encoding"].get(channel, {})), {})
    scale, axis = encoding.get("scale", {}), encoding.get("axis", {}) or {}
    logarithmic = scale.get("type") == "log"
    low, high = scale.get("domain") or _ends(marks, channel, logarithmic)
    low, high = scale.get("domainMin", low), scale.get("domainMax", high)
    if not high > low:
        low, high = (low / 2, low * 2) if logarithmic else (low - 0.5, low + 0.5)
    ticks = None
    expression = axis.get("labelExpr", "")
    if expression.startswith("["):
        names = json.loads(expression[:expression.rindex("[datum.value")])
        ticks = [(i + 1.0, name) for i, name in enumerate(names)]
    elif expression:
        ticks = sorted((float(at), json.loads(label)) for at, label in _named.findall(expression))
    return Axis(encoding.get("title") or "", logarithmic, low, high, ticks, axis.get("labels", True))


def marks_of(specification):
    """(marks, x axis, y axis) of one figure."""
    layers = [layer for layer in specification["layer"] if layer["encoding"]]
    marks = [_mark(layer) for layer in layers]
    return marks, _axis(layers, marks, "x"), _axis(layers, marks, "y")


def ticks_of(axis, most=6):
    """Positions and labels of an axis."""
    if not axis.numbers:
        return []
    if axis.ticks is not None:
        return [(at, label) for at, label in axis.ticks if axis.low <= at <= axis.high]
    if axis.logarithmic:
        first, last = math.floor(math.log10(axis.low)), math.ceil(math.log10(axis.high))
        digits = (1, 2, 5) if last - first <= 3 else (1,)
        places = [digit * 10.0**power for power in range(first, last + 1, max(1, (last - first) // most)) for digit in digits]
    else:
        rough = (axis.high - axis.low) / most
        power = 10.0**math.floor(math.log10(rough))
        step = next(digit * power for digit in (1, 2, 5, 10) if digit * power >= rough)
        places = [i * step for i in range(math.ceil(axis.low / step - 1e-9), math.floor(axis.high / step + 1e-9) + 1)]
    return [(at, number_text(at)) for at in places if axis.low * (1 - 1e-9) <= at <= axis.high * (1 + 1e-9) or axis.low <= at <= axis.high]


def number_text(value):
    """A number of an axis: 10⁶, not 1e+06."""
    if value == 0 or 1e-3 <= abs(value) < 1e5:
        return f"{value:.6g}"
    digits, power = f"{value:.5e}".split("e")
    raised = "".join("⁻" if each == "-" else "⁰¹²³⁴⁵⁶⁷⁸⁹"[int(each)] for each in str(int(power)))
    digits = f"{float(digits):g}"
    return f"10{raised}" if digits == "1" else f"{digits}×10{raised}"
