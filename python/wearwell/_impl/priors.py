"""Priors: what is known of a parameter before the data, as ``[prior]`` of a study file has it.

Every function returns a dict for ``Study(priors=...)``. A quantity is a text with its unit, "7e-4 mm^3/(N m)", a plain
number, or a pint quantity. The parameter is reported in the unit of its prior. ``lower`` and ``upper`` truncate any
distribution, which is normalized again. Parameters of a distribution are checked when the study is read.
"""

from .toml import quantity


def _law(distribution, lower, upper, **keys):
    prior = {"distribution": distribution}
    for key, each in {**keys, "lower": lower, "upper": upper}.items():
        if each is not None:
            prior[key] = each if key == "unit" else quantity(each, key)
    return prior


def flat(unit, *, lower=None, upper=None):
    """Flat prior: constant density, nothing is known of the parameter.

    It is proper only between two bounds; the check ``proper-posterior`` examines whether the posterior is proper. An
    answer that depends on where a flat prior is truncated fails the check ``prior-bounds``; with ``uniform`` it warns.

    Parameters
    ----------
    unit : str
        Unit in which the parameter is reported, such as "mm^3/(N m)"; "1" for a plain number.
    lower, upper : str, float or pint quantity, optional
        Bounds of the parameter, in the dimension of ``unit``.

    Returns
    -------
    dict
        The prior, for ``Study(priors=...)``.

    Raises
    ------
    InputError
        If a bound is neither a number nor a text nor a pint quantity.

    Examples
    --------
    >>> import wearwell as ww
    >>> ww.flat("mm", lower="0 mm", upper="15 mm")["upper"]
    '15 mm'
    """
    return _law("flat", lower, upper, unit=unit)


def uniform(lower, upper):
    """Uniform prior: constant density between two bounds that are knowledge, zero beyond.

    Parameters
    ----------
    lower, upper : str, float or pint quantity
        Bounds of the parameter, ``lower`` below ``upper``, with units.

    Returns
    -------
    dict
        The prior, for ``Study(priors=...)``.

    Raises
    ------
    InputError
        If a bound is neither a number nor a text nor a pint quantity.

    Examples
    --------
    >>> import wearwell as ww
    >>> sigma = ww.uniform("0 mm^3", "15 mm^3")
    >>> sigma["lower"], sigma["upper"]
    ('0 mm^3', '15 mm^3')
    """
    return _law("uniform", lower, upper)


def normal(mean, sd, *, lower=None, upper=None):
    """Normal prior, density proportional to exp(-(x - mean)^2/(2 sd^2)).

    Parameters
    ----------
    mean : str, float or pint quantity
        Mean before truncation, with its unit.
    sd : str, float or pint quantity
        Standard deviation before truncation, above 0, in the dimension of ``mean``.
    lower, upper : str, float or pint quantity, optional
        Bounds that truncate the distribution.

    Returns
    -------
    dict
        The prior, for ``Study(priors=...)``.

    Raises
    ------
    InputError
        If a quantity is neither a number nor a text nor a pint quantity.

    Examples
    --------
    >>> import wearwell as ww
    >>> ww.normal("7e-4 mm^3/(N m)", "1e-4 mm^3/(N m)")["sd"]
    '1e-4 mm^3/(N m)'
    """
    return _law("normal", lower, upper, mean=mean, sd=sd)


def lognormal(median=None, log_sd=None, *, mean=None, sd=None, lower=None, upper=None):
    """Lognormal prior of a positive parameter, by median and log standard deviation, or by mean and standard deviation.

    The two forms are related by log_sd^2 = ln(1 + sd^2/mean^2) and median = mean exp(-log_sd^2/2).

    Parameters
    ----------
    median : str, float or pint quantity, optional
        Median, above 0, with its unit.
    log_sd : float, optional
        Standard deviation of the natural logarithm, without a unit: 90 % lie within a factor exp(1.645 log_sd) of
        the median.
    mean, sd : str, float or pint quantity, optional
        Mean and standard deviation of the parameter itself, instead of ``median`` and ``log_sd``.
    lower, upper : str, float or pint quantity, optional
        Bounds that truncate the distribution.

    Returns
    -------
    dict
        The prior, for ``Study(priors=...)``.

    Raises
    ------
    InputError
        If a quantity is neither a number nor a text nor a pint quantity.

    Examples
    --------
    >>> import wearwell as ww
    >>> k = ww.lognormal("1e-7 mm^3/(N m)", log_sd=3)
    >>> k["median"], k["log_sd"]
    ('1e-7 mm^3/(N m)', 3)
    >>> sorted(ww.lognormal(mean="7e-4 mm^3/(N m)", sd="3e-4 mm^3/(N m)"))[1:]
    ['mean', 'sd']
    """
    return _law("lognormal", lower, upper, median=median, log_sd=log_sd, mean=mean, sd=sd)


def student_t(df, location, scale, *, lower=None, upper=None):
    """Student t prior, density proportional to (1 + (x - location)^2/(df scale^2))^(-(df + 1)/2).

    Parameters
    ----------
    df : float
        Degrees of freedom, above 0, without a unit.
    location : str, float or pint quantity
        Median before truncation, with its unit.
    scale : str, float or pint quantity
        Scale, above 0, in the dimension of ``location``.
    lower, upper : str, float or pint quantity, optional
        Bounds that truncate the distribution.

    Returns
    -------
    dict
        The prior, for ``Study(priors=...)``.

    Raises
    ------
    InputError
        If a quantity is neither a number nor a text nor a pint quantity.

    Examples
    --------
    >>> import wearwell as ww
    >>> ww.student_t(4, "7e-4 mm^3/(N m)", "1e-4 mm^3/(N m)", lower="0 mm^3/(N m)")["df"]
    4
    """
    return _law("student-t", lower, upper, df=df, location=location, scale=scale)


def beta(alpha, beta, *, lower=None, upper=None):
    """Beta prior of a plain number between 0 and 1, density proportional to x^(alpha - 1) (1 - x)^(beta - 1).

    Parameters
    ----------
    alpha, beta : float
        Shapes, above 0, without units. The mean is alpha/(alpha + beta).
    lower, upper : float, optional
        Bounds that truncate the distribution.

    Returns
    -------
    dict
        The prior, for ``Study(priors=...)``.

    Raises
    ------
    InputError
        If an argument is neither a number nor a text.

    Examples
    --------
    >>> import wearwell as ww
    >>> gamma = ww.beta(4, 3)
    >>> gamma["alpha"], gamma["beta"]
    (4, 3)
    """
    return _law("beta", lower, upper, alpha=alpha, beta=beta)


def prior(distribution, *, unit=None, lower=None, upper=None, **parameters):
    """A prior with any distribution, by the name of the distribution.

    Names and parameters are: "flat"; "uniform"; "normal" (mean, sd); "lognormal" (median, log_sd; or mean, sd);
    "log10-normal" (median, log10_sd); "student-t" (df, location, scale); "half-normal", "half-cauchy" (scale);
    "exponential" (mean); "gamma", "inverse-gamma", "weibull", "loglogistic", "frechet", "birnbaum-saunders" (scale, shape);
    "inverse-gaussian" (mean, shape); "smallest-extreme-value", "largest-extreme-value" (location, scale);
    "generalized-gamma" (scale, sigma, lambda); "exponentiated-weibull" (scale, shape, exponent); "beta" (alpha,
    beta); "jeffreys".

    Parameters
    ----------
    distribution : str
        Name of the distribution.
    unit : str, optional
        Unit in which the parameter is reported; by default that of the first quantity.
    lower, upper : str, float or pint quantity, optional
        Bounds that truncate the distribution.
    **parameters : str, float or pint quantity
        Parameters of the distribution, by name.

    Returns
    -------
    dict
        The prior, for ``Study(priors=...)``.

    Raises
    ------
    InputError
        If a quantity is neither a number nor a text nor a pint quantity. A name or a parameter that no distribution
        has is refused when the study is read.

    Examples
    --------
    >>> import wearwell as ww
    >>> depth = ww.prior("weibull", scale="5 mm", shape=2)
    >>> depth["scale"], depth["shape"]
    ('5 mm', 2)
    >>> ww.prior("weibull", scale=[5], shape=2)
    Traceback (most recent call last):
        ...
    wearwell.InputError: scale is list; ...
    """
    return _law(distribution, lower, upper, unit=unit, **parameters)


def default():
    """The model's own weak prior, the one of a parameter for which the study states none.

    It is set from units and the size of the data, never from a fit; ``Study.description`` and ``Fit.parameters`` show it.
    Parameters of a formula have no default: state a prior for each.

    Returns
    -------
    dict
        The prior, for ``Study(priors=...)``.

    Examples
    --------
    >>> import wearwell as ww
    >>> list(ww.default().values())
    ['default']
    """
    return {"distribution": "default"}
