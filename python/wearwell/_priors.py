"""Distributions of priors, as ``[prior]`` of a study has them (docs/reference/priors.md).

A quantity is a text with its unit, "7e-4 mm^3/(N m)", a plain number, or a pint quantity. Every distribution may be cut by
``lower`` and ``upper``. What is wrong with a distribution is said when the study is read.
"""

from ._toml import quantity


def _law(distribution, lower, upper, **keys):
    prior = {"distribution": distribution}
    for key, each in {**keys, "lower": lower, "upper": upper}.items():
        if each is not None:
            prior[key] = each if key == "unit" else quantity(each, key)
    return prior


def flat(unit, *, lower=None, upper=None):
    """Nothing is known; proper between two bounds."""
    return _law("flat", lower, upper, unit=unit)


def uniform(lower, upper):
    """Anything between, nothing beyond."""
    return _law("uniform", lower, upper)


def normal(mean, sd, *, lower=None, upper=None):
    """Normal, with mean and standard deviation."""
    return _law("normal", lower, upper, mean=mean, sd=sd)


def lognormal(median=None, log_sd=None, *, mean=None, sd=None, lower=None, upper=None):
    """Lognormal: median and the standard deviation of the natural logarithm; or mean and sd of the quantity itself."""
    return _law("lognormal", lower, upper, median=median, log_sd=log_sd, mean=mean, sd=sd)


def half_normal(scale, *, lower=None, upper=None):
    """Normal about 0, the positive half."""
    return _law("half-normal", lower, upper, scale=scale)


def half_cauchy(scale, *, lower=None, upper=None):
    """Cauchy about 0, the positive half; its median is the scale."""
    return _law("half-cauchy", lower, upper, scale=scale)


def exponential(mean, *, lower=None, upper=None):
    """Exponential, with its mean."""
    return _law("exponential", lower, upper, mean=mean)


def gamma(shape, scale, *, lower=None, upper=None):
    """Gamma: mean shape times scale."""
    return _law("gamma", lower, upper, shape=shape, scale=scale)


def inverse_gamma(shape, scale, *, lower=None, upper=None):
    """Inverse gamma: mean scale/(shape - 1) for shapes above 1."""
    return _law("inverse-gamma", lower, upper, shape=shape, scale=scale)


def student_t(df, location, scale, *, lower=None, upper=None):
    """Student's t with df degrees of freedom."""
    return _law("student-t", lower, upper, df=df, location=location, scale=scale)


def beta(alpha, beta, *, lower=None, upper=None):
    """Beta, of a plain number between 0 and 1."""
    return _law("beta", lower, upper, alpha=alpha, beta=beta)


def jeffreys(unit, *, lower=None, upper=None):
    """1/x: the order of magnitude is unknown; proper between two bounds."""
    return _law("jeffreys", lower, upper, unit=unit)


def prior(distribution, *, unit=None, lower=None, upper=None, **parameters):
    """Any distribution of docs/reference/priors.md by name, with its parameters: ``prior("weibull", scale="5 mm", shape=2)``."""
    return _law(distribution, lower, upper, unit=unit, **parameters)


def default():
    """What holds where nothing is said (docs/reference/priors.md)."""
    return {"distribution": "default"}
