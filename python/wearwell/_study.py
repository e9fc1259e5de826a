"""Studies: from a file, from text with tables in memory, or put together of a formula model, data and priors."""

import os
import re

from . import _core, _toml
from ._data import columns_of_few_kinds, headings_of, table_of
from ._errors import InputError
from ._fit import Fit
from ._progress import reporter

_name = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
_heading = re.compile(r"\s*([A-Za-z][A-Za-z0-9_]*)\s*(?:[\[(].*)?\Z", re.DOTALL)
_text = re.compile(r'"[^"]*"|\[[^\]]*\]')  # of an expression: texts and units are no names
_special = ("status", "lower", "upper", "entry", "count")
# Of a family: the slot that the formula gives, the slot of its scatter, and what that is called where nobody says.
_slots = {
    "normal": ("mean", "sd", "sigma"),
    "lognormal": ("median", "log_sd", "sigma"),
    "log10-normal": ("median", "log10_sd", "sigma"),
    "weibull": ("scale", "shape", "shape"),
    "loglogistic": ("scale", "shape", "shape"),
    "inverse-gaussian": ("mean", "shape", "shape"),
    "birnbaum-saunders": ("scale", "shape", "shape"),
    "smallest-extreme-value": ("location", "scale", "sigma"),
    "largest-extreme-value": ("location", "scale", "sigma"),
    "exponential": ("mean", None, None),
    "poisson": ("mean", None, None),
}
# Formulas of priors that say nothing of a sign, or of a fraction; under all others a parameter is positive.
_of_any_sign = ("flat", "uniform", "normal", "student-t", "smallest-extreme-value", "largest-extreme-value", "beta", "default", None)


def _names_in(*texts):
    found = set()
    for text in texts:
        if isinstance(text, dict):
            found |= _names_in(*text.keys(), *text.values())
        elif isinstance(text, (list, tuple)):
            found |= _names_in(*text)
        elif isinstance(text, str):
            found |= set(_name.findall(_text.sub(" ", text)))
    return found


def _lines(formula):
    if isinstance(formula, dict):
        return {str(k).strip(): v for k, v in formula.items()}
    if not isinstance(formula, str):
        raise InputError(f"the formula is {type(formula).__name__}; it is a text like 'V = k*F*s', one line an equation")
    lines = {}
    for line in re.split(r"[\n;]", formula):
        if not line.strip():
            continue
        # The first = that is no comparison.
        parts = re.split(r"(?<![<>=!])=(?!=)", line, maxsplit=1)
        if len(parts) != 2 or not parts[0].strip() or not parts[1].strip():
            raise InputError(f"'{line.strip()}' is no equation; a formula is written like 'V = k*F*s'")
        name = parts[0].strip()
        if name in lines:
            raise InputError(f"the formula gives '{name}' twice")
        lines[name] = parts[1].strip()
    if not lines:
        raise InputError("the formula is empty; it is written like 'V = k*F*s'")
    return lines


def _status(status, columns, headings):
    """(heading, what stands in [data.columns])"""
    entry = dict(status) if isinstance(status, dict) else {"column": status}
    heading = columns.get(entry.get("column"), entry.get("column"))
    if heading not in headings:
        raise InputError(f"status: data has no column '{heading}' (columns: {', '.join(map(str, headings))}); it is like 'event' or "
                         "{'column': 'event', 'failure': 1}")
    entry["column"] = heading
    return heading, entry if len(entry) > 1 else heading


def _in_python(message):
    """What a message says of keys of a study file, as arguments of Study."""
    message = re.sub(r'status = \{ column = ("[^"]*"), failure = (\d|"[^"]*") \}', r'status={"column": \1, "failure": \2}', message)
    message = re.sub(r'status = ("[^"]*")', r"status=\1", message)
    return re.sub(r"unused = (\[[^\]]*\]) under \[data\]", r"unused=\1", message)


def _middles(lines, likelihood):
    """The formula without what says how measurements scatter about it."""
    scatters = ("family", "sd", "log_sd", "log10_sd", "shape", "df", "trials")
    return list(lines.values()) + [text for slots in likelihood.values() for slot, text in slots.items() if slot not in scatters]


def _varies(random_effects, unit, texts, priors):
    in_law = [p for p in priors if p in _names_in(texts)]
    if random_effects is None:
        if len(in_law) != 1:
            raise InputError(
                f"which of {', '.join(in_law) or 'its parameters'} differ from {unit} to {unit}? "
                f"random_effects=['{in_law[0] if in_law else 'k'}'] says so"
            )
        random_effects = in_law
    if isinstance(random_effects, str):
        random_effects = [random_effects]
    if not isinstance(random_effects, dict):
        random_effects = {p: "normal" if priors.get(p, {}).get("distribution") in _of_any_sign else "lognormal" for p in random_effects}
    entries, added = {}, {}
    for parameter, how in random_effects.items():
        if not isinstance(how, str) or parameter == "correlation":
            entries[parameter] = how
            continue
        scatter = f"{parameter}_scatter"
        entries[parameter] = {"distribution": how, ("log_sd" if how == "lognormal" else "sd"): scatter}
        if scatter not in priors:
            if how != "lognormal":
                raise InputError(f"priors has no '{scatter}': by how much {parameter} differs from {unit} to {unit}")
            added[scatter] = {"distribution": "half-normal", "scale": 1}
    return entries, added


class Study:
    """A study: data, a formula, priors, and what to predict.

    ``Study(formula="V = k*F*s", data=df, units={"F": "N", "s": "m", "V": "mm^3"}, priors={...}, unit="joint")``

    formula: equations, one a line (docs/reference/formula-language.md); a line whose left side is a column is what is measured.
    data: see ``wearwell.table``. units: of columns, by heading or name; a heading may say it, "F [N]".
    priors: by parameter, as made by ``wearwell.lognormal`` and its like; units are those of the answer.
    unit: the column that names the items; ``random_effects`` says which parameters differ between them (one or two; a list,
    or a dict to "lognormal" or "normal"), by default the only one of the formula, lognormal where it is positive. The scatter
    of k is the parameter k_scatter (half-normal, scale 1, where ``priors`` does not say).
    family, scatter: how what is measured scatters about the formula: "normal" with the parameter sigma, ...; or
    ``likelihood``: tables as [likelihood.NAME] of docs/reference/formula-models.md. constants, predict, sampler: as there.
    status: the column that says how each life ended, "event" or {"column": "event", "failure": 1} where it holds codes and its
    heading does not tell what a failure is written as, or {"column": "end", "failure": "broke", "runout": ["ran", "stopped"]} with
    words of the table; by default the column "status", if there is one. unused: columns that look
    like that and say something else.

    Raises InputError (a ValueError) in the words of the command line. Nothing is fitted yet.
    """

    def __init__(self, formula, data, *, priors, units=None, unit=None, random_effects=None, family="normal", scatter=None,
                 likelihood=None, constants=None, predict=None, sampler=None, title=None, status=None, unused=None):
        units = {k: _toml.unit_text(v) for k, v in (units or {}).items()}
        headings = headings_of(data)
        table = None
        if headings is None:
            table = table_of(data)
            headings = table.headings()
        columns, name_of = {}, {}
        for heading in headings:
            match = _heading.match(heading) if isinstance(heading, str) else None
            if match and columns.setdefault(match[1], heading) != heading:
                raise InputError(f"data: the columns '{columns[match[1]]}' and '{heading}' have one name, {match[1]}")
            if match:
                name_of[heading] = match[1]
        for key in units:
            if key not in name_of and key not in columns:
                raise InputError(f"units: data has no column '{key}' (columns: {', '.join(map(str, headings))})")
        units = {name_of.get(k, k): v for k, v in units.items()}
        if unit is not None and unit not in columns:
            raise InputError(f"unit: data has no column '{unit}' (columns: {', '.join(map(str, headings))})")
        lines = _lines(formula)
        priors = dict(priors)
        for parameter, prior in priors.items():
            if not isinstance(prior, dict):
                raise InputError(f"priors: {parameter} is {type(prior).__name__}; wearwell.lognormal(...) and its like make one")
        if likelihood is None:
            likelihood, lines = self._likelihood(lines, columns, family, scatter)
        entries, added = _varies(random_effects, unit, _middles(lines, likelihood), priors) if unit is not None else ({}, {})
        if unit is None and random_effects is not None:
            raise InputError("random_effects needs unit: the column that names what differs")
        priors.update(added)
        used = _names_in(lines, likelihood, predict or {}, [k for k in likelihood]) | set(_special) | {unit}
        chosen = {n: h for n, h in columns.items() if n in used}
        in_file = {n: {"column": h, "unit": units[n]} if n in units else h for n, h in chosen.items()}
        if status is not None:
            chosen["status"], in_file["status"] = _status(status, columns, headings)
        unused = [unused] if isinstance(unused, str) else list(unused or ())
        for key in unused:
            if key not in name_of and key not in columns and key not in headings:
                raise InputError(f"unused: data has no column '{key}' (columns: {', '.join(map(str, headings))})")
        unused = [columns.get(key, key) for key in unused]
        parts = [_toml.table("", {"title": title or "; ".join(f"{k} = {v}" for k, v in _lines(formula).items()), "model": "formula"})]
        parts.append(_toml.table("data", {"file": "data", **({"unused": unused} if unused else {})}))
        parts.append(_toml.table("data.columns", in_file))
        if constants:
            parts.append(_toml.table("constants", {k: _toml.quantity(v, f"constants.{k}") for k, v in constants.items()}))
        if lines:
            parts.append(_toml.table("formula", lines))
        for measured, slots in likelihood.items():
            parts.append(_toml.table(f"likelihood.{measured}", slots))
        parts.append(_toml.table("prior", priors))
        if entries:
            parts.append(_toml.table(f"random_effects.{unit}", entries))
        if predict:
            parts.append(_toml.table("predict", predict))
        if sampler:
            parts.append(_toml.table("sampler", sampler))
        only = None
        if table is None:
            # Columns that may say how lives ended go along: the library refuses to pass over them.
            only = set(chosen.values())
            only |= columns_of_few_kinds(data, [h for h in headings if h not in only and h not in unused])
            table = table_of(data, only=only)
        try:
            self._set("\n".join(parts), "study", {"data": table}, {"data": (data, {}, only)})
        except InputError as error:
            raise InputError(_in_python(str(error))) from None

    @staticmethod
    def _likelihood(lines, columns, family, scatter):
        if family not in _slots:
            raise InputError(f"family '{family}' has no single parameter for a formula; likelihood={{...}} gives all of them "
                             f"(families with one: {', '.join(_slots)})")
        middle, spread, usual = _slots[family]
        measured = [name for name in lines if name in columns]
        if not measured:
            raise InputError(f"no left side of the formula is a column of data: {', '.join(lines)} (columns: {', '.join(columns)})")
        likelihood = {}
        for name in measured:
            slots = {"family": family, middle: lines[name]}
            if spread:
                each = scatter.get(name) if isinstance(scatter, dict) else scatter
                slots[spread] = each if each is not None else usual
            likelihood[name] = slots
        return likelihood, {k: v for k, v in lines.items() if k not in measured}

    @classmethod
    def from_toml(cls, text, data=None, *, units=None, folder="", name="study"):
        """A study as text. data: tables by the names that it gives them (``data.file = "inspections"``), of any kind that
        ``wearwell.table`` takes; what is not there is a file in ``folder``. units: by table and heading."""
        if not isinstance(text, str):
            raise InputError(f"the study is {type(text).__name__}; it is a text (Study.from_file reads a file)")
        given = {k: (v, (units or {}).get(k), None) for k, v in (data or {}).items()}
        tables = {k: table_of(v, k, u) for k, (v, u, _) in given.items()}
        return cls.__new__(cls)._set(text, os.path.join(folder, name), tables, given)

    @classmethod
    def from_file(cls, path):
        """A study file (TOML), with the data beside it."""
        self = cls.__new__(cls)
        self._path = os.path.abspath(os.fspath(path))
        self._given, self._shown = {}, os.fspath(path)
        self._read = _core.read_file(os.fspath(path))
        self.toml = self._read.text
        return self

    def _set(self, text, path, tables, given):
        self.toml, self._path, self._shown, self._given = text, path, path, given
        self._read = _core.read_text(text, path, tables)
        return self

    def description(self):
        """What will be fitted, in words and units, as ``wearwell check`` prints it."""
        return self._read.description()

    def fit(self, seed=None, *, method=None, chains=None, warmup=None, draws=None, threads=0, report=True, progress=None):
        """Fits, checks and predicts.

        seed: one seed gives the same numbers to the bit, those of ``wearwell fit --seed``. method: "nuts", "exact" or
        "metropolis"; chains, warmup, draws: as the options of the command. threads: 0 for all; no result depends on it.
        report: computes what report.html shows too. progress: True for a bar, or a function of (what, done, total, seconds).

        The interpreter's lock is released. Ctrl-C raises KeyboardInterrupt within a moment, and nothing is left.
        Warns (CheckWarning) of each check that does not pass. Raises InputError and MachineError.
        """
        choice = {"method": method, "chains": chains, "warmup": warmup, "draws": draws, "seed": seed}
        _require_choice(choice, threads)
        with reporter(progress) as told:
            run = self._read.run(method or "", chains, warmup, draws, seed, threads, bool(report), told)
        return Fit._of(self, run, choice)

    def _asking(self, predict):
        """The same study with another [predict]."""
        text = _without_table(self.toml, "predict") + "\n" + _toml.table("predict", predict)
        tables = {k: table_of(v, k, u, o) for k, (v, u, o) in self._given.items()}
        return _core.read_text(text, self._path, tables)

    def __getstate__(self):
        if any(isinstance(v, _core.Table) for v, _, _ in self._given.values()):
            raise TypeError("a study of wearwell.table(...) cannot be pickled; hand over the data itself")
        return {k: v for k, v in self.__dict__.items() if k != "_read"}

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


def fit(study, seed=None, **options):
    """``fit("study.toml", seed=1)``: reads a study file, or takes a Study, and fits it; options as ``Study.fit``."""
    if not isinstance(study, Study):
        study = Study.from_file(study)
    return study.fit(seed, **options)


def table(data, *, units=None, name="data"):
    """A table for the library, made once for several studies: of a data frame, a dict of columns, a structured array, an Arrow
    stream, a DuckDB relation, or a file. Raises InputError where it is none, naming column and row."""
    return table_of(data, name, units)
