"""Selections and comparisons."""

import json
import os
import tempfile

from . import _core
from ._data import headings_of, table_of
from ._errors import InputError, warn_of
from ._fit import Check, Fit


class Selection:
    """The best terms of a regression. summary: as ``wearwell select --json`` prints it; models: frame, best first; trusted: the
    best is proven to be the best."""

    def __init__(self, summary, text, models, page):
        self.summary = json.loads(summary)
        self._summary_text, self._text, self._models, self._page = summary, text, models, page
        self.trusted = self.summary["trusted"]
        self.checks = [Check(c["name"], c["verdict"], c["detail"], c.get("advice", "")) for c in self.summary["checks"]]

    @property
    def models(self):
        import io

        import pandas

        return pandas.read_csv(io.StringIO(self._models))

    def report(self, path):
        """Writes the page; of a selection that was made with report=True and found a model."""
        if not self._page:
            raise InputError("there is no page: select again with report=True")
        _core.write_file(os.fspath(path), self._page)

    def __str__(self):
        return self._text

    def __repr__(self):
        return f"<wearwell.Selection {self.summary['equation']!r}>"


def select(data, response, *, inputs=(), degree=None, terms=(), criterion="loo", keep=10, near=0.0, force=(), weights="",
           folds=0, nested=None, seed=1, time=None, threads=0, report=False):
    """The best terms of a regression among all submodels, with a proof (docs/how-to/select.md): options as ``wearwell select``.

    data: whatever ``wearwell.table`` takes, or the path of a file. The interpreter's lock is released.
    Raises InputError. Warns (CheckWarning) where the search is not proven or a check warns.
    """
    inputs = [inputs] if isinstance(inputs, str) else list(inputs)
    terms = [terms] if isinstance(terms, str) else list(terms)
    force = [force] if isinstance(force, str) else [str(f) for f in force]
    if isinstance(data, (str, os.PathLike)):
        source = os.fspath(data)
    else:
        headings = headings_of(data)
        used = {response, weights, *inputs}
        for term in terms:
            used |= {term, *term.split("*")}
        known = None if headings is None else {h for h in headings if h in used}
        source = table_of(data, only=known if known else None)
    found = Selection(*_core.select(source, response, inputs, degree, terms, weights or "", force, criterion, int(keep),
                                    float(near), int(folds), -1 if nested is None else int(nested), int(seed),
                                    float("inf") if time is None else float(time), int(threads), bool(report)))
    warn_of(found.checks)
    return found


class Comparison:
    """Studies side by side. summary: as ``wearwell compare --json`` prints it."""

    def __init__(self, summary, text, page):
        self.summary = json.loads(summary)
        self._text, self._page = text, page

    def report(self, path):
        """Writes the page: the tables, and the posteriors of the parameters overlaid."""
        _core.write_file(os.fspath(path), self._page)

    def __str__(self):
        return self._text

    def __repr__(self):
        return f"<wearwell.Comparison of {', '.join(s['study'] for s in self.summary['studies'])}>"


def compare(*fits, names=None):
    """Which of several fits of the same data predicts best: Fit objects, or folders that ``wearwell fit`` wrote.

    Fits of different data are shown, never ranked. names: in the order of the fits; "a", "b", ... where there are none.
    """
    if len(fits) < 2:
        raise InputError("a comparison takes two fits at least")
    if names is not None and len(names) != len(fits):
        raise InputError(f"{len(names)} names are given for {len(fits)} fits")
    with tempfile.TemporaryDirectory() as folder:
        pairs = []
        for i, each in enumerate(fits):
            usual = chr(ord("a") + i) if i < 26 else str(i + 1)
            if isinstance(each, Fit):
                path = os.path.join(folder, str(i))
                _core.write_folder(path, list(each._files().items()))
                pairs.append((names[i] if names else usual, path))
            else:
                path = os.fspath(each)
                pairs.append((names[i] if names else path, path))
        return Comparison(*_core.compared(pairs))


def rainflow(signal, *, method="four-point", residual="half"):
    """Rainflow counting (ASTM E1049-85) of a load history, as ``wearwell rainflow`` counts it without classes: a frame of cycles
    with their ends, range, mean, and count (1, or 0.5 of what closes no cycle).

    signal: an array or a column of finite numbers, in any unit. method: "four-point" or "three-point"; residual: "half"
    or "repeat" (the history is repeated, so that all cycles close).
    """
    import pandas

    from ._data import _values

    if method not in ("four-point", "three-point"):
        raise InputError(f"method is {method!r}; it is 'four-point' or 'three-point'")
    if residual not in ("half", "repeat"):
        raise InputError(f"residual is {residual!r}; it is 'half' or 'repeat'")
    values = _values(signal, "signal")
    if isinstance(values, list):
        raise InputError("signal holds no numbers")
    start, end, count = _core.rainflow(values, method == "three-point", residual == "repeat")
    return pandas.DataFrame({"from": start, "to": end, "range": abs(end - start), "mean": (start + end) / 2, "count": count})
