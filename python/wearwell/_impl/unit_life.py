"""The life of a new unit, or the remaining useful life of one of the data: what ``wearwell life`` answers."""

from .errors import InputError
from .plan import answer
from .study import Study


def unit_life(fit, unit=None, *, survived=None, horizon=None, risk=None, level=None, sides=None):
    """The life of a new unit, or the remaining useful life of one of the data.

    Answers what ``wearwell life`` answers, with the same numbers to the bit.

    Parameters
    ----------
    fit : Fit, str or path
        A fit, or the folder of its result.
    unit : str, optional
        A unit of the data, or a life that the study predicts; by default a new unit.
    survived : str or pint quantity, optional
        The use that the unit has survived, "1e4 cycles".
    horizon : str or pint quantity, optional
        A use from then on, "500 h": adds the probability that the life ends within it.
    risk : str, optional
        Risk tolerated until the next inspection, "1 %": adds the use until then.
    level : float or str, optional
        Probability of bounds of the life, "95 %", beside the interval of 90 %.
    sides : {"lower", "upper", "both"}, optional
        Which bounds; with ``level``.

    Returns
    -------
    Plan
        The answer. ``print`` shows its sentences, ``summary`` has its numbers as ``wearwell life --json`` prints them, and
        ``tables["survival"]`` is the survival curve.

    Raises
    ------
    InputError
        If an argument is wrong, the fit has no such unit, or it predicts no life; the message names it.

    Warns
    -----
    CheckWarning
        If the fit is not trusted.

    Examples
    --------
    >>> import wearwell as ww
    >>> pumps = {"hours": [312, 480, 510, 640, 700, 700, 150, 260, 420], "failed": [1, 1, 1, 1, 0, 0, 1, 1, 1]}
    >>> fit = ww.life(pumps, "hours", event="failed", units={"hours": "h"}, method="exact", draws=100, report=False)
    >>> survivor = ww.unit_life(fit, survived="300 h", horizon="100 h")
    >>> survivor.summary["name"], survivor.summary["unit"]
    ('remaining useful life', 'h')
    >>> ww.unit_life(fit, survived="3 kg")
    Traceback (most recent call last):
        ...
    wearwell.InputError: survived: ...
    """
    if isinstance(fit, Study):
        raise InputError("fit is Study; it is a fit, or the folder of a result")
    return answer("life", {"unit": unit, "survived": survived, "horizon": horizon, "risk": risk, "level": level, "sides": sides}, fit, "fit")
