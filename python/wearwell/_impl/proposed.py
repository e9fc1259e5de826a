"""Default priors of the formula studies: weak, and from the size of the data, as `wearwell new --from` proposes them."""

import math
import re

from . import _core, toml
from .errors import InputError

factor_27 = "a factor of 27 to either side"


def rounded_up(value):
    """1, 2 or 5 times a power of ten, at least the value."""
    return _core.rounded_up(float(value))


def quantity_text(value, unit):
    """"20 km"; a plain number without a unit, and "2e+07 cycles" for 20 "1e6 cycles"."""
    match = re.match(r"([0-9.]+(?:[eE][+-]?\d+)?) (.+)\Z", unit)
    if match:
        return quantity_text(float(f"{value * float(match[1]):.15g}"), match[2])
    return float(value) if unit in ("", "1") else f"{toml.number_text(value)} {unit}"


def unit_of_ratio(over, under):
    """The unit of a rate."""
    over = over or "1"
    if under in ("", "1"):
        return over

    def factor(unit):
        return f"({unit})" if re.search(r"[ /]", unit) else unit

    return f"{factor(over)}/{factor(under)}"


def lognormal(median, unit, log_sd):
    return {"distribution": "lognormal", "median": quantity_text(median, unit), "log_sd": log_sd}


def half_normal(scale, unit=""):
    return {"distribution": "half-normal", "scale": quantity_text(scale, unit)}


def normal(mean, sd, unit=""):
    return {"distribution": "normal", "mean": quantity_text(mean, unit), "sd": quantity_text(sd, unit)}


def _flat(default):
    """The flat prior of a parameter: of its unit, above 0 where the default is."""
    if default["distribution"] == "uniform":
        return dict(default)
    size = default.get("median", default.get("scale", default.get("mean")))
    unit = size.split(" ", 1)[1] if isinstance(size, str) else "1"
    lower = {} if default["distribution"] == "normal" else {"lower": f"0 {unit}" if unit != "1" else 0}
    return {"distribution": "flat", "unit": unit, **lower}


class Priors:
    """The priors of a study, each a default with the reason for it until the caller states one."""

    def __init__(self, given):
        self._flat = given == "flat"
        if isinstance(given, str) and not self._flat:
            raise InputError(f"priors is {given!r}; it is a dict of priors by parameter, or 'flat'")
        self._given = {} if self._flat else dict(given or {})
        for name, prior in self._given.items():
            if not isinstance(prior, dict):
                raise InputError(f"priors: {name} is {type(prior).__name__}; wearwell.lognormal(...) and its like make one")
        self.laws, self.comments = {}, {}

    def add(self, name, default, why):
        if self._flat:
            self.laws[name] = _flat(default)
        elif name in self._given:
            self.laws[name] = self._given.pop(name)
        else:
            self.laws[name], self.comments[name] = default, f"default: {why}"
        for key in [key for key in self._given if key.startswith(f"{name}[")]:  # of one level
            self.laws[key] = self._given.pop(key)

    def require_used(self):
        if self._given:
            raise InputError(f"priors: the study has no parameter '{next(iter(self._given))}' (parameters: {', '.join(self.laws)})")


# The spread of ln life, pi/sqrt(6)/shape of a Weibull life, under the default prior of its shape: median 1.5, log_sd 0.7.
spread, spread_log_sd = round(math.pi / math.sqrt(6) / 1.5, 2), 0.7
