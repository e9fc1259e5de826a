"""Radial journal bearings: wear rate, depth, allowable pressure, length and life (docs/reference/bearing.md).

Every function takes ``contact`` ("stationary", "journal" or "bushing") and texts with units, as the command's options:
radius or diameter, clearance, depth or scar_width, rate, pressure or force and length, revolutions or speed and time. An
uncertain one, "50 +- 5 um" or "1e-16 m^3/(N m) x/ 2", gives the answer an interval.

Each returns the dict that ``wearwell bearing ... --json`` prints: value, unit, interval, wear_number, sigma, delta,
scar_width. Raises InputError; warns (CheckWarning) where the command warns.
"""

import json

from . import _core
from ._errors import InputError, warn
from ._toml import quantity


def _answer(command, contact, unit, limit, draws, seed, inputs):
    texts = {}
    for name, value in inputs.items():
        if value is not None:
            texts[name.replace("_", "-")] = str(quantity(value, name))
    if not 100 <= int(draws) <= 10_000_000:
        raise InputError(f"draws is {draws}; it must be 100 to 10000000")
    answer, found, margin = _core.bearing(command, contact or "", texts, unit or "", str(limit or ""), int(draws), int(seed))
    for each in found:
        warn(each)
    answer = json.loads(answer)
    if margin:
        answer["margin"] = margin
    return answer


def rate(contact, *, unit=None, draws=100_000, seed=1, **inputs):
    """The wear rate k from a measured depth."""
    return _answer("rate", contact, unit, None, draws, seed, inputs)


def depth(contact, *, unit=None, limit=None, draws=100_000, seed=1, **inputs):
    """The wear depth after so many revolutions; with ``limit`` also the margin to it, in words."""
    return _answer("depth", contact, unit, limit, draws, seed, inputs)


def pressure(contact, *, unit=None, draws=100_000, seed=1, **inputs):
    """The apparent pressure that wears no deeper than the depth."""
    return _answer("pressure", contact, unit, None, draws, seed, inputs)


def length(contact, *, unit=None, draws=100_000, seed=1, **inputs):
    """The bearing length that a force needs to wear no deeper than the depth."""
    return _answer("length", contact, unit, None, draws, seed, inputs)


def life(contact, *, unit=None, draws=100_000, seed=1, **inputs):
    """How long until the depth is reached: in revolutions, or with ``speed`` in time."""
    return _answer("life", contact, unit, None, draws, seed, inputs)
