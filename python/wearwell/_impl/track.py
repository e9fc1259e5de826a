"""One unit followed by its readings."""

import json
import math
from typing import NamedTuple

from . import _core
from .errors import InputError, warn
from .fitted import columns_of, population, rows_of
from .toml import quantity

_nan, _inf = float("nan"), float("inf")
_worth_a_word = 0.05  # a probability of having passed the threshold


class Quantiles(NamedTuple):
    """Three quantiles with their unit.

    Attributes
    ----------
    q05, q50, q95 : float
        Quantiles. NaN: nothing determines them; infinity: the threshold may never be reached.
    unit : str
        Their unit.

    Parameters
    ----------
    q05, q50, q95 : float
        Quantiles.
    unit : str
        Their unit.

    Examples
    --------
    >>> import wearwell as ww
    >>> rul = ww.Quantiles(118.0, 290.0, 490.0, "h")
    >>> rul.q50
    290.0
    """

    q05: float
    q50: float
    q95: float
    unit: str


class UnitTracker:
    """One unit on line: readings in, remaining useful life out. ``Fit.track`` and ``wearwell.track`` make it.

    A reading multiplies the weights of the fit's nodes, so nothing is fitted again, and the numbers are those of
    ``wearwell monitor`` to the bit. One thread at a time.

    Attributes
    ----------
    unit : str
        Name of the unit.
    is_new : bool
        Whether it is a new unit; else it began with its readings in the study.

    Examples
    --------
    >>> import wearwell as ww
    >>> fit = ww.fit("examples/fleet/study.toml", seed=1, method="exact", draws=100, report=False)
    >>> machine = fit.track("M7", new=True)
    >>> machine.update({"use": 500, "wear": 9.1}).update({"use": 1000, "wear": 21.3})
    <wearwell.UnitTracker of new machine 'M7': 2 readings, remaining useful life 3200 to 4500 h (90 %)>
    """

    @classmethod
    def _of(cls, fit, unit, new):
        self = cls.__new__(cls)
        self._begin(fit, unit, new)
        return self

    def _begin(self, fit, unit, new):
        self._fit, self._followed, self._outcomes, self._taken = fit, _core.FollowedUnit(population(fit), unit, new), [], []
        start = self.summary
        self.unit, self.is_new, self._noun = start["unit"], start["new"], start["noun"]

    def __getstate__(self):
        return {"fit": self._fit, "unit": self.unit, "new": self.is_new, "outcomes": self._outcomes, "taken": self._taken}

    def __setstate__(self, state):
        """The readings are taken again: the same numbers to the bit."""
        self._begin(state["fit"], state["unit"], state["new"])
        for columns in state["taken"]:
            self._followed.update(_core.table_of("rows", columns))
        self._outcomes, self._taken = state["outcomes"], state["taken"]

    def update(self, rows):
        """Take readings.

        Parameters
        ----------
        rows : dict, table, str or path
            One reading as a dict of values, or a table of readings in the order in which they were taken, with the columns of
            the study's data. A column without a unit is in the study's. A column of units may only name this unit. A row that
            equals an earlier one counts once.

        Returns
        -------
        UnitTracker
            The tracker itself.

        Raises
        ------
        InputError
            If a column is missing, a cell is wrong, or a row is of another unit; then none of the rows is taken.

        Warns
        -----
        CheckWarning
            For a reading that is hardly possible given the earlier ones, or impossible for every unit of the population; the
            latter does not count.

        Examples
        --------
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/fleet/study.toml", seed=1, method="exact", draws=100, report=False)
        >>> machine = fit.track("L1").update({"use": [3600, 3900], "wear": [88.0, 96.0]})
        >>> machine.summary["quality"]["readings"]
        2
        """
        table = rows_of(rows, "rows")
        outcomes = json.loads(self._followed.update(table))
        self._taken.append(columns_of(table))
        for row, each in enumerate(outcomes):
            if not each["counted"] and not each["repeated"]:
                warn(f"row {row + 1} does not count: {each['problem']}")
            elif each["contradicts"]:
                warn(f"row {row + 1} contradicts the earlier readings of {self._noun} '{self.unit}' "
                     f"(predictive p-value {each['p_value']:.1g}); it counts")
        self._outcomes += outcomes
        return self

    @property
    def summary(self):
        """The forecast and what is known of the readings.

        Returns
        -------
        dict
            With the names of the monitor's API: ``axis``, ``axis_unit``, ``limited``, ``level_unit``, ``limit``, ``known``,
            ``at``, ``level``, ``remaining``, ``b10``, ``numerical_error``, ``passed``, ``rate_change``, ``doubt``, ``beyond``, ``quality``. None
            stands for a number that is not finite.

        Examples
        --------
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/fleet/study.toml", seed=1, method="exact", draws=100, report=False)
        >>> machine = fit.track("L1").summary
        >>> machine["at"], machine["axis_unit"], machine["limit"]
        (3349.0, 'h', 100.0)
        """
        return json.loads(self._followed.json())

    @property
    def rul(self):
        """Remaining useful life from now on, given that the threshold is not reached yet.

        Returns
        -------
        Quantiles
            Quantiles at 5, 50 and 95 %, along the axis of life.

        Examples
        --------
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/fleet/study.toml", seed=1, method="exact", draws=100, report=False)
        >>> rul = fit.track("L1").rul
        >>> round(rul.q50, -1), rul.unit
        (680.0, 'h')
        """
        found = self.summary
        return _quantiles(found, "remaining", found["axis_unit"], _inf)

    @property
    def level(self):
        """The quantity with the threshold now, such as wear.

        Returns
        -------
        Quantiles
            Quantiles at 5, 50 and 95 %.

        Examples
        --------
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/fleet/study.toml", seed=1, method="exact", draws=100, report=False)
        >>> level = fit.track("L1").level
        >>> round(level.q50), level.unit
        (83, 'um')
        """
        found = self.summary
        return _quantiles(found, "level", found["level_unit"], _nan)

    @property
    def doubt(self):
        """Why the forecast is in doubt: the readings have stopped following it.

        Returns
        -------
        str or None
            The reason; None if it is not in doubt.

        Examples
        --------
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/fleet/study.toml", seed=1, method="exact", draws=100, report=False)
        >>> fit.track("L1").doubt is None
        True
        """
        return self.summary["doubt"]

    @property
    def rate_change(self):
        """Whether the rate has changed, of a study with ``predict.rate_change``.

        Returns
        -------
        dict or None
            ``probability``; ``since`` (along the axis, in ``summary["axis_unit"]``) and ``factor`` (the new rate as a multiple of the
            earlier one), each a dict of ``q05``, ``q50``, ``q95``, if it has changed. None in a study without ``predict.rate_change``.

        Examples
        --------
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/fleet/study.toml", seed=1, method="exact", draws=100, report=False)
        >>> fit.track("L1").rate_change is None
        True
        """
        return self.summary["rate_change"]

    @property
    def passed(self):
        """Probability that the threshold is passed already; ``rul`` is given that it is not.

        Returns
        -------
        float
            The probability; NaN if nothing determines it.

        Examples
        --------
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/fleet/study.toml", seed=1, method="exact", draws=100, report=False)
        >>> fit.track("L1").passed < 0.01
        True
        """
        found = self.summary["passed"]
        return _nan if found is None else found

    def risk(self, within):
        """Probability that the threshold is reached within a use from now on.

        Parameters
        ----------
        within : str or pint quantity
            The use, "500 h".

        Returns
        -------
        float
            The probability, with that of having passed the threshold already; NaN if nothing determines it.

        Raises
        ------
        InputError
            If ``within`` is no quantity along the axis.

        Examples
        --------
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/fleet/study.toml", seed=1, method="exact", draws=100, report=False)
        >>> machine = fit.track("L1")
        >>> machine.risk("100 h") < machine.risk("800 h")
        True
        """
        if isinstance(within, (int, float)) and not isinstance(within, bool):
            within = f"{within!r} {self.summary['axis_unit']}"
        return self._followed.risk(within if isinstance(within, str) else str(quantity(within, "within")))

    def path(self):
        """How the unit is expected to continue.

        Returns
        -------
        pandas.DataFrame
            A row for each position along the axis, from now until 95 % have reached the threshold, indexed by it, with the
            quantiles ``q05``, ``q50``, ``q95`` of the quantity with the threshold; ``attrs["unit"]`` is their unit.

        Examples
        --------
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/fleet/study.toml", seed=1, method="exact", draws=100, report=False)
        >>> path = fit.track("L1").path()
        >>> path.index.name, path.attrs["unit"], path["q50"].is_monotonic_increasing
        ('use', 'um', True)
        """
        import pandas

        at, low, middle, high = self._followed.path()
        found = self.summary
        frame = pandas.DataFrame({"q05": low, "q50": middle, "q95": high}, index=pandas.Index(at, name=found["axis"]))
        frame.attrs["unit"], frame.attrs["axis_unit"] = found["level_unit"], found["axis_unit"]
        return frame

    @property
    def outcomes(self):
        """What became of each row.

        Returns
        -------
        pandas.DataFrame
            A row for each row of every update: ``counted``, ``repeated``, ``contradicts``, ``p_value`` (predictive, two-sided) and
            ``problem``, why it does not count.

        Examples
        --------
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/fleet/study.toml", seed=1, method="exact", draws=100, report=False)
        >>> machine = fit.track("L1").update({"use": [3600, 3600], "wear": [88.0, 88.0]})
        >>> machine.outcomes["repeated"].tolist()
        [False, True]
        """
        import pandas

        return pandas.DataFrame(self._outcomes, columns=["counted", "repeated", "contradicts", "p_value", "problem"])

    def __repr__(self):
        found = self.summary
        rul = _quantiles(found, "remaining", found["axis_unit"], _inf)
        n = found["quality"]["readings"]
        text = (f"<wearwell.UnitTracker of {'new ' if self.is_new else ''}{self._noun} '{self.unit}': "
                f"{n} {'' if self.is_new else 'new '}reading{'' if n == 1 else 's'}, ")
        if not found["known"]:
            return text + "nothing determines how it continues>"
        low, high = (f"{each:.4g}" if math.isinf(each) else _four(each) for each in (rul.q05, rul.q95))
        if found["passed"] is not None and found["passed"] > _worth_a_word:
            text += f"threshold passed with probability {100 * found['passed']:.0f} %, if not "
        return text + f"remaining useful life {low} to {high} {rul.unit} (90 %){', in doubt' if found['doubt'] else ''}>"


def _four(value):
    """Two significant digits, without an exponent."""
    return f"{float(f'{value:.2g}'):g}" if value < 1e15 else f"{value:.2g}"


def _quantiles(found, key, unit, infinite):
    if not found["known"]:
        return Quantiles(_nan, _nan, _nan, unit)
    return Quantiles(*(infinite if found[key][q] is None else found[key][q] for q in ("q05", "q50", "q95")), unit)


def track(fit, unit=None, *, new=False):
    """Follow one unit by its readings.

    Parameters
    ----------
    fit : Fit, str or path
        A fit of a formula with a failure threshold, of bearings, of a joint or of S-N parts, or the folder of its result.
    unit : str, optional
        A unit of the study, which starts with its readings there; with ``new`` the name of a new one. May be left out where
        the study has one unit only.
    new : bool
        Whether the unit is a new one of the same population.

    Returns
    -------
    UnitTracker
        The unit: ``update(row)`` takes readings, ``rul`` is its remaining useful life.

    Raises
    ------
    InputError
        If single units of the study cannot be followed, it has no such unit, or has one though ``new`` is true.

    Warns
    -----
    CheckWarning
        If the fit is not trusted.

    Examples
    --------
    >>> import wearwell as ww
    >>> fit = ww.fit("examples/fleet/study.toml", seed=1, method="exact", draws=100, report=False)
    >>> ww.track(fit, "L1").update({"use": 3600, "wear": 88.0}).rul.unit
    'h'
    >>> ww.track(fit, "M7")
    Traceback (most recent call last):
        ...
    wearwell.InputError: unit: the study has no machine 'M7'; ...
    """
    if unit is not None and (not isinstance(unit, str) or not unit):
        raise InputError(f"unit is {unit!r}; it is the name of a unit, a text")
    if not isinstance(new, bool):
        raise InputError(f"new is {new!r}; it is True or False")
    return UnitTracker._of(fit, unit or "", new)
