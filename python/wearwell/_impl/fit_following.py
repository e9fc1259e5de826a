"""What comes after a fit: new rows, single units, forecasts against known ends, damage under load histories, code."""

import functools

from .backtest import backtest as _backtest
from .export import export_c as _export_c
from .export import export_sql as _export_sql
from .fit_options import like_function
from .spectra import damage as _damage
from .spectra import design as _design
from .track import track as _track
from .update import update as _update


class FitFollowing:
    """Updates, trackers, backtests, damage and exports of a fit. Part of ``Fit``."""

    @functools.cached_property
    def _population(self):
        from .fitted import population_of

        return population_of(self)

    @like_function(_update)
    def update(self, data, repeated=None, *, threads=0, report=True, progress=None):
        """Fit the study again with new rows, as ``wearwell update``: with the method, chains, draws and seed of this fit.

        <as the function>

        Examples
        --------
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/joint/study.toml", seed=1, method="exact", draws=100, report=False)
        >>> june = fit.update({"cycles": [18000], "volume_mm3": [83.0]}, report=False)
        >>> july = june.update({"cycles": [20000], "volume_mm3": [92.0]}, report=False)
        >>> july.results["update"]["rows_before"], july.results["update"]["counted"]
        (13, 1)
        """
        return _update(self, data, repeated, threads=threads, report=report, progress=progress)

    @like_function(_track)
    def track(self, unit=None, *, new=False):
        """Follow one unit by its readings.

        <as the function>

        Examples
        --------
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/fleet/study.toml", seed=1, method="exact", draws=100, report=False)
        >>> rul = fit.track("M7", new=True).update({"use": 500, "wear": 9.1}).rul
        >>> rul.q05 < rul.q50 < rul.q95, rul.unit
        (True, 'h')
        """
        return _track(self, unit, new=new)

    @like_function(_backtest)
    def backtest(self, readings, lives):
        """Check forecasts of remaining useful life against units whose end is known, as ``wearwell backtest``.

        <as the function>

        Examples
        --------
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/fleet/study.toml", seed=1, method="exact", draws=100, report=False)
        >>> test = fit.backtest({"machine": ["M1", "M1"], "use": [500, 1000], "wear": [9.0, 21.0]}, {"machine": ["M1"], "life": [5200]})
        >>> test.coverage.loc["all", "forecasts"]
        2
        """
        return _backtest(self, readings, lives)

    @like_function(_damage)
    def damage(self, loads, *, column=None, units=None, method="four-point", residual="half", time=None, scale=None, rule=None, knee=None,
               damage_sum="1 x/ 1.34", block=None, b=(1, 10, 50), confidence=0.9, progress=None):
        """Sum the damage of a load history along this S-N curve, and find the life under it, as ``wearwell fatigue life``.

        <as the function>

        Examples
        --------
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/spectrum/study.toml", seed=1, method="exact", draws=100, report=False)
        >>> found = fit.damage("examples/spectrum/loads.csv", column="stress", block="350 km")
        >>> print(f"{found.life.q50:.3g} {found.life.unit}")
        1.74e+07 km
        """
        return _damage(self, loads, column=column, units=units, method=method, residual=residual, time=time, scale=scale, rule=rule,
                       knee=knee, damage_sum=damage_sum, block=block, b=b, confidence=confidence, progress=progress)

    def design(self, *others, names=None, stress=None, mean_stress=None, stress_ratio=None, reliability=None, confidence=None,
               progress=None):
        """Design curves of this S-N fit, or averaged over it and others of the same tests, as ``wearwell fatigue design``.

        Parameters
        ----------
        *others : Fit, str or path
            More fits of the same tests, or folders of their results.
        names : sequence of str, optional
            Names of this fit and the others, in their order.
        stress, mean_stress, stress_ratio, reliability, confidence, progress
            As in ``wearwell.design``.

        Returns
        -------
        DesignCurves
            ``curves`` and the weights of the ``models``.

        Raises
        ------
        InputError
            If a fit has no S-N curve, the fits are of different tests, or an argument is wrong; the message names it.

        Warns
        -----
        CheckWarning
            If a fit is not trusted, or a stress lies outside the tested range.

        Examples
        --------
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/spectrum/study.toml", seed=1, method="exact", draws=100, report=False)
        >>> found = fit.design(stress=["400 MPa", "300 MPa"], mean_stress="0 MPa", reliability=0.99)
        >>> found.curves["life"].round(-3).tolist()
        [288000.0, 2777000.0]
        """
        return _design(self, *others, names=names, stress=stress, mean_stress=mean_stress, stress_ratio=stress_ratio,
                       reliability=reliability, confidence=confidence, progress=progress)

    @like_function(_export_c)
    def export_c(self, folder, *, name="unit", unit=None, lines=None):
        """Write one unit of a fitted formula as C99 for a controller, as ``wearwell export c``.

        <as the function>

        Examples
        --------
        >>> import os, tempfile
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/fleet/study.toml", seed=1, method="exact", draws=100, report=False)
        >>> sizes = fit.export_c(os.path.join(tempfile.mkdtemp(), "pump"), name="pump", unit="L1", lines=64)
        >>> "per unit" in sizes
        True
        """
        return _export_c(self, folder, name=name, unit=unit, lines=lines)

    @like_function(_export_sql)
    def export_sql(self, dialect, table, *, value=None, unit=None, columns=None, keep=None, prefix="wearwell", draws=400, part="all"):
        """SQL that computes a value of a fitted formula with its interval for every row of a table, as ``wearwell export sql``.

        <as the function>

        Examples
        --------
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/fleet/study.toml", seed=1, method="exact", draws=100, report=False)
        >>> sql = fit.export_sql("postgresql", "fleet.liners", columns={"use": "hours:h"}, draws=20, part="query")
        >>> "formula_q50" in sql
        True
        """
        return _export_sql(self, dialect, table, value=value, unit=unit, columns=columns, keep=keep, prefix=prefix, draws=draws, part=part)
