"""Wear of radial journal bearings: wear rate, depth, allowable pressure, length and life.

The relation is that of Ligterink and de Gee (Measurement of wear in radial journal bearings, Tribotest 3-1, 1996, 45-54):
p_a k n = A/(4 pi r^2), with the apparent pressure p_a = F/(2 r L), the wear rate k (worn volume per force and sliding distance),
n revolutions, the journal's radius r and the worn cross-section A. The right side is the wear number; it depends only on sigma =
clearance/radius and delta = depth/radius, and on what wears.

Every quantity is a text with its unit, a number (of revolutions), or a pint quantity. An uncertain one gives the answer an interval:
"50 +- 5 um" (standard deviation), "1 MPa +- 5 %", "1e-16 m^3/(N m) x/ 2" (lognormal: two in three within a factor of 2),
"~ lognormal(0.1 mm, 0.005 mm)" (mean, standard deviation), "~ uniform(90 um, 110 um)".
"""

import json

from ._impl import _core
from ._impl.errors import InputError, warn
from ._impl.toml import quantity


def _answer(command, contact, unit, limit, draws, seed, inputs):
    texts = {}
    for name, value in inputs.items():
        if value is not None:
            texts[name.replace("_", "-")] = str(quantity(value, name))
    if not 100 <= int(draws) <= 10_000_000:
        raise InputError(f"draws is {draws}; it must be 100 to 10000000")
    answer, found, margin = _core.bearing(command, contact or "", texts, unit or "", str(limit or ""), int(draws), int(seed))
    for each in found:
        warn(each)
    answer = json.loads(answer)
    if margin:
        answer["margin"] = margin
    return answer


def rate(contact, *, unit=None, draws=100_000, seed=1, **inputs):
    """Wear rate k from a measured depth.

    Parameters
    ----------
    contact : {"stationary", "journal", "bushing"}
        What wears: a scar in a bushing that stands still under a load that stands still; the journal, evenly; or the
        bushing, evenly.
    unit : str, optional
        Unit of the answer; by default SI or a usual one.
    draws : int
        Random draws for the interval, 100 to 10^7.
    seed : int
        Seed of these draws.
    **inputs : str, float or pint quantity
        ``radius`` or ``diameter`` of the journal; ``clearance``, radial: radius of the bushing less that of the
        journal; ``depth`` or ``scar_width``; ``pressure``, or ``force`` and ``length``; ``revolutions``, or
        ``speed`` and ``time``.

    Returns
    -------
    dict
        ``value`` and ``unit``; ``interval``, quantiles q05, q50 and q95 by the draws (and b10 of a life), None where
        every input is exact; ``wear_number``, ``sigma`` and ``delta``; ``scar_width``, value and unit, None where there
        is no scar.

    Raises
    ------
    InputError
        If an input is unknown, missing, given twice, of another dimension or out of its range.

    Warns
    -----
    CheckWarning
        If the scar width is a bad measure of the depth, if the journal has sunk in by more than its widest place, or if
        impossible draws (a negative size) were drawn again.

    Examples
    --------
    The first example of Ligterink and de Gee:

    >>> import wearwell as ww
    >>> k = ww.bearing.rate("stationary", radius="20 mm", clearance="20 um", depth="0.1 mm", pressure="1 MPa",
    ...                     revolutions=100_000)
    >>> print(f"{k['value']:.4g} {k['unit']}, wear number {k['wear_number']:.4g}")
    7.186e-15 m^3/(N m), wear number 0.0007186
    """
    return _answer("rate", contact, unit, None, draws, seed, inputs)


def depth(contact, *, unit=None, limit=None, draws=100_000, seed=1, **inputs):
    """Wear depth after a number of revolutions.

    Parameters
    ----------
    contact : {"stationary", "journal", "bushing"}
        What wears: a scar in a bushing that stands still under a load that stands still; the journal, evenly; or the
        bushing, evenly.
    unit : str, optional
        Unit of the answer; by default SI or a usual one.
    limit : str, optional
        Failure threshold of the depth, with its unit: the answer then has its margin.
    draws : int
        Random draws for the interval, 100 to 10^7.
    seed : int
        Seed of these draws.
    **inputs : str, float or pint quantity
        ``radius`` or ``diameter`` of the journal; ``clearance``, radial: radius of the bushing less that of the
        journal; ``rate``, the wear rate k; ``pressure``, or ``force`` and ``length``; ``revolutions``, or ``speed``
        and ``time``.

    Returns
    -------
    dict
        ``value`` and ``unit``; ``interval``, quantiles q05, q50 and q95 by the draws (and b10 of a life), None where
        every input is exact; ``wear_number``, ``sigma`` and ``delta``; ``scar_width``, value and unit, None where there
        is no scar; with ``limit`` ``margin``, a
        sentence.

    Raises
    ------
    InputError
        If an input is unknown, missing, given twice, of another dimension or out of its range.

    Warns
    -----
    CheckWarning
        If the scar width is a bad measure of the depth, if the journal has sunk in by more than its widest place, or if
        impossible draws (a negative size) were drawn again.

    Examples
    --------
    >>> import wearwell as ww
    >>> depth = ww.bearing.depth("stationary", radius="20 mm", clearance="20 um", rate="7.186e-15 m^3/(N m)",
    ...                          pressure="1 MPa", revolutions=100_000, limit="0.2 mm")
    >>> round(depth["value"], 3), depth["unit"]
    (0.1, 'mm')
    >>> "50 % below the limit of 0.2 mm" in depth["margin"].replace("\\xa0", " ")
    True
    """
    return _answer("depth", contact, unit, limit, draws, seed, inputs)


def pressure(contact, *, unit=None, draws=100_000, seed=1, **inputs):
    """Apparent pressure p_a under which the wear depth is reached after a number of revolutions.

    Parameters
    ----------
    contact : {"stationary", "journal", "bushing"}
        What wears: a scar in a bushing that stands still under a load that stands still; the journal, evenly; or the
        bushing, evenly.
    unit : str, optional
        Unit of the answer; by default SI or a usual one.
    draws : int
        Random draws for the interval, 100 to 10^7.
    seed : int
        Seed of these draws.
    **inputs : str, float or pint quantity
        ``radius`` or ``diameter`` of the journal; ``clearance``, radial: radius of the bushing less that of the
        journal; ``rate``, the wear rate k; ``depth`` or ``scar_width``, the depth allowed; ``revolutions``, or
        ``speed`` and ``time``.

    Returns
    -------
    dict
        ``value`` and ``unit``; ``interval``, quantiles q05, q50 and q95 by the draws (and b10 of a life), None where
        every input is exact; ``wear_number``, ``sigma`` and ``delta``; ``scar_width``, value and unit, None where there
        is no scar.

    Raises
    ------
    InputError
        If an input is unknown, missing, given twice, of another dimension or out of its range.

    Warns
    -----
    CheckWarning
        If the scar width is a bad measure of the depth, if the journal has sunk in by more than its widest place, or if
        impossible draws (a negative size) were drawn again.

    Examples
    --------
    >>> import wearwell as ww
    >>> p = ww.bearing.pressure("stationary", radius="20 mm", clearance="20 um", rate="7.186e-15 m^3/(N m)",
    ...                         depth="0.1 mm", revolutions=100_000)
    >>> round(p["value"], 3), p["unit"]
    (1.0, 'MPa')
    """
    return _answer("pressure", contact, unit, None, draws, seed, inputs)


def length(contact, *, unit=None, draws=100_000, seed=1, **inputs):
    """Bearing length L with which a force wears to the depth in a number of revolutions.

    Parameters
    ----------
    contact : {"stationary", "journal", "bushing"}
        What wears: a scar in a bushing that stands still under a load that stands still; the journal, evenly; or the
        bushing, evenly.
    unit : str, optional
        Unit of the answer; by default SI or a usual one.
    draws : int
        Random draws for the interval, 100 to 10^7.
    seed : int
        Seed of these draws.
    **inputs : str, float or pint quantity
        ``radius`` or ``diameter`` of the journal; ``clearance``, radial: radius of the bushing less that of the
        journal; ``rate``, the wear rate k; ``depth`` or ``scar_width``, the depth allowed; ``force``;
        ``revolutions``, or ``speed`` and ``time``.

    Returns
    -------
    dict
        ``value`` and ``unit``; ``interval``, quantiles q05, q50 and q95 by the draws (and b10 of a life), None where
        every input is exact; ``wear_number``, ``sigma`` and ``delta``; ``scar_width``, value and unit, None where there
        is no scar.

    Raises
    ------
    InputError
        If an input is unknown, missing, given twice, of another dimension or out of its range.

    Warns
    -----
    CheckWarning
        If the scar width is a bad measure of the depth, if the journal has sunk in by more than its widest place, or if
        impossible draws (a negative size) were drawn again.

    Examples
    --------
    >>> import wearwell as ww
    >>> bearing = ww.bearing.length("stationary", radius="20 mm", clearance="20 um", rate="7.186e-15 m^3/(N m)",
    ...                             depth="0.1 mm", force="1 kN", revolutions=100_000)
    >>> round(bearing["value"], 1), bearing["unit"]
    (25.0, 'mm')
    """
    return _answer("length", contact, unit, None, draws, seed, inputs)


def life(contact, *, unit=None, draws=100_000, seed=1, **inputs):
    """Life until the wear depth is reached: in revolutions, or with ``speed`` in time.

    Parameters
    ----------
    contact : {"stationary", "journal", "bushing"}
        What wears: a scar in a bushing that stands still under a load that stands still; the journal, evenly; or the
        bushing, evenly.
    unit : str, optional
        Unit of the answer; by default SI or a usual one.
    draws : int
        Random draws for the interval, 100 to 10^7.
    seed : int
        Seed of these draws.
    **inputs : str, float or pint quantity
        ``radius`` or ``diameter`` of the journal; ``clearance``, radial: radius of the bushing less that of the
        journal; ``rate``, the wear rate k; ``depth`` or ``scar_width``, the depth allowed; ``pressure``, or
        ``force`` and ``length``; ``speed``, optional.

    Returns
    -------
    dict
        ``value`` and ``unit``; ``interval``, quantiles q05, q50 and q95 by the draws (and b10 of a life), None where
        every input is exact; ``wear_number``, ``sigma`` and ``delta``; ``scar_width``, value and unit, None where there
        is no scar.

    Raises
    ------
    InputError
        If an input is unknown, missing, given twice, of another dimension or out of its range.

    Warns
    -----
    CheckWarning
        If the scar width is a bad measure of the depth, if the journal has sunk in by more than its widest place, or if
        impossible draws (a negative size) were drawn again.

    Examples
    --------
    >>> import wearwell as ww
    >>> life = ww.bearing.life("journal", radius="10 mm", clearance="20 um", depth="50 +- 5 um",
    ...                        rate="1e-16 m^3/(N m) +- 10 %", pressure="2 MPa", speed="60 rpm")
    >>> round(life["value"]), life["unit"], round(life["interval"]["b10"], -2)
    (3481, 'h', 2900.0)
    """
    return _answer("life", contact, unit, None, draws, seed, inputs)
