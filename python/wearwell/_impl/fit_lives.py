"""Distributions of life that a fit answers later, under any conditions."""

from .errors import InputError
from .fit_options import filled

_doc_given = """        given : dict or data frame, optional
            Conditions, by column: values of one, or a row each of several; plain numbers in the unit of the column. What is
            left out is as the study predicts. By default a row for each group that has parameters of its own."""


def _described(function):
    return filled(function, {"        <given>": _doc_given})


class FitLives:
    """Survival, hazard and percentiles of fits of lives. Part of ``Fit``."""

    @_described
    def survival_function(self, times, given=None):
        """Probability that an item outlasts given lives.

        Parameters
        ----------
        times : float, str or sequence
            Lives; plain numbers in the unit of the column of lives.
        <given>

        Returns
        -------
        pandas.DataFrame
            A row for each condition and life, indexed by them. Columns: quantiles ``q05``, ``q50``, ``q95`` of the share of
            all items that survives, and ``predictive``, the probability that the next item does.

        Raises
        ------
        InputError
            If the study is not of lives, or a condition is unknown or missing.

        Examples
        --------
        >>> import wearwell as ww
        >>> pumps = {"hours": [312, 480, 510, 640, 700, 700, 150, 260, 420], "failed": [1, 1, 1, 1, 0, 0, 1, 1, 1]}
        >>> fit = ww.life(pumps, "hours", event="failed", method="exact", draws=100, report=False)
        >>> fit.survival_function([200, 500]).round(2)
                q05   q50   q95  predictive
        hours
        200    0.68  0.87  0.96        0.85
        500    0.27  0.48  0.70        0.48
        """
        from .lives_of import survival_function

        return survival_function(self, times, given)

    @_described
    def hazard(self, times, given=None):
        """Failure rate of those that have reached given lives.

        Parameters
        ----------
        times : float, str or sequence
            Lives; plain numbers in the unit of the column of lives.
        <given>

        Returns
        -------
        pandas.DataFrame
            A row for each condition and life, indexed by them, with the quantiles ``q05``, ``q50`` and ``q95`` of the rate;
            ``attrs["unit"]`` is its unit.

        Raises
        ------
        InputError
            If the study is not of lives, or a condition is unknown or missing.

        Examples
        --------
        >>> import wearwell as ww
        >>> pumps = {"hours": [312, 480, 510, 640, 700, 700, 150, 260, 420], "failed": [1, 1, 1, 1, 0, 0, 1, 1, 1]}
        >>> fit = ww.life(pumps, "hours", event="failed", method="exact", draws=100, report=False)
        >>> fit.hazard([200, 500])["q50"].is_monotonic_increasing
        True
        """
        from .lives_of import hazard

        return hazard(self, times, given)

    @_described
    def percentile(self, p, given=None, confidence=0.9):
        """Lives by which p percent have failed: B-lives.

        Parameters
        ----------
        p : float, str or sequence
            Percentages that have failed, from 1 to below 100: 10 for B10. Below 1 write "0.1 %".
        <given>
        confidence : float
            Probability with which ``bound`` is exceeded.

        Returns
        -------
        pandas.DataFrame
            A row for each condition and percentage, indexed by them. Columns: quantiles ``q05``, ``q50``, ``q95`` of the
            B-life of all items, ``predictive`` (that of the next item) and ``bound``; ``attrs["unit"]`` is their unit.

        Raises
        ------
        InputError
            If the study is not of lives, a condition is unknown or missing, or ``p`` may be a fraction.

        Examples
        --------
        >>> import wearwell as ww
        >>> pumps = {"hours": [312, 480, 510, 640, 700, 700, 150, 260, 420], "failed": [1, 1, 1, 1, 0, 0, 1, 1, 1]}
        >>> fit = ww.life(pumps, "hours", event="failed", method="exact", draws=100, report=False)
        >>> fit.percentile([10, 50])["q50"].round(-1).tolist()
        [170.0, 480.0]
        """
        from .lives_of import percentile

        return percentile(self, p, given, confidence)

    @_described
    def conditional(self, survived, b=(1, 10, 50), given=None, confidence=0.9):
        """Remaining useful life of items that have reached a life.

        Parameters
        ----------
        survived : float, str or pint quantity
            The life that they have reached; a plain number in the unit of the column of lives.
        b : float or sequence of float
            Percentages of B-lives, counted from there.
        <given>
        confidence : float
            Probability with which ``bound`` is exceeded.

        Returns
        -------
        pandas.DataFrame
            For each condition a row for the probability of survival to ``survived`` (in percent), the mean remaining useful
            life and each B-life of it, with ``unit``, quantiles ``q05``, ``q50``, ``q95``, ``predictive`` and ``bound``.

        Raises
        ------
        InputError
            If the study is not of lives, a condition is unknown or missing, or fewer than 0.1 % survive.

        Examples
        --------
        >>> import wearwell as ww
        >>> pumps = {"hours": [312, 480, 510, 640, 700, 700, 150, 260, 420], "failed": [1, 1, 1, 1, 0, 0, 1, 1, 1]}
        >>> fit = ww.life(pumps, "hours", event="failed", method="exact", draws=100, report=False)
        >>> list(fit.conditional(300, b=10).index)
        ['survival to 300', 'mean remaining useful life', 'B10 remaining useful life']
        """
        from .lives_of import conditional

        return conditional(self, survived, b, given, confidence)

    def compare(self, *others, names=None, families=None, threads=0, progress=None):
        """Rank this fit and others of the same data, or families of its life, as ``wearwell.compare``.

        Parameters
        ----------
        *others : Fit, str or path
            Other fits, or folders of results; none with ``families``.
        names : sequence of str, optional
            Names of all fits, this one first.
        families : str or sequence of str, optional
            Families of lives to fit this study with, two or more, like ``["weibull", "lognormal"]``; or "all".
        threads : int
            Threads of the fits of ``families``, 0 for all. No number depends on it.
        progress : bool or callable, optional
            Of the fits of ``families``: True for a bar, or a function of (what, done, total, seconds).

        Returns
        -------
        Comparison
            Criteria, their differences with standard errors, weights, and parameters.

        Raises
        ------
        InputError
            If there is no other fit or only one family, another number of names, a folder holds no result, or the study has
            no life whose family can be exchanged.

        Warns
        -----
        CheckWarning
            For each family whose fit is not trusted.

        Examples
        --------
        >>> import wearwell as ww
        >>> pumps = {"hours": [312, 480, 510, 640, 700, 700, 150, 260, 420], "failed": [1, 1, 1, 1, 0, 0, 1, 1, 1]}
        >>> fits = [ww.life(pumps, "hours", event="failed", family=each, method="exact", draws=100, report=False)
        ...         for each in ("weibull", "lognormal")]
        >>> sorted(each["study"] for each in fits[0].compare(fits[1], names=["weibull", "lognormal"]).summary["studies"])
        ['lognormal', 'weibull']
        """
        from .compare import compare

        return compare(self, *others, names=names, families=families, threads=threads, progress=progress)

    def against(self, other, *, horizon=None, confidence=0.9, at=None):
        """Compare this life with that of another fit: which lasts longer, and by how much at least.

        The posteriors are independent: the two fits have no data in common. The numbers are those of ``wearwell life --against``.

        Parameters
        ----------
        other : Fit, str or path
            The other fit, or the folder of its result.
        horizon : str or pint quantity, optional
            A use, "1000 h": adds the difference of survival to it.
        confidence : float or str
            Probability with which ``at_least`` is exceeded.
        at : str, optional
            Which life of [predict], where a study has several.

        Returns
        -------
        LivesAgainst
            Ratios of B-lives, the probability to outlive one of the other, and the difference of survival.

        Raises
        ------
        InputError
            If a study has no life of a new item, or their units cannot be compared.

        Warns
        -----
        CheckWarning
            If one of the fits is not trusted.

        Examples
        --------
        >>> import wearwell as ww
        >>> fits = [ww.life({"hours": hours}, "hours", units={"hours": "h"}, method="exact", draws=100, report=False)
        ...         for hours in ([312, 480, 510, 640, 700], [150, 210, 260, 330, 420])]
        >>> found = fits[0].against(fits[1], confidence=0.95)
        >>> found.differences.loc["B10 ratio", ["at_least", "q50"]].round(1).tolist()
        [0.8, 2.3]
        """
        from .against import against

        return against(self, other, horizon, confidence, at)
