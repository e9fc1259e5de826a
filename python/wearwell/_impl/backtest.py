"""Forecasts against units whose end is known: what ``wearwell backtest`` does."""

import functools
import io
import json

from .fitted import population, rows_of


class Backtest:
    """Forecasts of remaining useful life against observed ends, as ``Fit.backtest`` and ``wearwell.backtest`` make them.

    Attributes
    ----------
    summary : dict
        Counts and coverage, as ``wearwell backtest --json`` prints them.
    trusted : bool
        Whether the fit beneath is trusted.

    Examples
    --------
    >>> import wearwell as ww
    >>> fit = ww.fit("examples/fleet/study.toml", seed=1, method="exact", draws=100, report=False)
    >>> test = fit.backtest({"machine": ["M1", "M1"], "use": [500, 1000], "wear": [9.0, 21.0]}, {"machine": ["M1"], "life": [5200]})
    >>> test
    <wearwell.Backtest: 2 forecasts of 1 units, 2 covered>
    """

    @classmethod
    def _of(cls, text, summary, forecasts, trusted):
        self = cls.__new__(cls)
        self.summary, self.trusted, self._text, self._csv = json.loads(summary), trusted, text, forecasts
        return self

    @functools.cached_property
    def forecasts(self):
        """Each forecast with the observed end.

        Returns
        -------
        pandas.DataFrame
            A row for each forecast: the unit, the number of readings it was made with, the position then, the observed life, the
            quantiles ``q05``, ``q50``, ``q95`` of the predicted life along the axis (headings have its unit), and ``place``, the
            predicted probability of an end before the observed one.

        Examples
        --------
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/fleet/study.toml", seed=1, method="exact", draws=100, report=False)
        >>> test = fit.backtest({"machine": ["M1"], "use": [500], "wear": [9.0]}, {"machine": ["M1"], "life": [5200]})
        >>> list(test.forecasts.columns)
        ['machine', 'readings', 'use [h]', 'life [h]', 'q05 [h]', 'q50 [h]', 'q95 [h]', 'place']
        """
        import pandas

        return pandas.read_csv(io.StringIO(self._csv), float_precision="round_trip", dtype={self._csv.split(",", 1)[0]: str})

    @functools.cached_property
    def coverage(self):
        """Coverage of the 90 % intervals by the number of readings.

        Returns
        -------
        pandas.DataFrame
            A row for each group of forecasts by ``readings`` so far, and "all". Columns: ``units``, ``forecasts``, ``covered``,
            the share ``coverage``, the range ``low`` to ``high`` that the coverage of correct intervals has by chance for that
            number of units, and medians of the ``width`` of the interval and of the ``error`` of the predicted median, both
            relative to the true remaining useful life.

        Examples
        --------
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/fleet/study.toml", seed=1, method="exact", draws=100, report=False)
        >>> test = fit.backtest({"machine": ["M1"], "use": [500], "wear": [9.0]}, {"machine": ["M1"], "life": [5200]})
        >>> test.coverage.loc["all", "coverage"]
        1.0
        """
        import pandas

        rows = [{"readings": each["readings"], "units": each["units"], "forecasts": each["forecasts"], "covered": each["held"],
                 "coverage": each["held"] / each["forecasts"], **{k: each[k] for k in ("low", "high", "width", "error")}}
                for each in self.summary["ages"]]
        return pandas.DataFrame(rows).set_index("readings")

    def __str__(self):
        return self._text

    def __repr__(self):
        last = self.summary["ages"][-1]
        return f"<wearwell.Backtest: {last['forecasts']} forecasts of {last['units']} units, {last['held']} covered>"

    def _repr_html_(self):
        return self.coverage.to_html(float_format=lambda x: f"{x:.3g}", border=0)


def backtest(fit, readings, lives):
    """Check forecasts of remaining useful life against units whose end is known.

    Follows each unit from its first reading on and compares every forecast with the observed end, as ``wearwell backtest`` does,
    with the same numbers to the bit.

    Parameters
    ----------
    fit : Fit, str or path
        A fit of a formula with a failure threshold, of bearings, of a joint or of S-N parts, or the folder of its result.
    readings : table, str or path
        Readings in the order of arrival: the columns of the study's data. A column without a unit is in the study's.
    lives : table, str or path
        Observed ends: the column of units and "life"; an empty life for a unit that still runs.

    Returns
    -------
    Backtest
        Coverage by number of readings, and each forecast.

    Raises
    ------
    InputError
        If single units of the study cannot be followed, a column or a cell is wrong, or no unit has a known end.

    Warns
    -----
    CheckWarning
        If the fit is not trusted.

    Examples
    --------
    >>> import wearwell as ww
    >>> fit = ww.fit("examples/fleet/study.toml", seed=1, method="exact", draws=100, report=False)
    >>> test = ww.backtest(fit, {"machine": ["M1", "M1"], "use": [500, 1000], "wear": [9.0, 21.0]},
    ...                    {"machine": ["M1"], "life [h]": [5200]})
    >>> test.summary["units"], test.summary["readings"]
    (1, 2)
    """
    rows, ends = rows_of(readings, "readings"), rows_of(lives, "lives")
    found = population(fit)
    return Backtest._of(*found.backtest(rows, ends), found.trusted)
