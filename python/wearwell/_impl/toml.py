"""Study files as text."""

import json
import numbers
import re
from collections.abc import Mapping

from .errors import InputError

_bare = re.compile(r"[A-Za-z0-9_-]+\Z")


def quantity(value, what):
    """A number, a text like "5 mm^3", or a pint quantity, as a study file writes it."""
    if hasattr(value, "magnitude") and hasattr(value, "units"):
        return f"{float(value.magnitude)!r} {unit_text(value.units)}".rstrip()
    if isinstance(value, str):
        return value
    if isinstance(value, numbers.Real) and not isinstance(value, bool):
        return value
    raise InputError(f"{what} is {type(value).__name__}; it is a number or a text with a unit, like '5 mm^3'")


def mapping(value, what, like):
    """A dict that may be missing, as one."""
    if value is None or isinstance(value, Mapping):
        return value or {}
    raise InputError(f"{what} is {type(value).__name__}; it is a dict like {like}")


def number_text(value):
    """All digits of a number, as R writes it: 320, not 320.0."""
    value = float(value)
    return f"{value:.0f}" if value == round(value, 0) and abs(value) < 2**53 else repr(value)


def of_numpy(value, what):
    """A number or an array of numpy as Python has it. Dates and durations are refused: some would be whole numbers of nanoseconds."""
    if getattr(getattr(value, "dtype", None), "kind", "") in ("m", "M"):
        raise InputError(f"{what} holds dates or times ({value.dtype}); it is a number, or a text with a unit, like '100 h'")
    return value.tolist()


def distribution(value, what):
    """A distribution with its keys, as a study file writes it: numbers, texts, pint quantities and lists of them."""
    return {key: [quantity(one, f"{what}.{key}") for one in each] if isinstance(each, (list, tuple)) else quantity(each, f"{what}.{key}")
            for key, each in value.items()}


def unit_text(unit):
    """A unit: a text, or pint's, as wearwell reads it: "mm^3/N/m"."""
    if isinstance(unit, str):
        return unit
    try:
        text = format(unit, "~C")
    except (TypeError, ValueError):
        raise InputError(f"a unit is a text like 'mm^3/(N m)', not {type(unit).__name__}") from None
    return text.replace("**", "^").replace("*", " ") or "1"


def _key(name):
    return name if _bare.match(name) else _text(name)


def _text(text):
    # JSON's strings are TOML's, but for DEL, which must be escaped here.
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007F")


def value(item, what):
    """One value in one line."""
    if isinstance(item, bool):
        return "true" if item else "false"
    if isinstance(item, str):
        return _text(item)
    if isinstance(item, numbers.Integral):
        return repr(int(item))
    if isinstance(item, numbers.Real):
        number = float(item)
        return repr(number) if number == number and abs(number) != float("inf") else {"inf": "inf", "-inf": "-inf"}.get(
            repr(number), "nan"
        )
    if isinstance(item, dict):
        if not item:
            return "{}"
        inside = ", ".join(f"{_key(str(k))} = {value(v, f'{what}.{k}')}" for k, v in item.items())
        return "{ " + inside + " }"
    if isinstance(item, (list, tuple)):
        return "[" + ", ".join(value(each, what) for each in item) + "]"
    if hasattr(item, "tolist"):  # a number or an array of numpy
        return value(of_numpy(item, what), what)
    if hasattr(item, "magnitude"):
        return _text(str(quantity(item, what)))
    raise InputError(f"{what} is {type(item).__name__}; a study holds texts, numbers, lists and dicts of them")


def table(name, entries, comments=None):
    """A table with its keys, one a line; ``comments`` by key."""
    lines = [f"[{name}]"] if name else []
    for k, v in entries.items():
        comment = f"    # {comments[k]}" if comments and k in comments else ""
        lines.append(f"{_key(str(k))} = {value(v, f'{name}.{k}')}{comment}")
    return "\n".join(lines) + "\n"
