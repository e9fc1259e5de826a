"""Studies of presets of a table: which columns they take, and which conditions are the same for all rows."""

from . import toml
from .columns import Columns
from .errors import InputError
from .study import Study


_labels = ("label", "unit", "bearing", "mode", "contact")  # columns whose cells a study reads as texts


class Preset:
    """A study of a preset, put together of arguments.

    An argument of a column is the heading; a quantity, "5 N m" or a number, is a condition of all rows.
    """

    def __init__(self, model, data, units):
        self.model, self.data = model, data
        self.columns = Columns(data, units)
        self.rows, self.conditions, self.arguments = {}, {}, {}
        self.choices, self.of_data = {}, {}  # further keys of the study, and of its [data]

    def column(self, key, argument, value):
        """A column that the study needs."""
        if value is None:
            return
        heading = self.columns.take(value, argument)
        self.rows[key] = self.columns.entry(heading, labels=key in _labels)
        self.arguments[f"data.columns.{key}"] = argument

    def either(self, key, argument, value):
        """A column, or a condition that is the same for all rows."""
        if value is None:
            return
        if isinstance(value, str) and (value in self.columns.headings or value in self.columns._bare):
            self.column(key, argument, value)
            return
        if isinstance(value, str) and not value.strip()[:1].isdigit() and value.strip()[:1] not in "+-." and key not in ("contact",):
            self.columns.heading(value, argument)  # which is not there
        self.conditions[key] = toml.quantity(value, argument)
        self.arguments[f"conditions.{key}"] = argument

    def status(self, entry):
        self.rows["status"] = entry
        self.arguments["data.columns.status"] = "event"

    def study(self, title, tables, priors, predict, unused=None, may_have_counts=False, **units):
        """``tables``: further tables of the study by name, such as [law]. ``may_have_counts``: the caller has an argument count.
        ``units``: of ``Columns.warn_of_idle``, if rows may be of several units."""
        unused = [self.columns.heading(each, "unused") for each in ([unused] if isinstance(unused, str) else unused or ())]
        self.columns.warn_of_idle(unused, counts=may_have_counts and "count" not in self.rows, **units)
        for name, prior in (priors or {}).items():
            if not isinstance(prior, dict):
                raise InputError(f"priors: {name} is {type(prior).__name__}; wearwell.lognormal(...) and its like make one")
        predict = {key: each for key, each in predict.items() if each is not None}
        parts = [toml.table("", {"title": title, "model": self.model, **self.choices}),
                 toml.table("data", {"file": "data", **({"unused": unused} if unused and self.model == "sn" else {}), **self.of_data}),
                 toml.table("data.columns", self.rows)]
        if self.conditions:
            parts.append(toml.table("conditions", self.conditions))
        parts += [toml.table(name, entries) for name, entries in tables.items() if entries]
        if priors:
            parts.append(toml.table("prior", priors))
        else:
            parts.append("# Without [prior] the defaults of the model apply; the description of the study has them.\n")
        if predict:
            parts.append(toml.table("predict", predict))
        table, only = self.columns.table(unused)
        return Study._made("\n".join(parts), {"data": (table, self.data, only)}, {
            "predict.limit": "limit", **self.arguments, **{f"predict.{key}": {"b_lives": "b", "credible_level": "confidence", "age": "at", "next": "ahead"}.get(key, key) for key in predict}})


def quantities(values, name):
    """A list of quantities of one or several."""
    if values is None:
        return None
    if isinstance(values, (list, tuple)):
        return [toml.quantity(each, name) for each in values]
    return [toml.quantity(values, name)]


def percentages(b):
    """Those of B-lives."""
    return None if b is None else list(b) if hasattr(b, "__iter__") and not isinstance(b, str) else [b]


def level_of_bounds(confidence, predict):
    """The key of ``confidence``; none where ``predict`` has ``level``, another name of it, and ``confidence`` is the default."""
    return {} if confidence == 0.9 and "level" in (predict or {}) else {"credible_level": confidence}


def classical_key(classical):
    """The key of ``classical`` under [predict]; none where it is False."""
    if not isinstance(classical, bool):
        raise InputError(f"classical is {classical!r}; it is True or False")
    return {"classical": True} if classical else {}
