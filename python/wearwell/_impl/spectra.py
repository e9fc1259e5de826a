"""Damage and life under load histories, design curves, load spectra: what ``wearwell fatigue`` does."""

import functools
import os
from collections.abc import Mapping

import numpy as np

from .answer import Answer
from .data import table_of
from .errors import InputError, warn
from .fitted import named_folders
from .question import found
from .toml import unit_text
from .track import Quantiles

_inf = float("inf")


def _endless(value):
    """JSON has no infinity: a life without end is null."""
    return _inf if value is None else value


class _FatigueAnswer(Answer):
    def __init__(self, *parts):
        super().__init__(*parts)
        if not self.trusted:
            warn("the fit that this rests on is not trusted: see its checks")
        for each in self.summary.get("checks", ()):
            if each["verdict"] == "warn":
                warn(f"{each['name']} warns: {each['detail']}")


class Damage(_FatigueAnswer):
    """Damage and life under a load history, as ``Fit.damage`` and ``wearwell.damage`` find them.

    Parameters
    ----------
    *parts
        What the library answers; ``damage`` makes a Damage.

    Attributes
    ----------
    title : str
        Title of the fit.
    summary : dict
        All numbers, as ``wearwell fatigue life --json`` prints them (life.json).
    json : str
        The same as text, byte for byte that of the program but for names of tables in memory.
    trusted : bool
        Whether the fit is trusted.

    Examples
    --------
    >>> import wearwell as ww
    >>> fit = ww.fit("examples/spectrum/study.toml", seed=1, method="exact", draws=100, report=False)
    >>> found = fit.damage("examples/spectrum/loads.csv", column="stress", block="350 km")
    >>> found
    <wearwell.Damage 'Life of a part under its load history'>
    """

    _file = "life"

    @functools.cached_property
    def lives(self):
        """Lives at which a percentage of all items has failed.

        Returns
        -------
        pandas.DataFrame
            A row for each percentage, ``percent``. Columns: ``unit``; the quantiles ``q05``, ``q50``, ``q95`` of what holds for all
            items; ``bound``, exceeded with the confidence; ``predictive``, the life that the next item reaches with the same risk.
            Infinity: nothing does damage.

        Examples
        --------
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/spectrum/study.toml", seed=1, method="exact", draws=100, report=False)
        >>> found = fit.damage("examples/spectrum/loads.csv", column="stress", block="350 km")
        >>> print(f"{found.lives.loc[1, 'bound']:.3g} {found.lives.loc[1, 'unit']}")
        8.03e+06 km
        """
        import pandas

        keys = ("q05", "q50", "q95", "bound", "predictive")
        return pandas.DataFrame([{"percent": each["percent"], "unit": self.summary["unit"], **{key: _endless(each[key]) for key in keys}}
                                 for each in self.summary["lives"]])

    @property
    def life(self):
        """Predictive life of the next item.

        Returns
        -------
        Quantiles
            Its quantiles, in the unit of ``lives``.

        Examples
        --------
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/spectrum/study.toml", seed=1, method="exact", draws=100, report=False)
        >>> life = fit.damage("examples/spectrum/loads.csv", column="stress", block="350 km").life
        >>> life.q05 < life.q50 < life.q95, life.unit
        (True, 'km')
        """
        return Quantiles(*(_endless(self.summary["next"][key]) for key in ("q05", "q50", "q95")), self.summary["unit"])

    @property
    def damage(self):
        """Damage of one block to the next item; failure is at the damage sum, 1 by default.

        Returns
        -------
        Quantiles
            Its quantiles, without a unit.

        Examples
        --------
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/spectrum/study.toml", seed=1, method="exact", draws=100, report=False)
        >>> found = fit.damage("examples/spectrum/loads.csv", column="stress", block="350 km")
        >>> print(f"{found.damage.q50:.3g}")
        2.01e-05
        """
        return Quantiles(*(self.summary["damage"][key] for key in ("q05", "q50", "q95")), "")

    @functools.cached_property
    def sources(self):
        """Sources of the spread of the predictive life.

        Returns
        -------
        pandas.DataFrame
            ``of``, a parameter, the scatter of items or the damage sum, and ``share`` of the variance of log10 life. No rows if some
            items never fail.

        Examples
        --------
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/spectrum/study.toml", seed=1, method="exact", draws=100, report=False)
        >>> found = fit.damage("examples/spectrum/loads.csv", column="stress", block="350 km")
        >>> found.sources.loc[found.sources["share"].idxmax(), "of"]
        'scatter from item to item'
        """
        import pandas

        return pandas.DataFrame(self.summary["contributions"], columns=["of", "share"])


class DesignCurves(_FatigueAnswer):
    """Design curves of one or several S-N fits, as ``Fit.design`` and ``wearwell.design`` find them.

    Parameters
    ----------
    *parts
        What the library answers; ``design`` makes DesignCurves.

    Attributes
    ----------
    title : str
        Title of the best fit.
    summary : dict
        All numbers, as ``wearwell fatigue design --json`` prints them (design.json).
    json : str
        The same as text.
    trusted : bool
        Whether every fit of non-negligible weight is trusted.

    Examples
    --------
    >>> import wearwell as ww
    >>> fit = ww.fit("examples/spectrum/study.toml", seed=1, method="exact", draws=100, report=False)
    >>> fit.design(stress="400 MPa", mean_stress="0 MPa")
    <wearwell.DesignCurves 'Life of a part under its load history'>
    """

    _file = "design"

    @functools.cached_property
    def curves(self):
        """Lives that a share of the items outlasts with a confidence.

        Returns
        -------
        pandas.DataFrame
            A row for each ``curve`` and stress. Columns: ``reliability`` and ``confidence``; ``stress`` and ``mean_stress``, in
            ``summary["stress_unit"]``; ``life``, averaged over the fits, and ``most_cautious`` among those of non-negligible weight,
            in ``summary["life_unit"]``. Infinity: no end with that confidence.

        Examples
        --------
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/spectrum/study.toml", seed=1, method="exact", draws=100, report=False)
        >>> found = fit.design(stress=["400 MPa", "500 MPa"], mean_stress="0 MPa", reliability=0.99, confidence=0.95)
        >>> found.curves["stress"].tolist(), found.curves["life"].is_monotonic_increasing
        ([500.0, 400.0], True)
        """
        import pandas

        return pandas.DataFrame([{"curve": curve["name"], "reliability": curve["reliability"], "confidence": curve["confidence"],
                                  "stress": each["stress"], "mean_stress": each["mean_stress"], "life": _endless(each["life"]),
                                  "most_cautious": _endless(each["most_cautious"])}
                                 for curve in self.summary["curves"] for each in curve["points"]])

    @functools.cached_property
    def models(self):
        """The fits and their weights.

        Returns
        -------
        pandas.DataFrame
            ``study``, ``equation``, ``weight`` in the mixture that predicts best (stacking), ``trusted``; the best first.

        Examples
        --------
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/spectrum/study.toml", seed=1, method="exact", draws=100, report=False)
        >>> fit.design(stress="400 MPa", mean_stress="0 MPa").models["weight"].tolist()
        [1.0]
        """
        import pandas

        return pandas.DataFrame(self.summary["models"])


class LoadSpectrum(_FatigueAnswer):
    """The counted cycles of a load history, as ``wearwell.spectrum`` counts them.

    ``tables`` has "cycles" (by range and mean, every class), "matrix", "spectrum" and "levels" (level crossings).

    Parameters
    ----------
    *parts
        What the library answers; ``spectrum`` makes a LoadSpectrum.

    Attributes
    ----------
    title : str
        What was counted.
    summary : dict
        All numbers, as ``wearwell fatigue rainflow --json`` prints them (rainflow.json).
    json : str
        The same as text.
    trusted : bool
        True: it rests on no fit.

    Examples
    --------
    >>> import wearwell as ww
    >>> found = ww.spectrum("examples/spectrum/loads.csv", column="stress")
    >>> sorted(found.tables)
    ['cycles', 'levels', 'matrix', 'spectrum']
    """

    _file = "rainflow"


def _one_column(loads):
    """A signal without a heading: an array, a list, a series or a pint quantity."""
    if isinstance(loads, np.ndarray):
        return loads.dtype.names is None
    return isinstance(loads, (list, tuple)) or hasattr(loads, "magnitude") or (hasattr(loads, "iloc") and not hasattr(loads, "columns"))


def _loads(loads, units):
    """Arguments and tables of a load history."""
    by_column = isinstance(units, Mapping)
    given = {"units": None if units is None or by_column else unit_text(units)}
    if _one_column(loads):
        name = getattr(loads, "name", None)
        loads = {name if isinstance(name, str) and name else "load": loads}
    if isinstance(loads, (str, os.PathLike)) and not by_column:
        return {**given, "loads": os.fspath(loads)}, {}
    return given, {"loads": table_of(loads, "loads", units if by_column else None)}


_history = """    loads : table, array, str or path
        One block: a signal (samples, or peaks and valleys), or a table of counted cycles with the columns ``range`` (valley to peak) or
        ``amplitude`` (half of it), ``mean`` or ``stress_ratio``, and ``cycles``; that of ``wearwell.rainflow`` too. A path is a
        file, which may be larger than memory.
    column : str, optional
        Heading of the load; by default the only numeric column. A named column is a signal.
    units : str, dict or pint unit, optional
        Unit of the load, "MPa", or of columns by heading; a heading may have it, "stress [MPa]".
    method : {"four-point", "three-point"}
        How cycles of a signal are found (ASTM E1049); both find the same ones.
    residual : {"half", "repeat"}
        Ranges that close no cycle count half, or the history is repeated.
    time : str, optional
        A column of times of a signal: gaps are refused."""


def _with_history(function):
    if function.__doc__:
        function.__doc__ = function.__doc__.replace("    <the history>", _history)
    return function


@_with_history
def damage(fit, loads, *, column=None, units=None, method="four-point", residual="half", time=None, scale=None, rule=None, knee=None,
           damage_sum="1 x/ 1.34", block=None, b=(1, 10, 50), confidence=0.9, progress=None):
    """Sum the damage of a load history along a fitted S-N curve, and find the life under it.

    Does what ``wearwell fatigue life`` does, with the same numbers to the bit: with the uncertainty of the curve, the scatter of items
    and that of the damage sum.

    Parameters
    ----------
    fit : Fit, str or path
        A fit of a model "sn" (``wearwell.sn``), or the folder of its result.
    <the history>
        Without ``block``, lives are then in hours.
    scale : str or pint quantity, optional
        Factor from the load to stress: "0.35 MPa/N"; of an elastic strain "206 GPa".
    rule : {"elementary", "original", "haibach", "liu-zenner"}, optional
        What cycles below the knee do. By default there is no knee ("elementary"); with a fatigue limit or a bent curve in the fit,
        "original".
    knee : str, optional
        The knee, for the other rules: "2e6 cycles", or a fully reversed amplitude "150 MPa".
    damage_sum : float or str
        Damage sum at failure: a number, or a median and the factor that covers two thirds.
    block : str or pint quantity, optional
        Use of one block, "350 km": lives are in its unit.
    b : float or sequence of float
        Percentages failed.
    confidence : float
        Confidence of the lower bounds, a share.
    progress : bool or callable, optional
        True for a bar, or a function of (what, done, total, seconds).

    Returns
    -------
    Damage
        ``lives``, ``life``, ``damage`` of one block, ``sources`` of the spread; it prints what the program prints.

    Raises
    ------
    InputError
        If the fit has no S-N curve, a column or a unit is missing or can be read in two ways, or a cell is wrong; the message names
        argument, or row and column.

    Warns
    -----
    CheckWarning
        If the fit is not trusted, or much of the damage is outside the tested range.

    Examples
    --------
    >>> import wearwell as ww
    >>> fit = ww.fit("examples/spectrum/study.toml", seed=1, method="exact", draws=100, report=False)
    >>> found = ww.damage(fit, "examples/spectrum/loads.csv", column="stress", block="350 km")
    >>> print(f"{found.lives.loc[1, 'bound']:.3g} {found.lives.loc[1, 'unit']}")  # B10
    8.03e+06 km
    >>> ww.damage(fit, [0, 900, 100])
    Traceback (most recent call last):
        ...
    wearwell.InputError: loads, column 'load' has no unit: ...
    """
    given, tables = _loads(loads, units)
    percents = [b] if np.ndim(b) == 0 else b
    return Damage(*found("damage", {
        **given, "column": column, "method": method, "residual": residual, "time": time, "scale": scale, "rule": rule, "knee": knee,
        "damage_sum": damage_sum, "block": block, "b": percents, "confidence": confidence,
    }, fit, "fit", tables, 0, progress))


def design(*fits, names=None, stress=None, mean_stress=None, stress_ratio=None, reliability=None, confidence=None, progress=None):
    """Design curves of an S-N fit, or averaged over several fits of the same tests.

    Does what ``wearwell fatigue design`` does, with the same numbers to the bit: lives that a share of the items outlasts with a
    confidence. Several fits are weighted by how well they predict (stacking, as in ``compare``).

    Parameters
    ----------
    *fits : Fit, str or path
        Fits of models "sn", or folders of their results; or a dict of them by name.
    names : sequence of str, optional
        Names in the order of the fits; by default "a", "b", ..., and of a folder its path.
    stress : str, pint quantity, or a sequence of them, optional
        Alternating stresses, "300 MPa"; by default levels across the tested range.
    mean_stress : str or pint quantity, optional
        Mean stress of all of them; by default as tested.
    stress_ratio : float, optional
        Stress ratio R, smallest over largest stress, instead of a mean stress.
    reliability, confidence : float, optional
        Share of the items that outlast the life, and the confidence, shares; 0.9 if only one of them is given. Without them four
        curves: 90/90, B-basis, A-basis and 97.7/90.
    progress : bool or callable, optional
        True for a bar, or a function of (what, done, total, seconds).

    Returns
    -------
    DesignCurves
        ``curves`` and the weights of the ``models``; it prints what the program prints.

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
    >>> found = ww.design(fit, stress="400 MPa", mean_stress="0 MPa", reliability=0.99, confidence=0.95)
    >>> print(f"{found.curves.loc[0, 'life']:.3g} {found.summary['life_unit']}")
    2.7e+05 cycles
    """
    with named_folders(fits, names) as pairs:
        if not pairs:
            raise InputError("design takes a fit of an S-N curve at least")
        given = [name for name, _ in pairs]
        twice = next((name for name in given if given.count(name) > 1), None)
        if twice is not None:
            raise InputError(f"names: '{twice}' is given twice")
        for name, each in zip(given, fits[0].values() if len(fits) == 1 and isinstance(fits[0], dict) else fits):
            model = getattr(each, "results", {}).get("model", "sn")
            if model != "sn":
                raise InputError(f"{name}: its model is \"{model}\"; an S-N curve is needed, model \"sn\"")
        return DesignCurves(*found("design", {
            "results": dict(pairs), "stress": stress, "mean_stress": mean_stress, "stress_ratio": stress_ratio, "reliability": reliability,
            "confidence": confidence,
        }, progress=progress))


@_with_history
def spectrum(loads, *, column=None, units=None, method="four-point", residual="half", time=None, bins=32, bin_width=None):
    """Count the cycles of a load history by the rainflow method, in classes.

    Does what ``wearwell fatigue rainflow`` does, with the same numbers to the bit. ``wearwell.rainflow`` gives the cycles one by one.

    Parameters
    ----------
    <the history>
    bins : int
        Largest number of displayed classes of range.
    bin_width : float, optional
        Width of these classes, in the unit of the load; by default a power of two.

    Returns
    -------
    LoadSpectrum
        ``tables`` of cycles, range-mean matrix, spectrum and level crossings; it prints what the program prints.

    Raises
    ------
    InputError
        If the load is missing or not numeric, or the history has a gap or no cycle; the message names row and column.

    Examples
    --------
    >>> import wearwell as ww
    >>> found = ww.spectrum([-2, 1, -3, 5, -1, 3, -4, 4, -2], units="MPa", bin_width=1)
    >>> float(found.tables["spectrum"]["cycles"].sum())
    4.0
    """
    given, tables = _loads(loads, units)
    return LoadSpectrum(*found("spectrum", {
        **given, "column": column, "method": method, "residual": residual, "time": time, "bins": bins, "bin_width": bin_width,
    }, tables=tables))
