"""The columns of a table that a study uses: their headings, names, units and values."""

import re

from . import _core
from .data import columns_of_few_kinds, headings_of, holds_truths, no_column, table_of, truths_refused, values_of
from .errors import InputError
from .idle_columns import are_counts, are_units, may_be_counts, may_be_units, warn_of_counts, warn_of_units
from .messages import in_python
from .toml import mapping, table, unit_text

_bracket = re.compile(r"\s*[\[(](.*)[\])]\s*\Z", re.DOTALL)
# Words of the formula language and of a study's [data.columns], which no column can be called.
_taken = {"status", "lower", "upper", "entry", "count", "unused", "pi", "and", "or", "not", "exp", "log", "log10", "min", "max", "cum", "where", "abs",
          "sqrt", "pow", "sin", "cos", "tan", "tanh", "erf", "erfc", "probit", "gamma", "lgamma", "digamma", "boltzmann"}
_truths = {"0", "1", "true", "false", "yes", "no", "y", "n"}


class Columns:
    """Columns are asked for by heading, or by its part before a unit: "life" finds "life [h]"."""

    def __init__(self, data, units, taken=()):
        self.data = data
        self.headings = headings_of(data)
        # A table of the library: of everything, or of the columns in use.
        self._whole, self._part = data if isinstance(data, _core.Table) else None, None
        self._part_of = set()
        if self.headings is None:
            self._whole = table_of(data)
            self.headings = self._whole.headings()
        self._bare = {}
        for heading in self.headings:
            self._bare.setdefault(_bracket.sub("", heading).strip(), []).append(heading)
        self._units = {self.heading(key, "units"): unit_text(unit) for key, unit in mapping(units, "units", "{'s': 'km'}").items()}
        self._names, self._arguments = {}, {}
        self._used_names = set(taken) | _taken

    def heading(self, key, argument):
        """The heading of the column that an argument names."""
        if not isinstance(key, str):
            raise InputError(f"{argument} is {type(key).__name__}; it is the heading of a column (columns: {', '.join(self.headings)})")
        found = [key] if key in self.headings else self._bare.get(key, [])
        if len(found) > 1:
            raise InputError(f"{argument}: '{key}' may be '{found[0]}' or '{found[1]}'; write the whole heading")
        if not found:
            raise no_column(self.data, self.headings, key, argument)
        return found[0]

    def take(self, key, argument):
        """The heading, which the study now uses."""
        heading = self.heading(key, argument)
        if heading not in self._names:
            self._names[heading], self._arguments[heading] = self._name_of(heading), argument
        elif self._arguments[heading] != argument:
            raise InputError(f"{argument}: column '{heading}' is that of {self._arguments[heading]} already")
        return heading

    def _name_of(self, heading):
        bare = re.sub(r"\W+", "_", _bracket.sub("", heading).strip(), flags=re.ASCII).strip("_")
        name = bare if re.match(r"[A-Za-z]", bare) else f"column_{bare}".rstrip("_")
        while name in self._used_names or name in self._names.values():
            name += "_"
        return name.rstrip("_") + "_column" if name.endswith("_") else name

    def name(self, heading):
        """The name of the column in formulas."""
        return self._names[heading]

    def unit(self, heading):
        """The unit of a column; "" where it is a plain number."""
        if heading in self._units:
            return self._units[heading]
        match = re.search(r"\[(.*)\]\s*\Z", heading, re.DOTALL)  # as the library reads headings
        if match and match[1].strip():
            return match[1].strip()
        return self._read().unit(heading)

    def entry(self, heading, labels=False):
        """What [data.columns] says of a column of numbers, or of labels."""
        if not labels and holds_truths(self.data if self._whole is None else self._whole, heading):
            raise truths_refused(f"{self._arguments[heading]}:", heading)
        return {"column": heading, "unit": self._units[heading]} if heading in self._units else heading

    def _read(self):
        if self._whole is not None:
            return self._whole
        if not set(self._names) <= self._part_of:
            names = set(self._names)
            self._part = table_of(self.data, only=names)
            self._part_of = names  # after what may refuse them
        return self._part

    def numbers(self, heading):
        """The numbers of a column without those that are missing; InputError names a text."""
        import numpy

        values = self.cells(heading)
        return values[numpy.isfinite(values)]

    def require_numbers(self, heading, argument):
        """That a column holds a number."""
        if len(self.numbers(heading)):
            return
        words = [each for each in self.words(heading) if each]
        raise InputError(f"{argument}: column {heading!r} holds no numbers" + (f", but texts such as {words[0]!r}" if words else ""))

    def cells(self, heading):
        """The numbers of a column by row, NaN of those that are missing."""
        import numpy

        return numpy.asarray(self._read().numbers(heading))

    def open_ends(self, lower, upper):
        """Infinite ends of intervals in memory are missing ones from now on: both are open."""
        import numpy

        if self._whole is not None:
            return
        for heading, end in ((lower, -numpy.inf), (upper, numpy.inf)):
            values = values_of(self.data, [heading]).get(heading, [])
            if isinstance(values, list) or not (infinite := values == end).any():
                continue
            closed = numpy.where(infinite, numpy.nan, values)
            if hasattr(self.data, "assign"):
                self.data = self.data.assign(**{heading: closed})
            elif isinstance(self.data, dict):
                self.data = {**self.data, heading: closed}
            else:
                raise InputError(f"data, row {int(infinite.argmax()) + 1}, column '{heading}': an open end is NaN, not {end}")

    def life_size(self, rows, modes, least, stresses):
        """(median, log_sd, why) of the default prior of a life; ``rows`` is [data.columns], ``least`` the least median."""
        said = {key: rows[key] for key in ("life", "lower", "upper", "status", "count", "entry", "mode") if key in rows}
        runouts = modes.get("runout", [])
        median, log_sd, _, why = _core.life_size(self._read(), table("", said), [runouts] if isinstance(runouts, str) else runouts, float(least), list(stresses))
        return median, int(log_sd) if log_sd == int(log_sd) else log_sd, why

    def words(self, heading):
        """The cells of a column as texts, whole numbers without a point."""
        return self._read().words(heading)

    def require_ends(self, heading, otherwise):
        """That no cell is missing of a column that says how rows ended; of a file the library names the line. ``otherwise``: what 0 means."""
        import numpy

        if self._whole is not None:
            return
        values = values_of(self.data, [heading]).get(heading, [])
        texts = isinstance(values, list)
        missing = numpy.array([not each for each in values], dtype=bool) if texts else values != values
        if missing.any():
            raise InputError(f"data, row {int(missing.argmax()) + 1}, column '{heading}' is missing ({'no text' if texts else 'NaN'}): it says how each row ended; write 1 for "
                             f"a failure and 0 for {otherwise}, or words of them, or leave out the row")

    def kinds(self, heading):
        """The distinct cells as texts, whole numbers without a point."""
        import numpy

        try:
            return {f"{each:.17g}" for each in numpy.unique(self.numbers(heading))}
        except InputError:  # of texts
            return set(self.words(heading))

    def levels(self, heading):
        """The labels of a column in the order in which they come."""
        return [each for each in dict.fromkeys(self.words(heading)) if each]

    def line(self, axis, measured, unit):
        """(whether a straight path begins at 0, whether it falls, its rate)"""
        return _core.straight_line(self._read(), axis, measured, unit)

    def require_rows_of_family(self, axis, measured, family):
        """That all rows are readings of paths of a family."""
        try:
            _core.require_rows_of_family(self._read(), axis, measured, family)
        except InputError as error:
            raise InputError(in_python(str(error))) from None

    def warn_of_idle(self, unused, counts=False, units=False, instead="", otherwise=None, noun="", count_as="independent"):
        """Warns of columns that are neither used nor in ``unused`` and look like counts or units, where a study takes such and has none.

        ``instead``: the argument that has no place beside unit; ``otherwise``: what says that all rows are independent, by default unused.
        ``noun``: what units are called here; ``count_as``: what the rows are without their units.
        """
        left = {h: _bracket.sub("", h).strip() for h in self.headings if h not in self._names and h not in unused}
        of_counts = [h for h, name in left.items() if counts and may_be_counts(name) and h == name and not self._units.get(h)]
        of_units = [h for h, name in left.items() if units and may_be_units(name, noun)]
        values = self._values_of(of_counts + of_units)
        for heading in of_counts:
            if heading in values and are_counts(values[heading]):
                warn_of_counts(heading)
        for heading in of_units:
            if heading in values and are_units(values[heading]):
                warn_of_units(heading, instead, otherwise or f'unused="{heading}"', count_as)

    def _values_of(self, headings):
        if self._whole is None:
            return values_of(self.data, headings)
        found = {}
        for heading in headings:
            found[heading] = self._whole.numbers(heading)
            if any(found[heading] != found[heading]):  # of texts, or with cells that are missing
                found[heading] = self._whole.words(heading)
        return found

    def table(self, unused=()):
        """The table for the library, and the headings that it holds (None: all)."""
        if self._whole is not None:
            return self._whole, None
        only = set(self._names)
        only |= columns_of_few_kinds(self.data, [h for h in self.headings if h not in only and h not in unused])
        return table_of(self.data, only=only), only


def _in_two_ways(heading, what, readings):
    return InputError(f"event: column '{heading}' holds {what}: {'; or '.join(readings)}")


def modes_of(columns, mode):
    """What [failure_modes] says of the column of ``mode``, beside its ``heading``."""
    if mode is None:
        return {}
    entry = dict(mode) if isinstance(mode, dict) else {"column": mode}
    unknown = next((key for key in entry if key not in ("column", "runout", "unknown")), None)
    if unknown or "column" not in entry:
        raise InputError(f"mode has {'no column' if not unknown else f'the key {unknown!r}'}; it is like {{'column': 'cause', 'runout': 0}}")
    heading = columns.take(entry.pop("column"), "mode")
    words = {key: [str(each) for each in value] if isinstance(value, (list, tuple)) else str(value) for key, value in entry.items()}
    return {"heading": heading, **words}


def status_of(columns, event):
    """What [data.columns] says of the column of ``event``: how each life ended."""
    if isinstance(event, dict):
        unknown = next((key for key in event if key not in ("column", "failure", "runout", "left", "interval")), None)
        if unknown or "column" not in event:
            raise InputError(f"event has {'no column' if not unknown else f'the key {unknown!r}'}; it is like {{'column': 'end', 'failure': 1}} "
                             "or {'column': 'end', 'failure': 'broke', 'runout': ['ran', 'stopped']}")
        columns.require_ends(columns.take(event["column"], "event"), "one that still ran")
        return {**event, "column": columns.take(event["column"], "event")}
    heading = columns.take(event, "event")
    columns.require_ends(heading, "one that still ran")
    cells = {cell.lower() for cell in columns.kinds(heading)}
    codes = {cell for cell in cells if cell in _truths or re.fullmatch(r"[+-]?\d+(\.\d*)?", cell)}
    if not codes:
        return heading
    shown = ", ".join(sorted(codes))
    if codes - _truths:
        raise _in_two_ways(heading, f"the codes {shown}", [
            f"event={{'column': '{heading}', 'failure': 1}} reads 1 failed, 0 still running, 2 left-censored, 3 interval",
            f"event={{'column': '{heading}', 'failure': 0}} reads 0 failed, 1 still running, -1 left-censored, 2 interval",
            "if 2 is a failure, as in the codes 1 and 2 of some tables, make a column of True and False",
            f"if the codes are failure modes, mode={{'column': '{heading}', 'runout': 0}} in place of event reads 0 still running"])
    if _core.failure_code_of(heading) == 0:
        raise _in_two_ways(heading, f"{shown}, and its name says that it marks the lives that did not end", [
            f"event={{'column': '{heading}', 'failure': 0}} reads 0 or False as failed",
            f"event={{'column': '{heading}', 'failure': 1}} reads 1 or True as failed"])
    return {"column": heading, "failure": 1}


def repairs_of(columns, event):
    """What [data.columns] says of the column of failures and ends of observation of units that are repaired."""
    if isinstance(event, dict):
        unknown = next((key for key in event if key not in ("column", "failure", "end")), None)
        if unknown or "column" not in event:
            raise InputError(f"event has {'no column' if not unknown else f'the key {unknown!r}'}; it is like {{'column': 'event', 'failure': 1}} "
                             "or {'column': 'event', 'failure': 'repaired', 'end': ['today', 'retired']}")
        columns.require_ends(columns.take(event["column"], "event"), "an end of observation")
        return {**event, "column": columns.take(event["column"], "event")}
    heading = columns.take(event, "event")
    columns.require_ends(heading, "an end of observation")
    codes = {cell.lower() for cell in columns.kinds(heading)} & _truths
    if not codes:
        return heading
    if _core.failure_code_of(heading) == 0:
        raise _in_two_ways(heading, f"{', '.join(sorted(codes))}, and its name says that it marks what is no failure", [
            f"event={{'column': '{heading}', 'failure': 0}} reads 0 or False as a failure",
            f"event={{'column': '{heading}', 'failure': 1}} reads 1 or True as a failure"])
    return {"column": heading, "failure": 1}
