"""New rows for a fit: what ``wearwell update`` does."""

import os

from . import _core
from .errors import InputError, missing_files
from .fit_options import options_of_the_run
from .fitted import fitted, rows_of
from .progress import reporter


@options_of_the_run
def update(fit, data, repeated=None, *, threads=0, report=True, progress=None):
    """Fit a study again with new rows.

    Does what ``wearwell update`` does, with the same numbers to the bit: with the method, chains, draws and seed of the fit.

    Parameters
    ----------
    fit : Fit, str or path
        A fit, or the folder of its result.
    data : table, str or path, or a list of them
        New rows with the headings of the study's data, in the same or other units: whatever ``wearwell.table`` takes. The order of
        rows does not matter, and a repeated reading of a unit counts once. Of a clutch campaign each table whose columns it has.
    repeated : {"once", "another"}, optional
        Meaning of a single test that equals an earlier one: the same test again, or another. By default it is refused.
    <options of the run>

    Returns
    -------
    Fit
        The study fitted with all rows: its check ``new-data`` counts the new ones and names those that contradict the earlier
        posterior, ``results["update"]`` has them. It can be updated again.

    Raises
    ------
    InputError
        If a column, a unit or a cell does not fit the study's data, a test may be a repeat, or the study has no posterior to update;
        the message names row and column.

    Warns
    -----
    CheckWarning
        For each check that warns or fails: new rows that contradict the earlier posterior.

    Examples
    --------
    >>> import wearwell as ww
    >>> wear = {"F": [100, 200, 300, 400], "s": [4e4] * 4, "V": [0.41, 0.78, 1.23, 1.61]}
    >>> study = ww.Study(formula="V = k*F*s", data=wear, units={"F": "N", "s": "m", "V": "mm^3"},
    ...                  priors={"k": ww.lognormal("1e-7 mm^3/(N m)", log_sd=3), "sigma": ww.half_normal("5 mm^3")})
    >>> fit = study.fit(seed=1, method="exact", draws=100, report=False)
    >>> later = ww.update(fit, {"F": [500], "s": [4e4], "V": [2.02]}, report=False)
    >>> later.results["update"]["rows_before"], later.results["update"]["counted"]
    (4, 1)
    """
    if repeated not in (None, "once", "another"):
        raise InputError(f"repeated is {repeated!r}; it is 'once' or 'another'")
    if not isinstance(threads, int) or not 0 <= threads <= 1024:
        raise InputError(f"threads is {threads!r}; it is a whole number from 0 (all) to 1024")
    several = [] if data is None else list(data) if isinstance(data, (list, tuple)) else [data]
    if not several:
        raise InputError("data is missing: new rows with the headings of the study's data")
    rows = [os.fspath(each) if isinstance(each, (str, os.PathLike)) else rows_of(each, "data") for each in several]
    from .fit import Fit
    from .study_of_all_rows import StudyOfAllRows

    run, path = fitted(fit)
    with reporter(progress) as report_progress, missing_files():
        new = _core.update(run, path, rows, repeated or "", threads, bool(report), report_progress)
    shown = fit.study._shown if isinstance(fit, Fit) else path
    return Fit._of_update(new, StudyOfAllRows._of_state(new.state(), shown))
