"""Lives of one fit against those of another: what ``wearwell life --against`` does."""

import functools

from .answer import Answer
from .errors import InputError, warn
from .fitted import fitted
from .question import found

_keys = ("at_least", "q05", "q50", "q95", "mean", "better")


def _number(value):
    """JSON has no infinity: a ratio to a life that ends is null where the other never does."""
    return float("inf") if value is None else value


class LivesAgainst(Answer):
    """Lives of one fit against those of another, as ``Fit.against`` finds them.

    Parameters
    ----------
    *parts
        What the library answers; ``Fit.against`` makes a LivesAgainst.

    Attributes
    ----------
    title : str
        The two lives.
    summary : dict
        All numbers, as ``wearwell life --against --json`` prints them.
    json : str
        The same as text.
    trusted : bool
        Whether both fits are trusted.

    Examples
    --------
    >>> import wearwell as ww
    >>> fits = [ww.life({"hours": hours}, "hours", units={"hours": "h"}, method="exact", draws=100, report=False)
    ...         for hours in ([312, 480, 510, 640, 700], [150, 210, 260, 330, 420])]
    >>> fits[0].against(fits[1])
    <wearwell.LivesAgainst 'fit, unit against other, unit'>
    """

    _file = "against"

    def __init__(self, *parts):
        super().__init__(*parts)
        if not self.trusted:
            warn("a fit that this rests on is not trusted: see its checks")

    @property
    def outlives(self):
        """Probability that the next item of the first outlives the next one of the other.

        Returns
        -------
        float
            Averaged over both posteriors; 1/2 where the lives are the same.

        Examples
        --------
        >>> import wearwell as ww
        >>> fits = [ww.life({"hours": hours}, "hours", units={"hours": "h"}, method="exact", draws=100, report=False)
        ...         for hours in ([312, 480, 510, 640, 700], [150, 210, 260, 330, 420])]
        >>> fits[0].against(fits[1]).outlives > 0.7
        True
        """
        return self.summary["outlives"]["mean"]

    @functools.cached_property
    def differences(self):
        """What is compared, a row each.

        Returns
        -------
        pandas.DataFrame
            Rows: ``B10 ratio`` for each B-life that both reach (this life over the other), ``outlives`` and, with ``horizon``,
            ``survival difference``. Columns: ``at_least``, exceeded with the confidence; the quantiles ``q05``, ``q50``, ``q95``
            and the ``mean`` over both posteriors; ``better``, the probability that the first is better in this respect.

        Examples
        --------
        >>> import wearwell as ww
        >>> fits = [ww.life({"hours": hours}, "hours", units={"hours": "h"}, method="exact", draws=100, report=False)
        ...         for hours in ([312, 480, 510, 640, 700], [150, 210, 260, 330, 420])]
        >>> fits[0].against(fits[1], horizon="300 h").differences["q50"].round(1)
        B1 ratio               2.8
        B10 ratio              2.3
        B50 ratio              1.9
        outlives               0.8
        survival difference    0.4
        Name: q50, dtype: float64
        """
        import pandas

        rows = {f"B{each['percent']:g} ratio": each for each in self.summary["ratios"]}
        rows["outlives"] = self.summary["outlives"]
        if "survival_difference" in self.summary:
            rows["survival difference"] = self.summary["survival_difference"]
        return pandas.DataFrame([[_number(row[key]) for key in _keys] for row in rows.values()], index=list(rows), columns=list(_keys))


def against(fit, other, horizon, confidence, at):
    """What Fit.against answers."""
    try:
        run, path = fitted(other)
    except InputError as error:
        raise InputError(str(error).replace("fit is", "other is", 1)) from None
    arguments = {"at": at, "horizon": horizon, "confidence": confidence, "other": path or None}
    return LivesAgainst(*found("against", arguments, fit, "fit", other=run))
