"""What a fit found."""

import base64
import csv
import functools
import html
import io
import json
import os
import tempfile
from typing import NamedTuple

from . import _core
from ._errors import InputError, NotTrusted, warn_of

_nan, _inf = float("nan"), float("inf")


class Check(NamedTuple):
    """One reason to believe the numbers or not."""

    name: str
    verdict: str  # "pass", "warn" or "fail"
    detail: str
    advice: str


def _frame(rows, columns, index=None):
    import pandas

    frame = pandas.DataFrame(rows, columns=columns)
    return frame.set_index(index) if index else frame


def _number(value):
    return _nan if value is None else value


def _life(value):  # null of a life: never
    return _inf if value is None else value


_quantiles = ["q05", "q50", "q95", "b1", "b10", "b50"]


def _lives_and_quantities(summary):
    rows = []
    for each in summary.get("quantities", []):
        is_life = "b10" in each
        rows.append({
            "name": each["name"], "of": each["of"], "at": each["at"], "unit": each["unit"], "is_life": is_life,
            **{q: (_life if is_life else _number)(each[q]) if q in each else _nan for q in _quantiles},
            "predictive": _number(each.get("predictive")), "bound": _number(each.get("bound")),
            "credible_level": _number(each.get("credible_level"))})
    return rows


class Fit:
    """The outcome of ``Study.fit`` or ``wearwell.fit``. It does not change; threads may share it, and it can be copied and
    pickled.

    summary: dict, summary.json as the command line writes it (docs/reference/summary.schema.json).
    trusted: no check failed. checks: list of Check.
    parameters, predictions, quantities, lives: data frames in the study's units, by quadrature where there is one.
    draws, sample_stats: data frames by chain and draw. tables: those of the report, by name.
    """

    @classmethod
    def _of(cls, study, run, choice):
        self = cls.__new__(cls)
        self.study, self._run, self._choice, self._kept = study, run, choice, None
        self._summary_text = run.summary()
        self.summary = json.loads(self._summary_text)
        self.checks = [Check(c["name"], c["verdict"], c["detail"], c.get("advice", "")) for c in self.summary["checks"]]
        self.trusted = self.summary["trusted"]
        self.seed = self.summary["seed"]
        warn_of(self.checks)
        return self

    def require_trusted(self):
        """Returns the fit, or raises NotTrusted with what failed."""
        failed = [f"{c.name}: {c.detail}. {c.advice}".rstrip() for c in self.checks if c.verdict == "fail"]
        if not self.trusted:
            raise NotTrusted("; ".join(failed))
        return self

    # ---- Frames.

    def _need(self, key, what):
        if "sampler" not in self.summary or key not in self.summary:
            raise InputError(f"a study of the model {self.summary['model']} has no {what}; fit.summary and fit.tables hold what "
                             "it found")
        return self.summary[key]

    @functools.cached_property
    def parameters(self):
        """By parameter: unit, mean, sd, q05, q50, q95, the diagnostics of the draws, and the prior in words."""
        rows = []
        for name, each in self._need("parameters", "parameters").items():
            rows.append({
                "name": name, "unit": each["unit"], **{k: _number(each[k]) for k in ("mean", "sd", "q05", "q50", "q95")},
                **{k: _number(each["draws"][k]) for k in ("mcse", "ess_bulk", "ess_tail", "rhat")}, "exact": each["by"] == "quadrature",
                "prior": each.get("prior", {}).get("words", ""), "default_prior": each.get("prior", {}).get("default", False)})
        return _frame(rows, ["name", "unit", "mean", "sd", "q05", "q50", "q95", "mcse", "ess_bulk", "ess_tail", "rhat", "exact",
                             "prior", "default_prior"], "name")

    @functools.cached_property
    def predictions(self):
        """What the study predicts: of the true mean the mean and its 90 % interval (ci05, ci95), and of a measurement (pi05,
        pi95)."""
        rows = []
        for each in self._need("predictions", "predictions of a posterior"):
            at = next(iter(each))  # "cycles": the first key is what it is at
            rows.append({"at_name": at, "at": each[at], "quantity": each["quantity"], "unit": each["unit"],
                         **{k: _number(each[k]) for k in ("mean", "ci05", "ci95", "pi05", "pi95")},
                         "measured": _number(each.get("measured"))})
        return _frame(rows, ["at_name", "at", "quantity", "unit", "mean", "ci05", "ci95", "pi05", "pi95", "measured"])

    @functools.cached_property
    def quantities(self):
        """What follows from the parameters: quantiles, and of lives B1, B10, B50."""
        return _frame(_lives_and_quantities(self.summary),
                      ["name", "of", "at", "unit", "is_life", *_quantiles, "predictive", "bound", "credible_level"])

    @functools.cached_property
    def lives(self):
        """Lives among the quantities, and the life to the limit of a study that has one. InputError for a clutch, whose lives
        are in fit.summary["life"] and fit.tables, each with two intervals."""
        if "sampler" not in self.summary:
            self._need("life", "lives of this form")
        rows = [row for row in _lives_and_quantities(self.summary) if row["is_life"]]
        if "life" in self.summary:
            life = self.summary["life"]
            rows.insert(0, {"name": "life", "of": life.get("of", ""), "at": f"to {life['limit']:g} {life['limit_unit']}",
                            "unit": life["unit"], **{q: _life(life[q]) if q in life else _nan for q in _quantiles}, "predictive": _nan,
                            "bound": _nan, "credible_level": _nan})
        return _frame(rows, ["name", "of", "at", "unit", *_quantiles, "predictive", "bound", "credible_level"])

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
        """Draws of the posterior, a row each, by chain and draw; parameters in their units."""
        import pandas

        names = list(self._need("parameters", "draws"))
        return pandas.DataFrame(self._array.reshape(-1, len(names)), columns=names, index=self._index(), copy=False)

    @functools.cached_property
    def sample_stats(self):
        """What the sampler tells of each draw: lp, and of NUTS accept_stat, stepsize, treedepth, n_leapfrog, divergent,
        energy."""
        import pandas

        self._need("parameters", "draws")
        kinds = {"divergent": bool, "treedepth": int, "n_leapfrog": int}
        return pandas.DataFrame({k: v.reshape(-1).astype(kinds.get(k, float), copy=False) for k, v in self._stats.items()},
                                index=self._index())

    @functools.cached_property
    def tables(self):
        """The report's tables by name, as tables/NAME.csv has them, units in the headings."""
        import pandas

        found = {}
        for name, content in self._files().items():
            if name.startswith("tables/") and name.endswith(".csv"):
                header = next(csv.reader(io.StringIO(content)), None)
                found[name[7:-4]] = pandas.read_csv(io.StringIO(content)) if header else pandas.DataFrame()
        return found

    def arrow(self, name="draws"):
        """A table of the fit for readers of Arrow, an object with ``__arrow_c_stream__``: "draws", "sample_stats", "parameters",
        "predictions", "quantities", "lives", or one of ``fit.tables``. The columns of draws are those of ``fit.draws``, not
        copied, with chain and draw before and their units as metadata. Frames that answer a question go by ``wearwell.arrow``.
        """
        from ._arrow import arrow

        if name in ("draws", "sample_stats", "parameters", "predictions", "quantities", "lives"):
            units = {k: each["unit"] for k, each in self.summary["parameters"].items()} if name == "draws" else None
            return arrow(getattr(self, name), units)
        if name not in self.tables:
            raise InputError(f"the fit has no table {name!r}; it has draws, sample_stats, parameters, predictions, quantities, lives, "
                             f"and of the report {', '.join(self.tables)}")
        return arrow(self.tables[name])

    # ---- What is asked later.

    def ask(self, predict, level=0.9):
        """Another [predict] of the same posterior, as a dict with the keys of the study's model; nothing is fitted again.
        Returns a dict with the keys predictions, quantities and life of summary.json. level: of the predictions'
        intervals, which keep the names ci05, ci95, pi05 and pi95."""
        if not 0 < level < 1:
            raise InputError(f"level is {level}; it lies between 0 and 1")
        answers = json.loads(self._live().asked(self.study._asking(predict), float(level)))
        return {k: answers[k] for k in ("predictions", "quantities", "life") if k in answers}

    def predict(self, new, level=0.9, kind="mean", *, along=None):
        """Measurements under new conditions, of a study of a formula model (model "formula"): a frame with mean, lower and upper for each row
        of ``new`` (a data frame or a dict of columns in the study's units).

        kind: "mean", the true mean of the median item; "next", a measurement of an item not seen yet; "unit", a measurement of
        the item that the label column of ``new`` names, by its own effects given its data (empty: of a new one). Up to the
        item's last row the formula holds as in the data; beyond, where conditions change, its path goes on from where it stands.
        along: the column that is the axis; it matters where the formula is a rate or a running sum alone.
        """
        from ._ask import predict

        return predict(self, new, level, kind, along)

    def life(self, limit=None, b=(1, 10), confidence=0.9, unit=None, survived=None, *, along=None, given=None):
        """Lives. Of a study of a formula model: until what is measured reaches ``limit`` (a text with its unit, or a dict by name), of a
        new item or what remains to the item ``unit``; or, without a limit, those of which the likelihood is. Of a joint, a
        bearing, or S-N tests those of its own [predict].

        A frame: the life with q05, q50, q95 and the B-lives b1, b10, ... of one item, all that is unknown averaged in; and, where
        items differ, each B-life of all items with ``predictive`` (that of the next one) and ``bound``.
        b: percentages of B-lives. confidence: the probability with which ``bound`` is exceeded. survived: lives of those that
        have come so far, from there on; the survival is told too. given: conditions, by name.
        """
        from ._lives import life

        return life(self, limit, b, confidence, unit, survived, along, given)

    # ---- Files.

    def _live(self):
        """The run; of a fit that was pickled it is done again, to the bit."""
        if self._run is None:
            choice = {**self._choice, "seed": self.seed}
            run = self.study._read.run(choice["method"] or "", choice["chains"], choice["warmup"], choice["draws"],
                                       choice["seed"], 0, False, None)
            again = json.loads(run.summary())
            if again["data"]["fingerprint"] != self.summary["data"]["fingerprint"]:
                raise InputError(f"the data of {self.study!r} are not those of this fit any more")
            self._run = run
        return self._run

    def _files(self):
        if self._kept is None:
            self._kept = dict(self._run.files())
        return self._kept

    def write(self, folder):
        """A folder of results as ``wearwell fit -o`` writes it, whole or not at all."""
        files = self._files()
        if "report.json" in files:
            files = {**files, "report.html": self._page()}
        _core.write_folder(os.fspath(folder), list(files.items()))

    def _page(self):
        files = self._files()
        if "report.json" not in files:
            raise InputError("this fit was made with report=False; fit it again with a report")
        return _core.page_of(files["summary.json"], files["report.json"])

    def report(self, path):
        """Writes report.html: one page that opens without a network."""
        _core.write_file(os.fspath(path), self._page())

    def to_netcdf(self, path):
        """Draws, their statistics, log-likelihoods and data as NetCDF for ArviZ, as ``wearwell fit --netcdf`` writes it."""
        self._live().write_netcdf(os.fspath(path))

    def to_datatree(self):
        """The same as an xarray.DataTree (xarray 2024.10 or later), or as a dict of xarray.Dataset by group before."""
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

    # ---- Shown.

    def __str__(self):
        return self._terminal

    @functools.cached_property
    def _terminal(self):
        return self._live().terminal()

    def __repr__(self):
        word = "trusted" if self.trusted else "not trusted"
        failed = [c.name for c in self.checks if c.verdict == "fail"]
        return f"<wearwell.Fit of {self.summary['title']!r}: {word}{' (' + ', '.join(failed) + ')' if failed else ''}>"

    def _repr_html_(self):
        """The verdict, the parameters and the report's page on request, light or dark as the notebook's page is."""
        colour = {"pass": "#1a7f37", "warn": "#9a6700", "fail": "#cf222e"}
        worst = "fail" if not self.trusted else "warn" if any(c.verdict == "warn" for c in self.checks) else "pass"
        word = {"pass": "trusted", "warn": "trusted, with warnings", "fail": "not trusted"}[worst]
        out = [f'<div style="border-left:4px solid {colour[worst]};padding:0 1em">'
               f"<p><b>{html.escape(self.summary['title'])}</b>: {word}</p>"]
        out += [f"<p>{html.escape(f'{c.name}: {c.detail}. {c.advice}'.rstrip())}</p>"
                for c in self.checks if c.verdict != "pass"]
        posterior = "sampler" in self.summary
        if posterior:
            shown = self.parameters[["unit", "mean", "sd", "q05", "q50", "q95"]]
            out.append(shown.to_html(float_format=lambda x: f"{x:.4g}", border=0))
        if posterior and len(self.lives):
            out.append(self.lives[["name", "of", "at", "unit", "q05", "q50", "q95", "b10"]].to_html(
                float_format=lambda x: f"{x:.4g}", border=0, index=False))
        out.append("</div>")
        if "report.json" in self._files():
            page = base64.b64encode(self._page().encode()).decode()
            out.append('<details><summary>The report</summary><iframe style="width:100%;height:40em;border:0" '
                       f'sandbox="allow-scripts" src="data:text/html;charset=utf-8;base64,{page}"></iframe></details>')
        return "".join(out)

    # ---- Copies.

    def __getstate__(self):
        self._files(), self._terminal, self._array, self._stats
        state = {k: v for k, v in self.__dict__.items() if k != "_run"}
        state["_run"] = None
        return state

    def __copy__(self):
        return self

    def __deepcopy__(self, memo):
        return self
