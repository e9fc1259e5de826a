"""What a fit found."""

import functools
import json

from .check import checks_of
from .errors import InputError, NotTrusted, warn_of
from .fit_answers import FitAnswers
from .fit_files import FitFiles
from .fit_following import FitFollowing
from .fit_lives import FitLives
from .fit_tables import FitTables
from .messages import in_arguments
from .notebook import html_of


class Fit(FitTables, FitAnswers, FitLives, FitFollowing, FitFiles):
    """A fitted study: the posterior, what follows from it, and the checks that decide whether to trust it.

    ``Study.fit`` and ``wearwell.fit`` make it. It does not change; threads may share it, and it can be copied and
    pickled. Numbers are in the study's units. Those by quadrature are exact to the digits printed; those of draws have
    Monte Carlo error.

    Attributes
    ----------
    study : Study
        What was fitted.
    seed : int
        The seed. The same study with the same seed gives the same numbers to the bit.
    trusted : bool
        Whether no check failed.
    checks : list of Check
        All checks, with verdict, finding and advice.
    results : dict
        All numbers of the result, as ``wearwell fit --json`` prints them (summary.json).

    Examples
    --------
    >>> import wearwell as ww
    >>> fit = ww.fit("examples/joint/study.toml", seed=1, report=False)
    >>> fit
    <wearwell.Fit of 'Pin joint of a slider-crank, PTFE bushing': trusted>
    >>> [check.name for check in fit.checks if check.verdict != "pass"]
    ['fit']
    >>> print(f"{fit.parameters.loc['k', 'mean']:.2e} {fit.parameters.loc['k', 'unit']}")
    7.76e-04 mm^3/(N m)
    """

    @classmethod
    def _of(cls, study, run, choice):
        self = cls.__new__(cls)
        self.study, self._run, self._choice, self._kept = study, run, choice, None
        self._summary_text = run.summary()
        self.results = json.loads(self._summary_text)
        self.checks = checks_of(self.results)
        self.trusted = self.results["trusted"]
        self.seed = self.results["seed"]
        warn_of(self.checks)
        return self

    @classmethod
    def _of_update(cls, run, study):
        used = json.loads(run.summary()).get("sampler", {})
        choice = {key: used.get(key) for key in ("method", "chains", "warmup", "draws", "seed")}
        if choice["method"] == "exact":
            choice["warmup"] = None
        return cls._of(study, run, choice)

    def require_trusted(self):
        """Refuse to go on with a fit that is not trusted.

        Returns
        -------
        Fit
            The fit itself, if no check failed.

        Raises
        ------
        NotTrusted
            If a check failed; the message has the findings and the advice of all that failed.

        Examples
        --------
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/joint/study.toml", seed=1, report=False).require_trusted()
        >>> fit.trusted
        True
        """
        failed = [f"{c.name}: {c.detail}. {c.advice}".rstrip() for c in self.checks if c.verdict == "fail"]
        if not self.trusted:
            raise NotTrusted("; ".join(failed))
        return self

    def _live(self):
        """The run; of a fit that was pickled it is done again, to the bit."""
        if self._run is None:
            choice = {**self._choice, "seed": self.seed}
            run = self.study._read.run(choice["method"] or "", choice["chains"], choice["warmup"], choice["draws"],
                                       choice["seed"], 0, False, None)
            again = json.loads(run.summary())
            if again["data"]["fingerprint"] != self.results["data"]["fingerprint"]:
                raise InputError(f"the data of {self.study!r} have changed since this fit")
            self._run = run
        return self._run

    def __str__(self):
        return self._terminal

    @functools.cached_property
    def _terminal(self):
        return in_arguments(self._live().terminal())

    def __repr__(self):
        word = "trusted" if self.trusted else "not trusted"
        failed = [c.name for c in self.checks if c.verdict == "fail"]
        return f"<wearwell.Fit of {self.results['title']!r}: {word}{' (' + ', '.join(failed) + ')' if failed else ''}>"

    def _repr_html_(self):
        return html_of(self)

    # ---- Copies.

    def __getstate__(self):
        self._files(), self._terminal, self._array, self._stats
        state = {k: v for k, v in self.__dict__.items() if k not in ("_run", "_population")}
        state["_run"] = None
        return state

    def __copy__(self):
        return self

    def __deepcopy__(self, memo):
        return self
