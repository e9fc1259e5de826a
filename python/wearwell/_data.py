"""Tables of any kind, as the library takes them.

Nothing is copied in Python where a column is a numpy array or a pandas column of float64, strided or not: the library
reads it once, into its own memory. Other numbers are converted on the way (one temporary column), texts are read object
by object.
"""

import os

import numpy as np

from . import _core
from ._errors import InputError
from ._toml import unit_text

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
        raise InputError(f"{where} holds dates or times ({array.dtype}); give a number with a unit, like hours since the start")
    if kind == "c":
        raise InputError(f"{where} holds complex numbers")
    return None


def _values(column, where):
    """An array of numbers, or a list of texts."""
    if hasattr(column, "magnitude") and hasattr(column, "units"):  # pint
        column = column.magnitude
    dtype = getattr(column, "dtype", None)
    if hasattr(column, "cat") and hasattr(dtype, "categories"):  # pandas' categories
        column = column.astype(object if dtype.categories.dtype == object else dtype.categories.dtype)
        dtype = column.dtype
    if dtype is not None and not isinstance(dtype, np.dtype) and hasattr(column, "to_numpy"):  # pandas' own types
        if getattr(dtype, "kind", "O") in "iufb":
            column = column.to_numpy(dtype=float, na_value=np.nan)
        else:
            column = column.astype(object).where(column.notna(), None).to_numpy()
    elif hasattr(column, "to_numpy"):
        column = column.to_numpy()
    if isinstance(column, np.ma.MaskedArray):
        column = column.astype(object if column.dtype.kind in "OUS" else float).filled(
            None if column.dtype.kind in "OUS" else np.nan
        )
    if not isinstance(column, np.ndarray):
        if isinstance(column, (str, bytes)) or not hasattr(column, "__len__"):
            raise InputError(f"{where} is {type(column).__name__}; a column is an array or a list")
        column = list(column)
        if column and all(isinstance(each, (str, type(None))) for each in column) and any(
            isinstance(each, str) for each in column
        ):
            return column
        try:
            column = np.asarray([np.nan if each is None else each for each in column])
        except ValueError:
            raise InputError(f"{where} has elements of different lengths; a column has one number or text a row") from None
    numbers = _numbers(column, where)
    if numbers is not None:
        return numbers
    if column.dtype.kind == "S":
        raise InputError(f"{where} holds bytes; decode them to texts")
    return column.tolist()  # texts; the library names row and type of whatever else is among them


def _headings(names, where):
    for name in names:
        if not isinstance(name, str):
            raise InputError(f"{where}: the heading {name!r} is {type(name).__name__}; headings are texts")


def table_of(data, name="data", units=None, only=None):
    """The library's table of ``data``: a data frame, a dict of columns, a structured array, anything with
    ``__arrow_c_stream__``, a DuckDB relation, or the path of a file (CSV, Parquet, Excel, JSON).

    ``units``: of columns, by heading. ``only``: columns of a memory table that are taken, by heading.
    """
    units = {k: unit_text(v) for k, v in (units or {}).items()}
    if isinstance(data, _core.Table):
        return data
    if isinstance(data, (str, os.PathLike)):
        table = _core.table_of_file(os.fspath(data), None)
    elif hasattr(data, "columns") and hasattr(data, "iloc"):  # pandas
        names = list(data.columns)
        _headings(names, name)
        return _columns(((n, data.iloc[:, i]) for i, n in enumerate(names)), name, units, only, names)
    elif hasattr(data, "__arrow_c_stream__"):
        table = _core.table_of_arrow(name, data.__arrow_c_stream__())
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
            "stream, or the path of a file"
        )
    if units:
        table.add_units(units)
    return table


def _columns(items, name, units, only, names):
    twice = sorted({n for n in names if list(names).count(n) > 1})
    if twice:
        raise InputError(f"{name}: two columns are called '{twice[0]}'")
    columns = []
    units = dict(units)
    for heading, column in items:
        if only is not None and heading not in only:
            units.pop(heading, None)
            continue
        unit = units.pop(heading, None)
        if unit is None and hasattr(column, "magnitude") and hasattr(column, "units"):
            unit = unit_text(column.units)
        columns.append((heading, unit or "", _values(column, f"{name}, column '{heading}'")))
    if units:
        raise InputError(f"{name} has no column '{next(iter(units))}', of which units tell (columns: {', '.join(names)})")
    return _core.table_of(name, columns)


def headings_of(data):
    """Names of the columns, without reading them where that can be."""
    if isinstance(data, _core.Table):
        return data.headings()
    if isinstance(data, (str, os.PathLike)) or (hasattr(data, "__arrow_c_stream__") and not hasattr(data, "iloc")):
        return None
    if hasattr(data, "columns"):
        return list(data.columns)
    if isinstance(data, np.ndarray) and data.dtype.names:
        return list(data.dtype.names)
    if hasattr(data, "keys"):
        return list(data.keys())
    return None
