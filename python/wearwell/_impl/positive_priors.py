"""Priors of parameters that are positive: scatters, rates, scales."""

from .priors import _law


def half_normal(scale, *, lower=None, upper=None):
    """Half-normal prior, density proportional to exp(-x^2/(2 scale^2)) for x above 0.

    It suits a standard deviation of which the order of magnitude is known: 90 % lie below 1.645 scale.

    Parameters
    ----------
    scale : str, float or pint quantity
        Standard deviation of the normal distribution of which this is the positive half, above 0, with its unit.
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
    >>> ww.half_normal("5 mm^3")["scale"]
    '5 mm^3'
    """
    return _law("half-normal", lower, upper, scale=scale)


def half_cauchy(scale, *, lower=None, upper=None):
    """Half-Cauchy prior, density proportional to 1/(1 + x^2/scale^2) for x above 0; it has no mean.

    Parameters
    ----------
    scale : str, float or pint quantity
        Median before truncation, above 0, with its unit.
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
    >>> ww.half_cauchy("5 mm^3", upper="100 mm^3")["upper"]
    '100 mm^3'
    """
    return _law("half-cauchy", lower, upper, scale=scale)


def exponential(mean, *, lower=None, upper=None):
    """Exponential prior, density proportional to exp(-x/mean) for x above 0.

    Parameters
    ----------
    mean : str, float or pint quantity
        Mean before truncation, above 0, with its unit.
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
    >>> ww.exponential("5 mm^3")["mean"]
    '5 mm^3'
    """
    return _law("exponential", lower, upper, mean=mean)


def gamma(shape, scale, *, lower=None, upper=None):
    """Gamma prior, density proportional to x^(shape - 1) exp(-x/scale) for x above 0.

    Parameters
    ----------
    shape : float
        Shape, above 0, without a unit.
    scale : str, float or pint quantity
        Scale, above 0, with its unit. The mean is shape scale, the variance shape scale^2.
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
    >>> ww.gamma(2, "3 mm^3")["scale"]
    '3 mm^3'
    """
    return _law("gamma", lower, upper, shape=shape, scale=scale)


def inverse_gamma(shape, scale, *, lower=None, upper=None):
    """Inverse gamma prior, density proportional to x^(-shape - 1) exp(-scale/x) for x above 0.

    Parameters
    ----------
    shape : float
        Shape, above 0, without a unit.
    scale : str, float or pint quantity
        Scale, above 0, with its unit. The mean is scale/(shape - 1) where the shape is above 1.
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
    >>> ww.inverse_gamma(3, "10 mm^3")["shape"]
    3
    """
    return _law("inverse-gamma", lower, upper, shape=shape, scale=scale)


def jeffreys(unit, *, lower=None, upper=None):
    """Jeffreys prior of a scale, density proportional to 1/x for x above 0: its order of magnitude is unknown.

    It is proper only between two bounds; the check ``proper-posterior`` examines whether the posterior is proper.

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
    >>> ww.jeffreys("mm^3/(N m)", lower="1e-9 mm^3/(N m)")["lower"]
    '1e-9 mm^3/(N m)'
    """
    return _law("jeffreys", lower, upper, unit=unit)
