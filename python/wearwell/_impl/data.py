"""Tables of any kind, as the library takes them.

Nothing is copied in Python where a column is a numpy array or a pandas column of float64, strided or not: the library
reads it once, into its own memory. Other numbers are converted on the way (one temporary column), texts are read object
by object.
"""

import decimal
import difflib
import os
import re

import numpy as np

from . import _core
from .errors import InputError, missing_files
from .toml import mapping, unit_text

_exact = 2**53  # whole numbers beyond have no double of their own


def _numbers(array, where):
    kind = array.dtype.kind
    if array.ndim != 1:
        raise InputError(f"{where} has {array.ndim} dimensions; a column has one")
    if kind == "f" and array.dtype.itemsize > 8:
        raise InputError(f"{where} holds {array.dtype}; numbers have at most 64 bits (astype(float))")
    if kind in "iu" and array.dtype.itemsize == 8 and array.size:
        largest = max(abs(int(array.max())), abs(int(array.min())))
        if largest > _exact:
            raise InputError(f"{where}: the whole number {largest} lies beyond 2^53 and cannot be kept to its last digit")
    if kind in "fiub":
        return array
    if kind in "mM":
        advice = "give a number with a unit, like hours since the start" if kind == "M" else "divided by pandas.Timedelta('1h') they are hours"
        raise InputError(f"{where} holds dates or times ({array.dtype}); {advice}")
    if kind == "c":
        raise InputError(f"{where} holds complex numbers")
    return None


_dates = ("datetime", "date", "time", "timedelta", "Timestamp", "Timedelta", "Period", "Interval", "NaTType", "datetime64", "timedelta64")


def _texts(values, where):
    """A list of texts and None; the first row that is neither is named, and where kinds are mixed the first of another kind."""

    if all(type(each) is str for each in values):
        return values

    def kind(each):
        missing = each is None or each is _pandas_na() or (isinstance(each, float) and each != each)
        return "" if missing else "str" if isinstance(each, str) else type(each).__name__

    kinds = [kind(each) for each in values]
    if numbers := _numbers_among_objects(values, kinds, where):
        return numbers[0]
    first = next((k for k in kinds if k), "str")
    other = next((row for row, k in enumerate(kinds) if k and k != first), None)
    if other is not None:
        raise InputError(f"{_at(where, other)}: {values[other]!r} is {kinds[other]}, and above there is {first}; a column holds numbers "
                         "of one dtype (astype(float)) or texts")
    if first != "str":
        row = kinds.index(first)
        if first in _dates:
            raise InputError(f"{_at(where, row)}: {first}; dates and times are no measurements: give a number with a unit, like hours "
                             "since the start")
        raise InputError(f"{_at(where, row)}: {first} in a column of objects, which may hold numbers or texts")
    return [None if not k else each for k, each in zip(kinds, values)]


def _numbers_among_objects(values, kinds, where):
    """A column of objects that are numbers, or truths, all of them, as numbers: such frames come from databases and from JSON."""
    numbers = (int, float, decimal.Decimal, np.integer, np.floating)
    present = [each for k, each in zip(kinds, values) if k]
    if present and all(isinstance(each, (bool, np.bool_)) for each in present):
        return [np.array([np.nan if not k else float(each) for k, each in zip(kinds, values)])]
    if not present or any(isinstance(each, (bool, np.bool_)) or not isinstance(each, numbers) for each in present):
        return None
    return [_numbers(np.array([np.nan if not k else _exactly(each, where) for k, each in zip(kinds, values)], dtype=float), where)]


def _exactly(value, where):
    if not isinstance(value, (int, np.integer)):
        return float(value)
    if abs(int(value)) > _exact:
        raise InputError(f"{where}: the whole number {value} lies beyond 2^53 and cannot be kept to its last digit")
    return int(value)


def _at(where, row):
    name, _, column = where.partition(", column ")
    return f"{name}, row {row + 1}, column {column}"


def _pandas_na():
    import sys

    pandas = sys.modules.get("pandas")
    return pandas.NA if pandas else None


def _values(column, where):
    """An array of numbers, or a list of texts."""
    if hasattr(column, "magnitude") and hasattr(column, "units"):  # pint
        column = column.magnitude
    dtype = getattr(column, "dtype", None)
    if dtype is not None and not isinstance(dtype, np.dtype) and hasattr(column, "isna") and not hasattr(column, "where"):
        import pandas  # whose array this is: a pandas.Categorical, an array of the dtype string

        column = pandas.Series(column)
    if hasattr(column, "cat") and hasattr(dtype, "categories"):  # pandas' categories
        type_of_values = dtype.categories.dtype
        if getattr(type_of_values, "kind", "O") in "iub" and column.isna().any():  # these types hold no missing value
            exact = type_of_values.kind == "b" or abs(dtype.categories.to_numpy()).max(initial=0) <= _exact
            type_of_values = float if exact else object
        column = column.astype(type_of_values)
        dtype = column.dtype
    if dtype is not None and not isinstance(dtype, np.dtype) and hasattr(column, "to_numpy"):  # pandas' own types
        kind = getattr(dtype, "kind", "O")
        if kind in "mM" or type(dtype).__name__ in ("PeriodDtype", "IntervalDtype"):
            raise InputError(f"{where} holds dates, times or intervals ({dtype}); give a number with a unit, like hours since the start")
        if kind in "iu":
            _numbers(column.dropna().to_numpy(dtype=f"{kind}8"), where)  # none beyond 2^53
        if kind in "iufb":
            column = column.to_numpy(dtype=float, na_value=np.nan)
        else:
            column = column.astype(object).where(column.notna(), None).to_numpy()
    elif hasattr(column, "to_numpy"):
        column = column.to_numpy()
    if isinstance(column, np.ma.MaskedArray):
        if column.dtype.kind not in "OUS":
            _numbers(column.compressed() if column.ndim == 1 else column.data, where)  # as of what is not masked
        column = column.astype(object if column.dtype.kind in "OUS" else float).filled(
            None if column.dtype.kind in "OUS" else np.nan
        )
    if not isinstance(column, np.ndarray):
        if isinstance(column, (str, bytes)) or not hasattr(column, "__len__"):
            raise InputError(f"{where} is {type(column).__name__}; a column is an array or a list")
        column = list(column)
        if any(isinstance(each, str) for each in column):
            return _texts(column, where)
        try:
            column = np.asarray([np.nan if each is None or each is _pandas_na() else each for each in column])
        except ValueError:
            raise InputError(f"{where} has elements of different lengths; a column has one number or text a row") from None
    numbers = _numbers(column, where)
    if numbers is not None:
        return numbers
    if column.dtype.kind == "S":
        raise InputError(f"{where} holds bytes; decode them to texts")
    return _texts(column.tolist(), where)


def _headings(names, where):
    """They are texts, and no two are alike."""
    for name in names:
        if isinstance(name, tuple):
            raise InputError(f"{where}: the heading {name!r} has {len(name)} levels; columns have one name each "
                             "(frame.columns = ['_'.join(c) for c in frame.columns])")
        if not isinstance(name, str):
            raise InputError(f"{where}: the heading {name!r} is {type(name).__name__}; headings are texts (frame.columns = frame.columns.map(str))")


def table(data, *, units=None, name="data"):
    """A table for several studies, read once.

    Parameters
    ----------
    data : pandas.DataFrame, dict of columns, structured array, Arrow stream, DuckDB relation, str or path
        The table, of one row or more. Columns are one-dimensional: numbers (read in place where they are float64),
        booleans, or texts; NaN, None and NA are empty cells. An object with ``__arrow_c_stream__`` is an Arrow stream
        (polars, pyarrow). A path is a file: CSV, Parquet, Excel or JSON.
    units : dict, optional
        Unit of each column, by heading: a text or a pint unit. A heading may have it: "F [N]".
    name : str
        Name of the table in messages.

    Returns
    -------
    table
        An opaque table with ``headings()`` and ``rows``, for ``Study``, ``Study.from_toml`` and ``select``.

    Raises
    ------
    InputError
        If the object is no table, or a column holds dates, complex numbers, bytes, infinite values, whole numbers
        beyond 2^53 or texts among numbers; the message names column and row.

    Examples
    --------
    >>> import wearwell as ww
    >>> forces = ww.table({"F": [100, 200], "V": [0.41, 0.78]}, units={"F": "N", "V": "mm^3"})
    >>> forces.headings(), forces.rows
    (['F', 'V'], 2)
    >>> ww.table({"F": [100 + 1j]})
    Traceback (most recent call last):
        ...
    wearwell.InputError: data, column 'F' ...
    """
    return table_of(data, name, units)


def table_of(data, name="data", units=None, only=None):
    """The library's table of ``data``: a data frame, a dict of columns, a structured array, anything with
    ``__arrow_c_stream__``, a DuckDB relation, or the path of a file (CSV, Parquet, Excel, JSON).

    ``units``: of columns, by heading. ``only``: columns of a memory table that are taken, by heading.
    """
    units = {k: unit_text(v) for k, v in mapping(units, "units", "{'s': 'km'}").items()}
    if isinstance(data, _core.Table):
        return data
    if _is_series(data):
        headings_of(data, name)
    if isinstance(data, (str, os.PathLike)):
        with missing_files():
            table = _core.table_of_file(os.fspath(data), None)
    elif hasattr(data, "columns") and hasattr(data, "iloc"):  # pandas
        names = list(data.columns)
        _headings(names, name)
        return _columns(((n, data.iloc[:, i]) for i, n in enumerate(names)), name, units, only, names)
    elif hasattr(data, "__arrow_c_stream__"):
        table, truths = _core.table_of_arrow(name, data.__arrow_c_stream__())
        table.truths = truths
    elif isinstance(data, np.ndarray) and data.dtype.names:
        return _columns(((n, data[n]) for n in data.dtype.names), name, units, only, data.dtype.names)
    elif hasattr(data, "fetchnumpy"):  # DuckDB
        found = data.fetchnumpy()
        return _columns(found.items(), name, units, only, list(found))
    elif hasattr(data, "items") and hasattr(data, "keys"):
        names = list(data.keys())
        _headings(names, name)
        return _columns(data.items(), name, units, only, names)
    else:
        raise InputError(
            f"{name} is {type(data).__name__}; it may be a data frame, a dict of columns, a structured array, an Arrow "
            "stream, or the path of a file" + (f" (pandas.DataFrame({name}))" if hasattr(data, "__len__") else "")
        )
    if units:
        table.add_units(units)
    return table


def _columns(items, name, units, only, names):
    twice = sorted({n for n in names if list(names).count(n) > 1})
    if twice:
        raise InputError(f"{name}: two columns are called '{twice[0]}'")
    columns, truths = [], []
    units = dict(units)
    for heading, column in items:
        if only is not None and heading not in only:
            units.pop(heading, None)
            continue
        unit = units.pop(heading, None)
        if unit is None and hasattr(column, "magnitude") and hasattr(column, "units"):
            unit = unit_text(column.units)
        columns.append((heading, unit or "", _values(column, f"{name}, column '{heading}'")))
        if _are_truths(column):
            truths.append(heading)
    if units:
        raise InputError(f"units: {name} has no column '{next(iter(units))}' (columns: {', '.join(names)})")
    table = _core.table_of(name, columns)
    table.truths = truths
    return table


def _is_series(data):
    return hasattr(data, "iloc") and not hasattr(data, "columns")


def _held(data, headings):
    """Columns of a table in memory, by heading; none of the library's, which has them all."""
    if isinstance(data, _core.Table):
        return {}
    if hasattr(data, "iloc"):
        names = list(data.columns)
        return {h: data.iloc[:, names.index(h)] for h in headings}
    if isinstance(data, np.ndarray) or not hasattr(data, "fetchnumpy"):
        return {h: data[h] for h in headings}
    found = data.fetchnumpy() if headings else {}
    return {h: found[h] for h in headings}


def values_of(data, headings):
    """By heading an array of numbers, or a list of texts; without columns that cannot be read, which a study need not use."""
    found = {}
    for heading, column in _held(data, headings).items():
        try:
            found[heading] = _values(column, f"data, column '{heading}'")
        except InputError:
            continue
    return found


def holds_truths(data, heading):
    """Whether a column in memory is of booleans, which would be read as the numbers 1 and 0. Those of a file are texts."""
    if isinstance(data, _core.Table):
        return heading in getattr(data, "truths", ())
    if hasattr(data, "fetchnumpy") and hasattr(data, "types"):  # a DuckDB relation, which is not run for this
        return str(data.types[data.columns.index(heading)]) == "BOOLEAN"
    return _are_truths(_held(data, [heading])[heading])


def _are_truths(column):
    dtype = getattr(column, "dtype", None)
    kind = getattr(getattr(getattr(dtype, "categories", None), "dtype", dtype), "kind", "O")
    if kind != "O":
        return kind == "b"
    first = next((each for each in column if each is not None and each is not _pandas_na()), None)
    return isinstance(first, (bool, np.bool_))


def truths_refused(where, heading):
    return InputError(f"{where} column '{heading}' holds True and False; it is a number in each row (astype(float) makes 1 and 0)")


def require_no_truths(table, name):
    """That no column of a table of measurements is of booleans."""
    if heading := next(iter(getattr(table, "truths", ())), None):
        raise truths_refused(f"{name},", heading)


def columns_of_few_kinds(data, headings):
    """Those of ``headings`` whose column holds a few numbers or words again and again: it may say how each life ended."""
    return {h for h, values in values_of(data, headings).items() if _has_few_kinds(values)}


def _has_few_kinds(values):
    most = 6
    if isinstance(values, list):
        return len({each for each in values if each}) <= most
    return len(np.unique(values[values == values])) <= most


def no_column(data, headings, key, where):
    """The error of a column that is not there; it knows of levels of the index and of names that are near."""
    if key in _levels_of_index(data):
        return InputError(f"{where}: data has no column '{key}'; it is a level of the index, and data.reset_index() makes it a column")
    near = difflib.get_close_matches(str(key), [str(each) for each in headings], n=1, cutoff=0.75)
    return InputError(f"{where}: data has no column '{key}' (columns: {', '.join(map(str, headings))})"
                      + (f"; did you mean '{near[0]}'?" if near else ""))


def _levels_of_index(data):
    return [each for each in getattr(getattr(data, "index", None), "names", ()) or () if each is not None] if hasattr(data, "iloc") else []


def index_level_of(tables, message):
    """The error of a column that is a level of the index of its table, where a message says that it is not there; else None."""
    match = re.match(r"(?:.*: )?(\w+) has no column '([^']*)'", message)
    if not match or match[1] not in tables:
        return None
    for level in _levels_of_index(tables[match[1]]):
        if isinstance(level, str) and re.sub(r"\s*\[.*", "", level) == re.sub(r"\s*\[.*", "", match[2]):
            return InputError(f"{match[1]} has no column '{level}'; it is a level of the index, and {match[1]}.reset_index() makes it a column")
    return None


def headings_of(data, name="data"):
    """Names of the columns, without reading them where that can be. InputError where they are no texts."""
    headings = _found_headings(data, name)
    if headings is not None:
        _headings(headings, name)
        if not headings:
            raise InputError(f"{name} has no columns")
    return headings


def _found_headings(data, name="data"):
    if _is_series(data):
        raise InputError(f"{name} is {type(data).__name__}, one column without others; it may be a data frame or a dict of columns")
    if isinstance(data, _core.Table):
        return data.headings()
    if isinstance(data, (str, os.PathLike)) or (hasattr(data, "__arrow_c_stream__") and not hasattr(data, "iloc")):
        return None
    if hasattr(data, "columns"):
        return list(data.columns)
    if isinstance(data, np.ndarray) and data.dtype.names:
        return list(data.dtype.names)
    if callable(getattr(data, "keys", None)):  # that of a group-by names its column
        return list(data.keys())
    return None
