"""Fits, or families of lives, ranked by how well they predict."""

import json
import os

from . import _core
from .errors import InputError, missing_files, warn
from .fitted import named_folders
from .messages import in_arguments, in_python
from .progress import reporter
from .report import Report


class Comparison(Report):
    """Fits side by side, as ``compare`` makes them.

    Parameters
    ----------
    summary, text, page : str
        What the comparison wrote: JSON, text and HTML. ``compare`` makes a Comparison.

    Attributes
    ----------
    summary : dict
        All numbers, as ``wearwell compare --json`` prints them.
    close : list of str
        With ``families``: those that the data do not separate from the best; else empty.

    Examples
    --------
    >>> import wearwell as ww
    >>> normal = ww.fit("examples/joint/normal_flat.toml", seed=1, method="exact", draws=100, report=False)
    >>> lognormal = ww.fit("examples/joint/lognormal_flat.toml", seed=1, method="exact", draws=100, report=False)
    >>> ww.compare(normal, lognormal, names=["normal", "lognormal"])
    <wearwell.Comparison of normal, lognormal>
    """

    def __init__(self, summary, text, page):
        self.summary = json.loads(summary)
        self.close = self.summary.get("close", [])
        self._text, self._page = text, page

    @property
    def lives(self):
        """The B-lives of each family.

        Returns
        -------
        pandas.DataFrame
            A row for each family and B-life. Columns: ``family``, best first; ``name``, ``of`` and ``at`` of the life; its
            ``unit``; ``q05``, ``q50`` and ``q95`` of its posterior. Empty without ``families``.

        Examples
        --------
        >>> import wearwell as ww
        >>> pumps = {"hours": [312, 480, 510, 640, 700, 700, 150, 260, 420], "failed": [1, 1, 1, 1, 0, 0, 1, 1, 1]}
        >>> fit = ww.life(pumps, "hours", event="failed", units={"hours": "h"}, b=10, method="exact", draws=100, report=False)
        >>> ww.compare(fit, families=["weibull", "lognormal"]).lives[["family", "name", "unit", "q50"]].round(0)
              family      name unit    q50
        0  lognormal  B10 life    h  188.0
        1    weibull  B10 life    h  169.0
        """
        import pandas

        rows = [{"family": each["study"], **life} for each in self.summary["studies"] for life in each.get("b_lives", ())]
        return pandas.DataFrame(rows, columns=["family", "name", "of", "at", "unit", "q05", "q50", "q95"])

    def __str__(self):
        return in_arguments(self._text)

    def __repr__(self):
        return f"<wearwell.Comparison of {', '.join(s['study'] for s in self.summary['studies'])}>"


def compare(*fits, names=None, families=None, threads=0, progress=None):
    """Rank fits of the same data, or families of one life, by how well they predict, by leave-one-out (elpd).

    Fits of different data are shown side by side and never ranked. With ``families`` one study of a life is fitted with each
    family: all have the same prior of mean and standard deviation of log life, as its note says.

    Parameters
    ----------
    *fits : Fit, str or path
        Two or more fits, or folders that ``Fit.write`` or ``wearwell fit`` wrote; or a dict of them by name. With
        ``families`` one fit of a life, one Study or one study file.
    names : sequence of str, optional
        Names in the order of the fits; by default "a", "b", ..., and of a folder its path.
    families : str or sequence of str, optional
        Two or more families of lives: "weibull", "lognormal", "loglogistic", "frechet", "gamma", "inverse-gaussian",
        "birnbaum-saunders", "exponentiated-weibull" and "generalized-gamma"; "log-location-scale" for the first four; or "all".
    threads : int
        Threads of the fits of ``families``, 0 for all. No number depends on it.
    progress : bool or callable, optional
        Of the fits of ``families``: True for a bar, or a function of (what, done, total, seconds).

    Returns
    -------
    Comparison
        Criteria, their differences with standard errors, weights, and parameters; with ``families`` also the B-lives of
        each, and whether the choice matters for them.

    Raises
    ------
    InputError
        If there are fewer than two fits or families, another number of names, a folder holds no result, or the study has no
        life whose family can be exchanged.

    Warns
    -----
    CheckWarning
        For each family whose fit is not trusted.

    Examples
    --------
    >>> import wearwell as ww
    >>> normal = ww.fit("examples/joint/normal_flat.toml", seed=1, method="exact", draws=100, report=False)
    >>> lognormal = ww.fit("examples/joint/lognormal_flat.toml", seed=1, method="exact", draws=100, report=False)
    >>> both = ww.compare({"normal": normal, "lognormal": lognormal})
    >>> sorted(study["study"] for study in both.summary["studies"])
    ['lognormal', 'normal']

    Which distribution do these lives have? Nine do not say:

    >>> pumps = {"hours": [312, 480, 510, 640, 700, 700, 150, 260, 420], "failed": [1, 1, 1, 1, 0, 0, 1, 1, 1]}
    >>> fit = ww.life(pumps, "hours", event="failed", units={"hours": "h"}, method="exact", draws=100, report=False)
    >>> sorted(ww.compare(fit, families=["weibull", "lognormal"]).close)
    ['lognormal', 'weibull']
    """
    if families is not None:
        return _of_families(fits, names, families, threads, progress)
    with named_folders(fits, names) as pairs:
        if len(pairs) < 2:
            raise InputError("a comparison takes two fits at least")
        return Comparison(*_core.compared(pairs))


def _of_families(fits, names, families, threads, progress):
    if names is not None:
        raise InputError("names: families have their own names; leave names out")
    if len(fits) != 1:
        raise InputError(f"families ranks distributions of one study, but {len(fits)} are given")
    if not isinstance(threads, int) or not 0 <= threads <= 1024:
        raise InputError(f"threads is {threads!r}; it is a whole number from 0 (all) to 1024")
    listed = [families] if isinstance(families, str) else list(families) if hasattr(families, "__iter__") else [families]
    if not listed or not all(isinstance(each, str) for each in listed):
        raise InputError(f"families is {families!r}; it is a list of names, like ['weibull', 'lognormal'], or 'all'")
    study = _study_of(fits[0])
    with reporter(progress) as report_progress:
        try:
            found = Comparison(*_core.compared_families(study._read, ",".join(listed), threads, report_progress))
        except InputError as error:
            raise InputError(in_python(str(error))) from None
    for each in found.summary["studies"]:
        if not each["trusted"]:
            warn(f"{each['study']}: the fit is not trusted; fit the life with this family to see its checks")
    return found


def _study_of(given):
    from .fit import Fit
    from .study import Study

    if isinstance(given, Fit):
        return given.study
    if isinstance(given, Study):
        return given
    if isinstance(given, (str, os.PathLike)):
        if not os.fspath(given).endswith(".toml"):
            raise InputError(f"families needs a study, FILE.toml, a Study or a fit, but got {os.fspath(given)!r}")
        with missing_files():
            return Study.from_file(given)
    raise InputError(f"families needs a fit of a life, a Study or the path of a study file, not {type(given).__name__}; "
                     "of a table: wearwell.life(table, ...)")
