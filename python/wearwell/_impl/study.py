"""Studies: from a file, from text with tables in memory, or put together of a formula, data and priors."""

import os
import re

from . import _core, toml
from .assembly import assemble
from .data import index_level_of, table_of
from .errors import InputError, in_words_of_caller, missing_files
from .fit import Fit
from .fit_options import fits
from .progress import reporter


class Study:
    """A study of a formula: data, a formula with its distribution, priors, and what to predict. Nothing is fitted yet.

    ``Study.from_file`` and ``Study.from_toml`` read studies of every model.

    Parameters
    ----------
    formula : str or dict of str to str
        Equations, one a line, such as "V = k*F*s"; or a dict of left to right sides. A line whose left side is a column
        gives what is measured; other lines name intermediate values. Names that are neither columns nor lines nor
        constants are parameters. Dimensions are checked.
    data : table
        Data, a row for each observation: whatever ``wearwell.table`` takes.
    priors : dict of str to dict
        By parameter, made by ``wearwell.lognormal`` and the other functions of priors. A parameter is reported in the
        unit of its prior.
    units : dict, optional
        Unit of each column, by heading or name: a text or a pint unit. A heading may have it: "F [N]".
    unit : str, optional
        Column that names the items; parameters in ``random_effects`` then have a random effect for each item.
    random_effects : str, sequence of str or dict, optional
        Parameters that differ from item to item, one or two: names, or a dict to "lognormal" or "normal". By default
        the only parameter of the formula; lognormal if the parameter is positive. The scatter of k between items is the
        parameter k_scatter; without a prior it has a half-normal one of scale 1.
    family : str
        Distribution of a measurement about the formula: "normal" (default), "lognormal", "log10-normal", "weibull",
        "loglogistic", "frechet", "inverse-gaussian", "birnbaum-saunders", "smallest-extreme-value", "largest-extreme-value",
        "exponential" or "poisson". The formula gives its mean, median, scale or location.
    scatter : str, float or dict, optional
        Second parameter of the distribution, an expression or a number, or a dict by measured column. By default the
        parameter sigma (standard deviation, or that of the logarithm), or shape.
    likelihood : dict, optional
        Instead of ``family`` and ``scatter``, for each measured column a dict with "family" and all its parameters:
        ``{"V": {"family": "normal", "mean": "k*F*s", "sd": "0.05*k*F*s"}}``.
    constants : dict, optional
        Named quantities, such as ``{"area": "50 mm^2"}``.
    predict : dict, optional
        What to predict, by the keys of ``[predict]`` of a study file: along, at, given, limit, quantities, b_lives, ...
    sampler : dict, optional
        Keys of ``[sampler]`` of a study file: method, chains, warmup, draws, seed.
    title : str, optional
        Title of the study; by default its equations.
    status : str or dict, optional
        Column that says how each life ended: "event"; or ``{"column": "event", "failure": 1}`` where it holds codes; or
        ``{"column": "end", "failure": "broke", "runout": ["ran", "stopped"]}`` with words of the table. By default the
        column "status", if there is one.
    unused : str or sequence of str, optional
        Columns that look like a status and are none.

    Attributes
    ----------
    toml : str
        The study as the text of a study file.

    Raises
    ------
    InputError
        If an equation, a prior, a unit or a cell of the data is wrong; the message names equation, key, or column and
        row. It is a ValueError.

    Examples
    --------
    >>> import wearwell as ww
    >>> wear = {"F": [100, 200, 300, 400], "s": [4e4] * 4, "V": [0.41, 0.78, 1.23, 1.61]}
    >>> study = ww.Study(formula="V = k*F*s", data=wear, units={"F": "N", "s": "m", "V": "mm^3"},
    ...                  priors={"k": ww.lognormal("1e-7 mm^3/(N m)", log_sd=3), "sigma": ww.half_normal("5 mm^3")})
    >>> fit = study.fit(seed=1, method="exact", draws=100, report=False)
    >>> print(f"{fit.parameters.loc['k', 'mean']:.2e}")
    1.01e-07
    """

    _words = None  # of a study that was made: arguments by key, and their values, for messages

    def __init__(self, formula, data, *, priors, units=None, unit=None, random_effects=None, family="normal", scatter=None,
                 likelihood=None, constants=None, predict=None, sampler=None, title=None, status=None, unused=None):
        text, table, only = assemble(formula, data, priors, units, unit, random_effects, family, scatter, likelihood, constants, predict,
                                     sampler, title, status, unused)
        self._words = {}, None
        with in_words_of_caller(self._words):
            self._set(text, "study", {"data": table}, {"data": (data, {}, only)})

    @classmethod
    def _made(cls, text, given, arguments=None, values=None):
        """A study that a function made of its arguments; ``given``: by name (table, data, headings that it holds); ``values``: of arguments,
        for messages."""
        self = cls.__new__(cls)
        self._words = arguments or {}, values
        with in_words_of_caller(self._words):
            return self._set(text, "study", {k: table for k, (table, _, _) in given.items()},
                             {k: (data, {}, only) for k, (_, data, only) in given.items()})

    @classmethod
    def from_toml(cls, text, data=None, *, units=None, folder="", name="study"):
        """A study as text, with its tables in memory or in files.

        Parameters
        ----------
        text : str
            The study as TOML.
        data : dict of str to table, optional
            Tables by the names that the text gives them, such as "wear.csv" for ``file = "wear.csv"``: whatever
            ``wearwell.table`` takes. Other tables are files in ``folder``.
        units : dict of dict, optional
            Units of columns, by table and heading.
        folder : str
            Folder of the files that the text names; by default the current one.
        name : str
            Name of the study in messages.

        Returns
        -------
        Study
            The study, read and checked.

        Raises
        ------
        InputError
            If the text or a table is wrong; the message names line and key, or column and row.

        Examples
        --------
        >>> import pandas as pd
        >>> import wearwell as ww
        >>> with open("examples/formula/study.toml") as file:
        ...     text = file.read()
        >>> wear = pd.read_csv("examples/formula/wear.csv")
        >>> ww.Study.from_toml(text, {"wear.csv": wear}, name="wear of eight machines")
        <wearwell.Study 'wear of eight machines'>
        """
        if not isinstance(text, str):
            raise InputError(f"the study is {type(text).__name__}; it is a text (Study.from_file reads a file)")
        given = {k: (v, (units or {}).get(k), None) for k, v in (data or {}).items()}
        tables = {k: table_of(v, k, u) for k, (v, u, _) in given.items()}
        return cls.__new__(cls)._set(text, os.path.join(folder, name), tables, given)

    @classmethod
    def from_file(cls, path):
        """A study file, with the tables that it names.

        Parameters
        ----------
        path : str or path
            The study file (TOML). Tables are looked for from its folder.

        Returns
        -------
        Study
            The study, read and checked.

        Raises
        ------
        InputError
            If the file or a table is missing or wrong; the message names file, line and key, or column and row.

        Examples
        --------
        >>> import wearwell as ww
        >>> ww.Study.from_file("examples/joint/study.toml")
        <wearwell.Study 'examples/joint/study.toml'>
        >>> ww.Study.from_file("examples/joint/no.toml")
        Traceback (most recent call last):
            ...
        wearwell.MissingFileError: ...examples/joint/no.toml...
        """
        self = cls.__new__(cls)
        self._path = os.path.abspath(os.fspath(path))
        self._given, self._shown = {}, os.fspath(path)
        with missing_files():
            self._read = _core.read_file(os.fspath(path))
        self.toml = self._read.text
        return self

    def _set(self, text, path, tables, given):
        self.toml, self._path, self._shown, self._given = text, path, path, given
        with missing_files():
            try:
                self._read = _core.read_text(text, path, tables)
            except InputError as error:
                raise index_level_of({k: v for k, (v, _, _) in given.items()}, str(error)) or error from None
        return self

    def description(self):
        """Describe the model, data, units and priors without fitting.

        Returns
        -------
        str
            The description, as ``wearwell check`` prints it.

        Examples
        --------
        >>> import wearwell as ww
        >>> study = ww.Study.from_file("examples/joint/study.toml")
        >>> print(study.description().splitlines()[0])
        Pin joint of a slider-crank, PTFE bushing
        """
        return self._read.description()

    def fit(self, seed=None, *, method=None, chains=None, warmup=None, draws=None, threads=0, report=True, progress=None):
        """Compute the posterior, check it, and predict.

        The interpreter's lock is released. Ctrl-C raises KeyboardInterrupt within a moment and leaves nothing behind.

        Parameters
        ----------
        seed : int, optional
            Seed of the random numbers, 0 to 2^64 - 1; by default that of the study, else 1. One seed gives the same
            numbers to the bit, those of ``wearwell fit --seed``. A clutch study has its seeds, and takes none of seed,
            method, chains, warmup and draws here.
        method : {"nuts", "exact", "metropolis"}, optional
            How draws are made: the No-U-Turn sampler (default), independently from the exact posterior by quadrature
            (up to 4 parameters), or random-walk Metropolis.
        chains : int, optional
            Independent chains, 1 to 1000; default 4.
        warmup : int, optional
            Iterations of each chain that are discarded; default 1000 (metropolis: 4000).
        draws : int, optional
            Draws kept of each chain, from 10; default 1000 (metropolis: 6000).
        threads : int
            Threads, 0 for all. No number depends on it.
        report : bool
            Whether to compute what ``Fit.report`` shows too.
        progress : bool or callable, optional
            True for a bar, or a function of (what, done, total, seconds). An exception in it stops the fit.

        Returns
        -------
        Fit
            The fit. Ask ``trusted`` before you use its numbers.

        Raises
        ------
        InputError
            If an option is out of its range, or the study cannot be fitted.
        MachineError
            If memory or another resource fails.

        Warns
        -----
        CheckWarning
            For each check that warns or fails.

        Examples
        --------
        >>> import wearwell as ww
        >>> study = ww.Study.from_file("examples/joint/study.toml")
        >>> fit = study.fit(seed=1, method="exact", draws=100, report=False)
        >>> len(fit.draws)
        400
        """
        choice = {"method": method, "chains": chains, "warmup": warmup, "draws": draws, "seed": seed}
        _require_choice(choice, threads)
        with reporter(progress) as report_progress, in_words_of_caller(self._words):
            run = self._read.run(method or "", chains, warmup, draws, seed, threads, bool(report), report_progress)
        return Fit._of(self, run, choice)

    def _asking(self, predict):
        """The same study with another [predict]."""
        text = _without_table(self.toml, "predict") + "\n" + toml.table("predict", predict)
        tables = {k: table_of(v, k, u, o) for k, (v, u, o) in self._given.items()}
        return _core.read_text(text, self._path, tables)

    def __getstate__(self):
        if any(isinstance(v, _core.Table) for v, _, _ in self._given.values()):
            raise TypeError("a study of wearwell.table(...) cannot be pickled; hand over the data itself")
        return {k: v for k, v in self.__dict__.items() if k not in ("_read", "_words")}

    def __setstate__(self, state):
        self.__dict__.update(state)
        tables = {k: table_of(v, k, u, o) for k, (v, u, o) in self._given.items()}
        self._read = _core.read_text(self.toml, self._path, tables)

    def __repr__(self):
        return f"<wearwell.Study {self._shown!r}>"


def _require_choice(choice, threads):
    method = choice["method"]
    if method not in (None, "nuts", "metropolis", "exact"):
        raise InputError(f"method is {method!r}; it is 'nuts', 'metropolis' or 'exact'")
    for name, least, most in (("chains", 1, 1000), ("warmup", 0, 10_000_000), ("draws", 10, 10_000_000), ("seed", 0, 2**64 - 1)):
        value = choice[name]
        if value is None:
            continue
        if not hasattr(value, "__index__") or isinstance(value, bool) or not least <= value.__index__() <= most:
            raise InputError(f"{name} is {value!r}; it is a whole number from {least} to {most}")
        choice[name] = value.__index__()
    if not isinstance(threads, int) or not 0 <= threads <= 1024:
        raise InputError(f"threads is {threads!r}; it is a whole number from 0 (all) to 1024")


def _without_table(text, name):
    """A study without the table of this name and those below it."""
    header = re.compile(r"\s*\[+\s*([A-Za-z0-9_\-]+)[^=]*\]\s*(#.*)?\Z")
    kept, inside = [], False
    for line in text.split("\n"):
        match = header.match(line)
        if match:
            inside = match[1] == name
        if not inside:
            kept.append(line)
    return "\n".join(kept)


@fits
def fit(study, seed=None, *, method=None, chains=None, warmup=None, draws=None, threads=0, report=True, progress=None):
    """Fit a study file, or a Study: compute the posterior, check it, and predict.

    Parameters
    ----------
    study : str, path or Study
        Path of a study file (TOML), or a study.
    seed : int, optional
        Seed of the random numbers; by default that of the study, else 1.
    method : {"nuts", "exact", "metropolis"}, optional
        How draws are made, as of ``Study.fit``.
    chains, warmup, draws : int, optional
        Chains, iterations of each that are discarded, and draws kept of each; default 4, 1000 and 1000.
    <options of the run>

    Returns
    -------
    Fit
        The fit. Ask ``trusted`` before you use its numbers.

    Raises
    ------
    InputError
        If the study, its data or an option is wrong. A file that is missing is a MissingFileError, which is a
        FileNotFoundError too.
    MachineError
        If memory or another resource fails.

    Warns
    -----
    CheckWarning
        For each check that warns or fails.

    Examples
    --------
    >>> import wearwell as ww
    >>> fit = ww.fit("examples/joint/study.toml", seed=1, report=False)
    >>> fit.trusted
    True
    """
    if not isinstance(study, Study):
        if not isinstance(study, (str, os.PathLike)):
            raise InputError(f"study is {type(study).__name__}; it is the path of a study file or a Study. A table is fitted by "
                             "wearwell.life, sn, staircase, degradation, joint or bearing")
        study = Study.from_file(study)
    return study.fit(seed, method=method, chains=chains, warmup=warmup, draws=draws, threads=threads, report=report, progress=progress)
