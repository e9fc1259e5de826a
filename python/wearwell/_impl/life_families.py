"""Families of lives in one line: their parameters with default priors; thresholds, shares of parts and subpopulations."""

import numbers

from . import toml
from .errors import InputError
from .proposed import half_normal, normal, quantity_text, rounded_up, spread, spread_log_sd

_slope = ("slope", {"distribution": "lognormal", "median": 1.5, "log_sd": 0.7}, "below 1 early failures, 1 random failures, above wear-out")
_of_spread = "life scatters as under the default of weibull"
_of_share = {"distribution": "uniform", "lower": 0, "upper": 1}


def _spread_of(name, scale=spread, log_sd=spread_log_sd):
    return name, {"distribution": "lognormal", "median": round(scale, 2), "log_sd": log_sd}, _of_spread


# Of a family: the name of what the formula gives, its parameters in [likelihood] of that name, and the parameters of its shape.
# Their defaults have the same spread of ln life: its standard deviation is 1.81/shape of a log-logistic and about
# 1/sqrt(shape) of a gamma life.
families = {
    "weibull": ("characteristic", {"scale": "{}", "shape": "slope"}, [_slope]),
    "exponential": ("mean_life", {"mean": "{}"}, []),
    "lognormal": ("median_life", {"median": "{}", "log_sd": "sigma"}, [_spread_of("sigma")]),
    "loglogistic": ("median_life", {"scale": "{}", "shape": "shape"}, [_spread_of("shape", 1.8138 / spread)]),
    "frechet": ("characteristic", {"scale": "{}", "shape": "slope"}, [_spread_of("slope", 1.2825 / spread)]),
    "gamma": ("mean_life", {"scale": "{}/shape", "shape": "shape"}, [_spread_of("shape", 1.8, 1.2)]),
    "inverse-gaussian": ("mean_life", {"mean": "{}", "shape": "{}/variation^2"}, [_spread_of("variation")]),
    "birnbaum-saunders": ("median_life", {"scale": "{}", "shape": "alpha"}, [_spread_of("alpha")]),
    "generalized-gamma": ("scale", {"scale": "{}", "sigma": "sigma", "lambda": "lambda"},
                          [_spread_of("sigma"), ("lambda", normal(0, 1.5), "0 is lognormal, 1 weibull, -1 frechet")]),
    "exponentiated-weibull": ("scale", {"scale": "{}", "shape": "slope", "exponent": "exponent"},
                              [_slope, ("exponent", {"distribution": "lognormal", "median": 1, "log_sd": 0.7}, "1 is weibull")]),
    "log10-normal": ("median_life", {"median": "{}", "log10_sd": "log10_sd"}, [_spread_of("log10_sd", spread / 2.302585)]),
    "log-location-scale": ("scale", {"scale": "{}", "sigma": "sigma"}, [_spread_of("sigma")]),
}
_standards = ("smallest extreme value", "normal", "logistic", "largest extreme value")
_names = {2: ("early", "late"), 3: ("early", "middle", "late"), 4: ("first", "second", "third", "fourth")}


def family_keys(family, standard):
    """What [likelihood] says of the family, beside its parameters."""
    if family not in families:
        raise InputError(f"family is {family!r}; it is {', '.join(families)}. wearwell.Study has further ones, with priors that you state")
    if family != "log-location-scale":
        if standard is not None:
            raise InputError(f"standard is {standard!r} and family is {family!r}; standard is of family='log-location-scale'")
        return {"family": family}
    if standard not in _standards:
        raise InputError(f"standard is {standard!r}; the distribution of the standardized logarithm is {', '.join(map(repr, _standards))}")
    return {"family": family, "standard": standard}


def population_names(subpopulations):
    """The names of the subpopulations in the order of their median lives; none where there is one population."""
    if subpopulations is None:
        return ()
    if isinstance(subpopulations, numbers.Integral) and not isinstance(subpopulations, bool) and int(subpopulations) in _names:
        return _names[int(subpopulations)]
    if isinstance(subpopulations, (list, tuple)) and len(subpopulations) in _names and all(isinstance(each, str) for each in subpopulations):
        return tuple(subpopulations)
    raise InputError(f"subpopulations is {subpopulations!r}; it is 2, 3 or 4, or as many names in the order of their median lives, like ['early', 'wear-out']")


def refuse_beside(shares, populations, given):
    """``shares``: (argument, value) of shares; ``given``: (argument, value) of by, unit and mode."""
    given = [name for name, value in given if value is not None]
    why = {"by": "each group has its own scale, and a subpopulation is not known of a part", "mode": "a failure mode is known of a part, a subpopulation is not",
           "unit": "subpopulations have no random effects"}
    if populations and given:
        raise InputError(f"{given[0]} and subpopulations: {why[given[0]]}; leave one out")
    asked = [name for name, value in shares if wanted(name, value)]
    given = [name for name in given if name != "by"]
    if asked and given:
        raise InputError(f"{given[0]} and {asked[0]}: {'lives with random effects' if given[0] == 'unit' else 'failure modes'} have no such share; leave one out")


def wanted(argument, value):
    """Whether a share is asked for: True, or a known number."""
    if value is None or value is False:
        return False
    if value is True or (isinstance(value, numbers.Real) and 0 <= value <= 1):
        return True
    raise InputError(f"{argument} is {value!r}; it is True, for a share with a prior, or a known share from 0 to 1")


def share_keys(shares, known):
    """The keys of [likelihood] of the shares, whose priors ``known`` gets."""
    of = {"share_defective": "share of the parts that can fail at all", "share_dead_on_arrival": "share of the parts that are dead at life 0"}
    keys = {}
    for name, value in shares:
        if not wanted(name, value):
            continue
        keys[name] = name if value is True else value
        if value is True:
            known.add(name, dict(_of_share), of[name])
    return keys


def threshold_keys(threshold, smallest, unit, known, constants):
    """The key of [likelihood] of a threshold: with a prior, or a constant."""
    if threshold is None or threshold is False:
        return {}
    if threshold is True:
        known.add("threshold", half_normal(rounded_up(smallest), unit), "no life ends before it; about the smallest life, rounded up")
    elif isinstance(threshold, numbers.Real):
        constants["threshold"] = quantity_text(threshold, unit)
    else:
        constants["threshold"] = toml.quantity(threshold, "threshold")
    return {"threshold": "threshold"}


def population_table(names, known):
    """[subpopulations]: the last one has the rest."""
    shares = {}
    for name in names[:-1]:
        plain = "".join(each if each.isascii() and each.isalnum() else "_" for each in name)
        shares[name] = f"share_{plain}"
        if list(shares.values()).count(shares[name]) > 1:
            raise InputError(f"subpopulations: the names give the share {shares[name]} twice; choose names that differ in letters or digits")
        known.add(shares[name], dict(_of_share), f"share of the parts that are {name}")
    return {"names": list(names), "share": shares}
