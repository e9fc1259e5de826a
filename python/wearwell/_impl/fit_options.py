"""What all functions that fit a table share: the options of the fit, and what they return and raise."""

import re

_run = """    threads : int
        Threads, 0 for all. No number depends on it.
    report : bool
        Whether to compute what ``Fit.plot`` and ``Fit.report`` show too.
    progress : bool or callable, optional
        True for a bar, or a function of (what, done, total, seconds)."""

_options = """    title : str, optional
        Title of the study.
    seed : int, optional
        Seed of the random numbers; default 1. One seed gives the same numbers to the bit.
    method : {"nuts", "exact", "metropolis"}, optional
        How draws are made: the No-U-Turn sampler (default), independently by quadrature (up to 4 parameters), or Metropolis.
    chains, warmup, draws : int, optional
        Chains, iterations of each that are discarded, and draws kept of each; default 4, 1000 and 1000.
""" + _run

_ends = """    Returns
    -------
    Fit
        The fit. ``fit.study.toml`` is the study as a file, with every prior; ask ``fit.trusted`` before you use a number.

    Raises
    ------
    InputError
        If a column is missing, can be read in two ways or lacks its unit, or a cell is wrong; the message names argument, or
        row and column.

    Warns
    -----
    CheckWarning
        For each check that warns or fails."""


def filled(function, places):
    """Puts texts into the docstring, by their places; python -OO has left out docstrings."""
    if function.__doc__:
        for place, text in places.items():
            function.__doc__ = function.__doc__.replace(place, text)
    return function


def options_of_the_run(function):
    """Puts the options of the run into the docstring."""
    return filled(function, {"    <options of the run>": _run})


def like_function(function):
    """Puts the arguments, results, errors and warnings of a function of a fit into the docstring of the method of the same name."""
    def put(method):
        text = function.__doc__
        if not text:
            return method
        text = re.sub(r"    fit : .*\n(?: {8}.*\n)+", "", text[text.index("    Parameters\n"):text.index("    Examples\n")].rstrip())
        return filled(method, {"        <as the function>": re.sub(r"(?m)^(?=.)", "    ", text)})

    return put


def fits(function):
    """Puts the common parts into the docstring."""
    return filled(function, {"    <what all fits share>": f"{_options}\n\n{_ends}", "    <options of the run>": _run})
