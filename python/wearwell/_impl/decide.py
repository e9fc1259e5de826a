"""The cheapest replacement age, inspection interval and stock of spare parts."""

from .errors import InputError
from .plan import answer
from .study import Study


def decide(lives, *, failure_cost, replacement_cost, at=None, in_service=None, inspection_cost=None, downtime_cost=None, month=None,
           months=12, service_level=0.95, claims=None, unit=None, inspect_after=None, given=None, progress=None):
    """Find the cheapest replacement age, inspection interval, warranty and stock of spare parts.

    Answers what ``wearwell decide`` answers, with the same numbers to the bit. The interpreter's lock is released.

    Parameters
    ----------
    lives : Fit, table, str or path
        A fit of lives, of a formula with a failure threshold, of bearings, or of S-N parts; the folder of its result; or a
        table of lives with the column "life [h]" and optionally weight, unit and population, or its file.
    failure_cost, replacement_cost : float or str
        Cost of a failure in service with its replacement, and of a preventive replacement, "12000 EUR".
    at : str, optional
        Which life of [predict], for a fit of lives that has several.
    in_service : table, str or path, optional
        Running units, for a fit of lives: columns unit, "age [h]", and in_study (yes where the study has the unit as a
        run-out of this age).
    inspection_cost : float or str, optional
        Cost of one inspection; adds the optimal interval.
    downtime_cost : str, optional
        Cost of an undetected failure, "5 EUR/h": failures are hidden until an inspection.
    month : str or pint quantity, optional
        Use of a unit per month, "600 h": adds the failures and spare parts by month.
    months : int
        Number of months ahead.
    service_level : float or str
        Probability that the spare parts suffice.
    claims : float or str, optional
        Share of units that may fail under warranty, "2 %": adds its length.
    unit : str, optional
        One running unit: adds the value of another reading of it; with ``inspect_after``.
    inspect_after : str or pint quantity, optional
        Use from now until that reading, "5 km".
    given : dict or sequence of str, optional
        Conditions of that reading, ``{"force": "20 N"}``.
    progress : bool or callable, optional
        True for a bar, or a function of (what, done, total, seconds). An exception in it stops the work.

    Returns
    -------
    Plan
        The decisions. ``summary["age"]`` has the replacement age and its cost, ``tables["units"]`` each running unit,
        ``tables["fleet"]`` the months.

    Raises
    ------
    InputError
        If an argument, a unit or a cell of a table is wrong; the message names it.

    Warns
    -----
    CheckWarning
        If the fit is not trusted.

    Examples
    --------
    >>> import wearwell as ww
    >>> lives = {"life [h]": [1200, 1500, 1900, 2300, 2600, 3100, 3600]}
    >>> decisions = ww.decide(lives, failure_cost="12000 EUR", replacement_cost="900 EUR", claims="5 %")
    >>> round(decisions.summary["age"]["at"]), decisions.summary["unit"]
    (1200, 'h')
    >>> list(decisions.tables)
    ['policies']
    >>> ww.decide(lives, failure_cost="12000 EUR", replacement_cost="900 USD")
    Traceback (most recent call last):
        ...
    wearwell.InputError: replacement_cost: ...
    """
    if isinstance(lives, Study):
        raise InputError("lives is Study; it is a fit, the folder of a result, or a table of lives")
    return answer("decide", {
        "at": at, "failure_cost": failure_cost, "replacement_cost": replacement_cost, "inspection_cost": inspection_cost,
        "downtime_cost": downtime_cost, "month": month, "months": months, "service_level": service_level, "claims": claims,
        "unit": unit, "inspect_after": inspect_after, "given": given,
    }, lives, "lives", {"in_service": in_service}, 0, progress)
