"""The tables of a fit."""

import csv
import functools
import io

from . import frames
from .errors import InputError


class FitTables:
    """What a fit found, as data frames. Part of ``Fit``."""

    @functools.cached_property
    def summary(self):
        """The parameters on one screen.

        Returns
        -------
        pandas.DataFrame
            A row for each parameter: ``unit``, ``mean``, ``sd``, quantiles ``q05``, ``q50``, ``q95``, ``ess_bulk`` and
            ``rhat`` of the draws, and ``prior``, described. ``parameters`` has more columns, ``results`` all numbers.

        Raises
        ------
        InputError
            If the study has no posterior, as of a clutch.

        Examples
        --------
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/joint/study.toml", seed=1, report=False)
        >>> fit.summary[["unit", "q50"]].loc["sigma"].tolist()
        ['mm^3', 4.97...]
        """
        return self.parameters[["unit", "mean", "sd", "q05", "q50", "q95", "ess_bulk", "rhat", "prior"]]

    def residuals(self, kind="score"):
        """Quantile residuals of the observations (Dunn and Smyth 1996), medians over the posterior.

        Parameters
        ----------
        kind : {"score", "cox-snell"}
            "score": standard normal if the model is right. "cox-snell": the cumulative hazard at each life, exponential with
            mean 1.

        Returns
        -------
        pandas.DataFrame
            A row for each observation: ``residual`` and ``censored``, whether only an interval of it is known. Such a
            residual is in the middle of the probability of this interval.

        Raises
        ------
        InputError
            If the study has no posterior, or the observations of its model have no scores.

        Examples
        --------
        >>> import wearwell as ww
        >>> pumps = {"hours": [312, 480, 510, 640, 700, 700, 150, 260, 420], "failed": [1, 1, 1, 1, 0, 0, 1, 1, 1]}
        >>> fit = ww.life(pumps, "hours", event="failed", method="exact", draws=100, report=False)
        >>> fit.residuals()["censored"].sum()
        2
        """
        from .residuals import residuals

        return residuals(self, kind)

    @functools.cached_property
    def parameters(self):
        """Posterior of each parameter.

        Returns
        -------
        pandas.DataFrame
            A row for each parameter, indexed by its name. Columns: ``unit``; ``mean``, ``sd`` and the quantiles ``q05``,
            ``q50``, ``q95`` in this unit; ``mcse`` (Monte Carlo standard error of the mean), ``ess_bulk``, ``ess_tail``
            and ``rhat`` of the draws; ``exact`` (whether mean to q95 are by quadrature); ``prior`` and
            ``default_prior`` (whether the study states none).

        Raises
        ------
        InputError
            If the study has no posterior, as of a clutch.

        Examples
        --------
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/joint/study.toml", seed=1, report=False)
        >>> fit.parameters.loc["sigma", ["mean", "q05", "q95"]].astype(float).round(2).tolist()
        [5.63, 2.78, 10.95]
        """
        return frames.parameters(self.results)

    @functools.cached_property
    def predictions(self):
        """Predictions that the study asks for.

        Returns
        -------
        pandas.DataFrame
            A row for each prediction. Columns: ``at_name`` and ``at`` (where it is, such as "cycles" and 20585);
            ``quantity`` and ``unit``; ``mean`` and ``ci05``, ``ci95``, posterior mean and 90 % credible interval of
            the true mean; ``pi05``, ``pi95``, 90 % prediction interval of a measurement; ``measured``, where the
            study has one to compare with, else NaN.

        Raises
        ------
        InputError
            If the study has no posterior, as of a clutch.

        Examples
        --------
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/joint/study.toml", seed=1, report=False)
        >>> fit.predictions.loc[0, ["at", "mean", "pi05", "pi95"]].astype(float).round(1).tolist()
        [20585.0, 95.3, 74.9, 115.7]
        """
        return frames.predictions(self.results)

    @functools.cached_property
    def quantities(self):
        """Quantities that follow from the parameters, lives among them.

        Returns
        -------
        pandas.DataFrame
            A row for each quantity. Columns: ``name``, ``of`` (which item or population), ``at`` (under which
            conditions), ``unit``, ``is_life``; posterior quantiles ``q05``, ``q50``, ``q95``; of lives the B-lives
            ``b1``, ``b10``, ``b50`` averaged over the posterior; of B-lives over all items ``predictive`` (B-life of
            the next item) and ``bound`` (lower bound that is exceeded with probability ``credible_level``), and with
            ``predict={"sides": "both"}`` or "upper" ``upper_bound``; of functions of the parameters ``mean``. Infinity is a life that never ends; NaN is a number that the
            quantity does not have.

        Examples
        --------
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/joint/study.toml", seed=1, report=False)  # its [predict] asks for no quantity
        >>> len(fit.quantities)
        0
        >>> list(fit.quantities.columns[:5])
        ['name', 'of', 'at', 'unit', 'is_life']
        """
        return frames.quantities(self.results)

    @functools.cached_property
    def lives(self):
        """Lives that the study asks for, to a failure threshold or as measured.

        Returns
        -------
        pandas.DataFrame
            A row for each life, with the columns of ``quantities`` without ``is_life``; ``predictive``, ``bound`` and
            ``credible_level`` only where a life has them. The life to the study's threshold, if it has one, comes first; its
            median is ``b50``.

        Raises
        ------
        InputError
            If the study has no posterior. Lives of a clutch, each with two intervals, are in ``fit.results["life"]``
            and ``fit.tables``.

        Examples
        --------
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/joint/study.toml", seed=1, report=False)
        >>> fit.lives.loc[0, ["at", "unit"]].tolist()
        ['to 100 mm^3', 'cycles']
        >>> fit.lives.loc[0, ["b10", "b50"]].astype(float).round(-2).tolist()
        [19000.0, 21600.0]
        """
        return frames.lives(self.results)

    @functools.cached_property
    def _array(self):
        return self._live().draws()

    @functools.cached_property
    def _stats(self):
        return self._live().sample_stats()

    def _index(self):
        import pandas

        chains, draws = self._array.shape[:2]
        return pandas.MultiIndex.from_product([range(chains), range(draws)], names=["chain", "draw"])

    @functools.cached_property
    def draws(self):
        """Draws of the posterior.

        Returns
        -------
        pandas.DataFrame
            A row for each draw, indexed by ``chain`` and ``draw`` from 0; a float64 column for each parameter, in its
            unit (``fit.parameters["unit"]``).

        Raises
        ------
        InputError
            If the study has no posterior.

        Examples
        --------
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/joint/study.toml", seed=1, method="exact", chains=2, draws=100, report=False)
        >>> fit.draws.shape, list(fit.draws.columns), fit.draws.index.names
        ((200, 2), ['k', 'sigma'], FrozenList(['chain', 'draw']))
        """
        import pandas

        names = list(frames.require(self.results, "parameters", "draws"))
        return pandas.DataFrame(self._array.reshape(-1, len(names)), columns=names, index=self._index(), copy=False)

    @functools.cached_property
    def sample_stats(self):
        """Statistics of the sampler for each draw.

        Returns
        -------
        pandas.DataFrame
            A row for each draw, indexed as ``draws``. Columns: ``lp``, the log posterior density; with NUTS also
            ``accept_stat``, ``stepsize``, ``treedepth``, ``n_leapfrog``, ``divergent`` and ``energy``, as in Stan.

        Raises
        ------
        InputError
            If the study has no posterior.

        Examples
        --------
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/joint/study.toml", seed=1, report=False)
        >>> int(fit.sample_stats["divergent"].sum())
        0
        """
        import pandas

        frames.require(self.results, "parameters", "draws")
        kinds = {"divergent": bool, "treedepth": int, "n_leapfrog": int}
        return pandas.DataFrame({k: v.reshape(-1).astype(kinds.get(k, float), copy=False) for k, v in self._stats.items()},
                                index=self._index())

    @functools.cached_property
    def tables(self):
        """Tables of the report.

        Returns
        -------
        dict of str to pandas.DataFrame
            By name, as ``wearwell fit`` writes tables/NAME.csv; headings have units, "k [mm^3/(N m)]".

        Examples
        --------
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/joint/study.toml", seed=1, report=False)
        >>> fit.tables["parameters-by-data-set"].shape[0]  # after 1, 2, ... 5 rows
        5
        """
        import pandas

        found = {}
        for name, content in self._files().items():
            if name.startswith("tables/") and name.endswith(".csv"):
                header = next(csv.reader(io.StringIO(content)), None)
                found[name[7:-4]] = pandas.read_csv(io.StringIO(content)) if header else pandas.DataFrame()
        return found

    def arrow(self, name="draws"):
        """A table of the fit for readers of the Arrow C data interface: DuckDB, polars, pyarrow.

        Parameters
        ----------
        name : str
            "draws", "sample_stats", "parameters", "predictions", "quantities", "lives", or a name in ``fit.tables``.
            Draws have the columns chain, draw and the parameters; their units are metadata of the fields. Columns of
            float64 and int64 are not copied.

        Returns
        -------
        ArrowTable
            An object with ``__arrow_c_stream__``.

        Raises
        ------
        InputError
            If the fit has no table of this name.

        Examples
        --------
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/joint/study.toml", seed=1, method="exact", chains=2, draws=100, report=False)
        >>> fit.arrow("draws")
        <wearwell.ArrowTable of 200 rows: chain, draw, k, sigma>
        """
        from .arrow import arrow

        if name in ("draws", "sample_stats", "parameters", "predictions", "quantities", "lives"):
            units = {k: each["unit"] for k, each in self.results["parameters"].items()} if name == "draws" else None
            return arrow(getattr(self, name), units)
        if name not in self.tables:
            raise InputError(f"the fit has no table {name!r}; it has draws, sample_stats, parameters, predictions, quantities, lives, "
                             f"and of the report {', '.join(self.tables)}")
        return arrow(self.tables[name])
