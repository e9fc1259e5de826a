"""Figures as SVG: pictures that any viewer of a notebook shows, without scripts and without a network."""

import html
import json
import math
import zlib

from .marks import marks_of, ticks_of

_left, _right, _top, _bottom = 64, 14, 28, 46
_ink, _soft, _faint = "#1d2733", "#5a6572", "#e3e7ec"


def _places(axis, low, high):
    def at(value):
        if axis.logarithmic:
            share = math.log(value / axis.low) / math.log(axis.high / axis.low) if value > 0 else _nowhere
        else:
            share = (value - axis.low) / (axis.high - axis.low)
        return low + min(max(share, -9), 9) * (high - low)

    return at


_nowhere = -9  # of a logarithmic axis


def _text(x, y, words, anchor="middle", size=11, colour=_soft, turn=""):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" font-size="{size}" fill="{colour}"{turn}>{html.escape(words)}</text>'


def _path(points, closed=False):
    return " ".join(f"{'L' if i else 'M'}{x:.1f} {y:.1f}" for i, (x, y) in enumerate(points)) + (" Z" if closed else "")


def _drawn(mark, x, y, width, height):
    """The marks of one kind."""
    columns = mark.columns
    paint = f'stroke="{mark.colour}" stroke-width="{mark.width:g}"' + (' stroke-dasharray="6 4"' if mark.dashed else "")
    count = len(next(iter(columns.values()), ()))
    held = [i for i in range(count) if all(math.isfinite(column[i]) for column in columns.values())]
    if mark.kind == "line":
        points = [(x(columns["x"][i]), y(columns["y"][i])) for i in held]
        if mark.steps:
            points = [point for a, b in zip(points, points[1:]) for point in (a, (b[0], a[1]))] + points[-1:]
        return f'<path d="{_path(points)}" fill="none" {paint} opacity="{mark.opacity:g}"/>' if points else ""
    if mark.kind == "area":
        if "x2" in columns:
            ends = [(x(columns["x"][i]), y(columns["y"][i])) for i in held], [(x(columns["x2"][i]), y(columns["y"][i])) for i in held]
        else:
            base = [columns["y2"][i] if "y2" in columns else 0.0 for i in held]
            ends = [(x(columns["x"][i]), y(columns["y"][i])) for i in held], [(x(columns["x"][i]), y(b)) for i, b in zip(held, base)]
        return f'<path d="{_path(ends[0] + ends[1][::-1], True)}" fill="{mark.colour}" opacity="{mark.opacity:g}"/>' if held else ""
    out = []
    for i in held:
        at = {name: column[i] for name, column in columns.items()}
        if mark.kind == "rule":
            a, b = ((_left, y(at["y"])), (_left + width, y(at["y"]))) if "x" not in at else (
                (x(at["x"]), y(at["y"]) if "y2" in at else _top), (x(at["x"]), y(at["y2"]) if "y2" in at else _top + height))
            out.append(f'<path d="{_path([a, b])}" {paint} opacity="{mark.opacity:g}"/>')
        elif mark.kind == "rect":
            xs, ys = sorted((x(at["x"]), x(at.get("x2", at["x"])))), sorted((y(at["y"]), y(at.get("y2", 0.0))))
            out.append(f'<rect x="{xs[0]:.1f}" y="{ys[0]:.1f}" width="{xs[1] - xs[0]:.1f}" height="{ys[1] - ys[0]:.1f}" '
                       f'fill="{mark.colour}" opacity="{at.get("opacity", mark.opacity):.3g}"/>')
        elif mark.kind == "point":
            out.append(_symbol(mark, x(at["x"]), y(at["y"])))
        elif mark.kind == "text":
            out.append(_text(x(at["x"]) - 7, y(at["y"]) - 5, mark.text, "end", 12, mark.colour))
    return "".join(out)


def _symbol(mark, x, y):
    radius = math.sqrt(mark.size / math.pi)
    paint = f'fill="{mark.colour}" opacity="{mark.opacity:g}"'
    if mark.shape in ("triangle-right", "triangle-left"):
        tip = radius * (1 if mark.shape == "triangle-right" else -1)
        return f'<path d="{_path([(x - tip, y - radius), (x - tip, y + radius), (x + tip, y)], True)}" {paint}/>'
    return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{radius:.1f}" {paint}/>'


def _legend(marks):
    entries = dict((mark.label, mark.colour) for mark in marks if mark.label)
    out, x = [], _left
    for label, colour in entries.items():
        out.append(f'<rect x="{x}" y="8" width="10" height="10" fill="{colour}"/>' + _text(x + 14, 17, label, "start", 11, _ink))
        x += 26 + 6.2 * len(label)
    return "".join(out)


def svg_of(specification, width=480):
    """The figure as an SVG element."""
    height = specification.get("height", 280)
    if not any(layer["encoding"] for layer in specification["layer"]):
        return "<p>no finite value to plot</p>"
    marks, across, up = marks_of(specification)
    x, y = _places(across, _left, _left + width), _places(up, _top + height, _top)
    clip = f"wearwell{zlib.crc32(json.dumps([specification, width]).encode()):x}"  # one name on a page of several
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {_left + width + _right} {_top + height + _bottom}" '
           f'width="{_left + width + _right}" style="max-width:100%;background:white" font-family="system-ui, sans-serif" role="img">',
           f"<title>{html.escape(specification.get('description', ''))}</title>",
           f'<clipPath id="{clip}"><rect x="{_left}" y="{_top}" width="{width}" height="{height}"/></clipPath>']
    for at, label in ticks_of(up):
        out.append(f'<path d="M{_left} {y(at):.1f} h{width}" stroke="{_faint}"/>' + _text(_left - 6, y(at) + 4, label, "end"))
    for at, label in ticks_of(across):
        out.append(f'<path d="M{x(at):.1f} {_top + height} v5" stroke="{_soft}"/>' + _text(x(at), _top + height + 18, label))
    out.append(f'<g clip-path="url(#{clip})">' + "".join(_drawn(mark, x, y, width, height) for mark in marks) + "</g>")
    out.append(f'<path d="M{_left} {_top} V{_top + height} H{_left + width}" fill="none" stroke="{_soft}"/>')
    out.append(_text(_left + width / 2, _top + height + 38, across.title, size=12, colour=_ink))
    middle = _top + height / 2
    out.append(_text(14, middle, up.title, size=12, colour=_ink, turn=f' transform="rotate(-90 14 {middle:.1f})"'))
    return "".join([*out, _legend(marks), "</svg>"])
