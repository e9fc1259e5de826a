"""The files of a fit."""

import functools
import json
import os
import tempfile

from . import _core
from .errors import InputError
from .report import Report


class FitFiles(Report):
    """Results, report and NetCDF. Part of ``Fit``."""

    _no_page = "this fit was made with report=False; fit it again with a report"

    def _files(self):
        if self._kept is None:
            self._kept = dict(self._run.files())
        return self._kept

    def write(self, folder):
        """Write the folder of results, as ``wearwell fit -o`` does: whole or not at all.

        Parameters
        ----------
        folder : str or path
            The folder. Files of an earlier result are replaced; other files stay.

        Raises
        ------
        InputError
            If the folder cannot be made, or a file in it that is not of an earlier result has the name of a new one.
        MachineError
            If the disk fails.

        Examples
        --------
        >>> import os, tempfile
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/joint/study.toml", seed=1, report=False)
        >>> folder = os.path.join(tempfile.mkdtemp(), "results")
        >>> fit.write(folder)
        >>> os.path.exists(os.path.join(folder, "summary.json"))
        True
        """
        files = self._files()
        if "report.json" in files:
            files = {**files, "report.html": self._html()}
        _core.write_folder(os.fspath(folder), list(files.items()))

    @property
    def _page(self):
        files = self._files()
        return _core.page_of(files["summary.json"], files["report.json"]) if "report.json" in files else None

    @functools.cached_property
    def _figures(self):
        from .plots import figures_of

        files = self._files()
        if "report.json" not in files:
            raise InputError(self._no_page)
        return figures_of(json.loads(files["report.json"]))

    @property
    def plots(self):
        """Names of the plots that ``plot`` makes.

        Returns
        -------
        list of str
            Common names first, such as "life" and "posterior", then those of the figures of the report.

        Raises
        ------
        InputError
            If the fit was made with ``report=False``.

        Examples
        --------
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/joint/study.toml", seed=1)
        >>> fit.plots[:4]
        ['curve', 'posterior', 'pairs', 'residuals']
        """
        from .plots import names_of
        from .residuals import residual_figure

        names = names_of(self._figures)
        if "residuals" in names:
            return names
        try:
            return [*names, residual_figure(self)["id"]]
        except InputError:  # of a model without scores
            return names

    def plot(self, name=None, ax=None):
        """A picture of the fit: a figure of its report.

        Parameters
        ----------
        name : str, optional
            "life", "probability" (probability paper), "curve" (S-N curve, wear against cycles, path of a new unit), "hazard",
            "posterior" (of each parameter, with its prior), "pairs", "residuals" (about the fit, or against normal quantiles), "paths", "trace", "chains", or the name of
            a figure of the report: ``plots`` lists those that this fit has. By default the first figure of the report.
        ax : matplotlib.axes.Axes or sequence of them, optional
            Axes to draw on; one for each figure.

        Returns
        -------
        Plot or ax
            A plot, which notebooks draw by Vega-Lite; ``ax``, if it was given.

        Raises
        ------
        InputError
            If the fit has no such plot, was made with ``report=False``, or there are fewer axes than figures.

        Examples
        --------
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/joint/study.toml", seed=1)
        >>> fit.plot("life")
        <wearwell.Plot 'life': life>
        """
        from .plots import Plot, has_plot, plot_of
        from .residuals import residual_figure

        if name == "residuals" and not ("report.json" in self._files() and has_plot(self._figures, name)):
            plot = Plot(name, [residual_figure(self)])
        else:
            known = None if name is None or has_plot(self._figures, name) else self.plots
            plot = plot_of(self._figures, name, known)
        return plot if ax is None else plot.draw(ax)

    def to_netcdf(self, path):
        """Write draws, sampler statistics, log-likelihoods and data as NetCDF-4, for ArviZ and xarray.

        The groups are those of InferenceData: posterior, sample_stats, log_likelihood, posterior_predictive,
        observed_data, constant_data. Variables have the attribute ``units``.

        Parameters
        ----------
        path : str or path
            The file, such as "fit.nc".

        Raises
        ------
        InputError
            If the study has no posterior, or the path cannot be written (no folder, no permission).
        MachineError
            If libnetcdf is missing, or the disk fails.

        Examples
        --------
        >>> import os, tempfile
        >>> import wearwell as ww
        >>> import xarray
        >>> fit = ww.fit("examples/joint/study.toml", seed=1, method="exact", chains=2, draws=100, report=False)
        >>> path = os.path.join(tempfile.mkdtemp(), "fit.nc")
        >>> fit.to_netcdf(path)
        >>> xarray.load_dataset(path, group="posterior")["k"].shape
        (2, 100)
        """
        self._live().write_netcdf(os.fspath(path))

    def to_datatree(self):
        """The content of ``to_netcdf`` in memory.

        Returns
        -------
        xarray.DataTree or dict of str to xarray.Dataset
            A DataTree with xarray 2024.10 or later, else a dict of data sets by group.

        Raises
        ------
        InputError
            If the study has no posterior.
        ImportError
            If xarray or netCDF4 is missing.

        Examples
        --------
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/joint/study.toml", seed=1, method="exact", chains=2, draws=100, report=False)
        >>> fit.to_datatree()["posterior"]["k"].dims
        ('chain', 'draw')
        """
        import xarray

        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "fit.nc")
            self.to_netcdf(path)
            if hasattr(xarray, "open_datatree"):
                return xarray.open_datatree(path).load()
            import netCDF4

            with netCDF4.Dataset(path) as file:
                groups = list(file.groups)
            found = {}
            for group in groups:
                with xarray.open_dataset(path, group=group) as data:
                    found[group] = data.load()
            return found
