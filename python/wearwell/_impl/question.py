"""Questions with arguments as the commands of the program have them, about fits, studies, tables or files."""

import math
import numbers
import os
from collections.abc import Mapping
from json import dumps

from . import _core
from .data import table_of
from .errors import InputError, missing_files
from .progress import reporter
from .toml import of_numpy, quantity


def _written(value, name):
    """An argument as JSON has it."""
    if value is None or isinstance(value, (str, bool)):
        return value
    if hasattr(value, "magnitude") and hasattr(value, "units"):  # pint
        return quantity(value, name)
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, Mapping):
        return {str(key): _written(each, name) for key, each in value.items()}
    if hasattr(value, "tolist"):  # a number or an array of numpy, a column of pandas
        return _written(of_numpy(value, name), name)
    if isinstance(value, numbers.Integral):
        return int(value)
    if isinstance(value, numbers.Real):
        if not math.isfinite(value):
            raise InputError(f"{name} is {value!r}; a number is finite")
        return float(value)
    if isinstance(value, (list, tuple, range)):
        return [_written(each, name) for each in value]
    raise InputError(f"{name} is {type(value).__name__}; it is a text, a number, or several of them")


def _subject(about, name):
    """The fit, the study, the path and the tables that a question is about; three of them are none."""
    from .fit import Fit
    from .study import Study

    if isinstance(about, Fit):
        return about._live(), None, "", []
    if isinstance(about, Study):
        return None, about._read, "", []
    if about is None:
        raise InputError(f"{name} is None; it is a fit, the folder of a result, or a table")
    if isinstance(about, (str, os.PathLike)):
        return None, None, os.fspath(about), []
    return None, None, "", _tables(about, name)


def _several(data):
    return [] if data is None else list(data) if isinstance(data, (list, tuple)) else [data]


def _tables(data, name):
    """The tables that an argument holds: one, or a list of them."""
    return [(name, table_of(each, name)) for each in _several(data)]


def files_and_tables(data):
    """The paths in an argument that holds tables or files, and the others."""
    several = _several(data)
    is_path = [isinstance(each, (str, os.PathLike)) for each in several]
    return [e for e, path in zip(several, is_path) if path], [e for e, path in zip(several, is_path) if not path]


def found(kind, arguments, about=None, name="", tables=None, threads=0, progress=None, other=None):
    """What the library answers: the arguments of an Answer. ``about``: what the argument called ``name`` holds. ``tables``: more data
    frames, by argument. ``other``: the run of a second fit."""
    if not isinstance(threads, int) or not 0 <= threads <= 1024:
        raise InputError(f"threads is {threads!r}; it is a whole number from 0 (all) to 1024")
    text = dumps({key: _written(value, key) for key, value in arguments.items() if value is not None})
    run, study, path, held = _subject(about, name) if name else (None, None, "", [])
    for key, data in (tables or {}).items():
        held += _tables(data, key)
    with reporter(progress) as report, missing_files():
        return _core.answer(kind, text, run, other, study, path, held, threads, report)
