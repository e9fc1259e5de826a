"""What comes after a fit: new rows, single units, forecasts against known ends, code."""

import functools

from ._update import described


class FitFollowing:
    """Updates, trackers, backtests and exports of a fit. Part of ``Fit``."""

    @functools.cached_property
    def _population(self):
        from ._fitted import population_of

        return population_of(self)

    @functools.partial(described, indent=4)
    def update(self, data, repeated=None, *, threads=0, report=True, progress=None):
        """Fit the study again with new rows, as ``wearwell update``: with the method, chains, draws and seed of this fit.

        Parameters
        ----------
        <new rows>

        Returns
        -------
        <updated fit>

        Raises
        ------
        <errors of update>

        Warns
        -----
        CheckWarning
            For each check that warns or fails: new rows that contradict the earlier posterior.

        Examples
        --------
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/joint/study.toml", seed=1, method="exact", draws=100, report=False)
        >>> june = fit.update({"cycles": [18000], "volume_mm3": [83.0]}, report=False)
        >>> july = june.update({"cycles": [20000], "volume_mm3": [92.0]}, report=False)
        >>> july.results["update"]["rows_before"], july.results["update"]["counted"]
        (13, 1)
        """
        from ._update import update

        return update(self, data, repeated, threads=threads, report=report, progress=progress)

    def track(self, unit=None, *, new=False):
        """Follow one unit by its readings.

        Parameters
        ----------
        unit : str, optional
            A unit of the study, which starts with its readings there; with ``new`` the name of a new one. May be left out
            where the study has one unit only.
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
        >>> rul = fit.track("M7", new=True).update({"use": 500, "wear": 9.1}).rul
        >>> rul.q05 < rul.q50 < rul.q95, rul.unit
        (True, 'h')
        """
        from ._track import track

        return track(self, unit, new=new)

    def backtest(self, readings, lives):
        """Check forecasts of remaining useful life against units whose end is known, as ``wearwell backtest``.

        Parameters
        ----------
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
        >>> test = fit.backtest({"machine": ["M1", "M1"], "use": [500, 1000], "wear": [9.0, 21.0]}, {"machine": ["M1"], "life": [5200]})
        >>> test.coverage.loc["all", "forecasts"]
        2
        """
        from ._backtest import backtest

        return backtest(self, readings, lives)

    def export_c(self, folder, *, name="unit", unit=None, lines=None):
        """Write one unit of a fitted formula as C99 for a controller, as ``wearwell export c``.

        Parameters
        ----------
        folder : str or path
            Folder for NAME_unit.h, NAME_unit.c and NAME_test.c. Files of an earlier result are replaced.
        name : str
            Prefix of the names of files and functions.
        unit : str, optional
            A unit of the study, conditioned on its readings; by default a new unit.
        lines : int, optional
            Points of the posterior, 16 to 20 000: more are more precise and need more memory. By default as in the monitor.

        Returns
        -------
        str
            Number of nodes, and sizes of the tables in bytes.

        Raises
        ------
        InputError
            If the study is of another model, its formula or scatter cannot be exported, or an argument is wrong.
        MachineError
            If the disk fails.

        Warns
        -----
        CheckWarning
            If the fit is not trusted.

        Examples
        --------
        >>> import os, tempfile
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/fleet/study.toml", seed=1, method="exact", draws=100, report=False)
        >>> sizes = fit.export_c(os.path.join(tempfile.mkdtemp(), "pump"), name="pump", unit="L1", lines=64)
        >>> "per unit" in sizes
        True
        """
        from ._export import export_c

        return export_c(self, folder, name=name, unit=unit, lines=lines)

    def export_sql(self, dialect, table, *, value=None, unit=None, columns=None, keep=None, prefix="wearwell", draws=400, part="all"):
        """SQL that computes a value of a fitted formula with its interval for every row of a table, as ``wearwell export sql``.

        Parameters
        ----------
        dialect : {"duckdb", "postgresql", "clickhouse"}
            The database.
        table : str
            SCHEMA.TABLE; a part in double quotes may hold dots.
        value : str, optional
            An expression of the formula; by default the one that the first measured column observes.
        unit : str, optional
            Unit of the answer.
        columns : dict of str to str, or sequence of str, optional
            Columns of the table that have other names or units than the study: ``{"force": "F:kN"}``, or "force=F:kN".
        keep : str or sequence of str, optional
            Further columns of the table to include in the answer.
        prefix : str
            Name of the table of draws that the statements create.
        draws : int
            Number of draws, a multiple of 20; more give more precise intervals.
        part : {"all", "setup", "query"}
            Both statements or one of them.

        Returns
        -------
        str
            The statements, with comments.

        Raises
        ------
        InputError
            If the study is of another model, a name, unit or expression is wrong, or the engine cannot compute it.

        Warns
        -----
        CheckWarning
            If the fit is not trusted.

        Examples
        --------
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/fleet/study.toml", seed=1, method="exact", draws=100, report=False)
        >>> sql = fit.export_sql("postgresql", "fleet.liners", columns={"use": "hours:h"}, draws=20, part="query")
        >>> "formula_q50" in sql
        True
        """
        from ._export import export_sql

        return export_sql(self, dialect, table, value=value, unit=unit, columns=columns, keep=keep, prefix=prefix, draws=draws, part=part)
