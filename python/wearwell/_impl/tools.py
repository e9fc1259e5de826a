"""Selections and cycle counting."""

import json
import os

from . import _core
from .data import headings_of, table_of
from .errors import InputError, warn_of
from .messages import in_arguments
from .check import checks_of
from .report import Report


class Selection(Report):
    """The best terms of a regression, as ``select`` finds them.

    Parameters
    ----------
    summary, text, models, page : str
        What the search wrote: JSON, text, CSV and HTML. ``select`` makes a Selection.

    Attributes
    ----------
    summary : dict
        All numbers, as ``wearwell select --json`` prints them.
    trusted : bool
        Whether the best model is proven to be the best.
    checks : list of Check
        All checks of the selection.

    Examples
    --------
    >>> import wearwell as ww
    >>> found = ww.select("examples/select/wear.csv", "w", inputs=["Td", "n"], degree=2)
    >>> found.models.loc[0, "terms"], found.trusted
    ('1 Td*Td Td*n n*n', True)
    """

    _no_page = "there is no page: select again with report=True"

    def __init__(self, summary, text, models, page):
        self.summary = json.loads(summary)
        self._summary_text, self._text, self._models, self._page = summary, text, models, page
        self.trusted = self.summary["trusted"]
        self.checks = checks_of(self.summary)

    @property
    def models(self):
        """The models found, best first.

        Returns
        -------
        pandas.DataFrame
            A row for each model. Columns: ``rank``; ``size`` (number of terms); the criterion; ``press`` (sum of squared
            leave-one-out residuals), in the squared unit of the response; ``r2`` and ``r2p`` (R^2 and its
            leave-one-out counterpart); ``weight`` (of stacking); ``terms``, separated by spaces.

        Examples
        --------
        >>> import wearwell as ww
        >>> found = ww.select("examples/select/wear.csv", "w", inputs=["Td", "n"], degree=2, keep=2)
        >>> found.models[["rank", "size", "r2p", "terms"]].round(3)
           rank  size    r2p                terms
        0     1     4  0.788    1 Td*Td Td*n n*n
        1     2     5  0.785  1 Td Td*Td Td*n n*n
        """
        import io

        import pandas

        return pandas.read_csv(io.StringIO(self._models))

    def __str__(self):
        return in_arguments(self._text)

    def __repr__(self):
        return f"<wearwell.Selection {self.summary['equation']!r}>"


def select(data, response, *, inputs=(), degree=None, terms=(), criterion="loo", keep=10, near=0.0, force=(), weights="",
           folds=0, nested=None, seed=1, time=None, threads=0, report=False):
    """Find the best subset of regression terms by exact search, with a proof that it is the best.

    Candidates are the constant and the products of ``inputs`` up to ``degree``, or ``terms``. The interpreter's lock is
    released.

    Parameters
    ----------
    data : table, str or path
        The data: whatever ``wearwell.table`` takes, or the path of a file.
    response : str
        Column to explain.
    inputs : str or sequence of str
        Columns whose products are the candidate terms.
    degree : int, optional
        Highest degree of these products; default 1.
    terms : str or sequence of str
        Candidate terms instead of ``inputs``: columns and products such as "A*A*B".
    criterion : {"loo", "aic", "aicc", "bic", "cp", "adjr2"}
        What the best model minimizes: PRESS, the sum of squared leave-one-out residuals (default); the criteria of Akaike
        (with small-sample correction: aicc) or Schwarz; Mallows's Cp; or what it maximizes, the adjusted R^2.
    keep : int
        How many best models to return, 1 to 10000.
    near : float
        Also every model this near to the best: relative with "loo" (0.01: PRESS 1 % above), else in units of the
        criterion.
    force : str or sequence of str
        Terms that every model holds; "1" is the constant.
    weights : str
        Column of weights of rows, 1/variance; "" for none.
    folds : int
        Folds of a k-fold cross-validation of the models found; 0 for none.
    nested : int, optional
        Parts of the rows that are left out of the whole search in turn; 0 for none; default 10, up to 2000 rows.
    seed : int
        Seed of folds and parts.
    time : float, optional
        Stop after so many seconds, proven or not.
    threads : int
        Threads, 0 for all. No answer depends on it.
    report : bool
        Whether to make the page that ``Selection.report`` writes.

    Returns
    -------
    Selection
        The best models.

    Raises
    ------
    InputError
        If a column is unknown or not numeric, a value is missing, or an option is out of its range.

    Warns
    -----
    CheckWarning
        If the search is not proven, or a check warns.

    Examples
    --------
    >>> import wearwell as ww
    >>> found = ww.select("examples/select/wear.csv", "w", inputs=["Td", "n"], degree=2)
    >>> found.models.loc[0, "terms"]
    '1 Td*Td Td*n n*n'
    >>> ww.select("examples/select/wear.csv", "w", inputs=["Tx"])
    Traceback (most recent call last):
        ...
    wearwell.InputError: ...Tx...
    """
    inputs = [inputs] if isinstance(inputs, str) else list(inputs)
    terms = [terms] if isinstance(terms, str) else list(terms)
    force = [force] if isinstance(force, str) else [str(f) for f in force]
    if isinstance(data, (str, os.PathLike)):
        source = os.fspath(data)
    else:
        headings = headings_of(data)
        used = {response, weights, *inputs}
        for term in terms:
            used |= {term, *term.split("*")}
        known = None if headings is None else {h for h in headings if h in used}
        source = table_of(data, only=known if known else None)
    found = Selection(*_core.select(source, response, inputs, degree, terms, weights or "", force, criterion, int(keep),
                                    float(near), int(folds), -1 if nested is None else int(nested), int(seed),
                                    float("inf") if time is None else float(time), int(threads), bool(report)))
    warn_of(found.checks)
    return found


def rainflow(signal, *, method="four-point", residual="half"):
    """Count the cycles of a load history by the rainflow method of ASTM E1049-85.

    Parameters
    ----------
    signal : array or column
        Samples, or peaks and valleys: one dimension, finite numbers, in any unit.
    method : {"four-point", "three-point"}
        How closed cycles are found. Three-point is that of the standard; four-point finds the same cycles.
    residual : {"half", "repeat"}
        Ranges that close no cycle count half, or the history is repeated so that all cycles close.

    Returns
    -------
    pandas.DataFrame
        A row for each cycle, in the order in which they close. Columns: ``from`` and ``to`` (its ends), ``range``
        (distance of the ends, twice the amplitude) and ``mean``, in the unit of the signal; ``count``, 1 or 0.5.

    Raises
    ------
    InputError
        If ``method`` or ``residual`` is another, or the signal is not one-dimensional, numeric and finite.

    Examples
    --------
    The history of ASTM E1049-85, figure 6:

    >>> import wearwell as ww
    >>> cycles = ww.rainflow([-2, 1, -3, 5, -1, 3, -4, 4, -2], method="three-point")
    >>> cycles.groupby("range")["count"].sum().to_dict()
    {3.0: 0.5, 4.0: 1.5, 6.0: 0.5, 8.0: 1.0, 9.0: 0.5}
    """
    import pandas

    from .data import _values

    if method not in ("four-point", "three-point"):
        raise InputError(f"method is {method!r}; it is 'four-point' or 'three-point'")
    if residual not in ("half", "repeat"):
        raise InputError(f"residual is {residual!r}; it is 'half' or 'repeat'")
    values = _values(signal, "signal")
    if isinstance(values, list):
        raise InputError("signal holds no numbers")
    start, end, count = _core.rainflow(values, method == "three-point", residual == "repeat")
    return pandas.DataFrame({"from": start, "to": end, "range": abs(end - start), "mean": (start + end) / 2, "count": count})
