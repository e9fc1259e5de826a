"""What questions about a fit or the folder of a result share."""

import contextlib
import os
import tempfile

from . import _core
from .data import table_of
from .errors import InputError, missing_files, warn


def fitted(fit):
    """The run of a fit and a path, one of them empty."""
    from .fit import Fit

    if isinstance(fit, Fit):
        return fit._live(), ""
    if isinstance(fit, (str, os.PathLike)):
        return None, os.fspath(fit)
    raise InputError(f"fit is {type(fit).__name__}; it is a fit, or the folder of a result")


@contextlib.contextmanager
def named_folders(fits, names):
    """Names and folders of fits or of folders of results: several, or a dict of them by name."""
    from .fit import Fit

    if len(fits) == 1 and isinstance(fits[0], dict):
        if names is not None:
            raise InputError("names and the keys of the dict say the same; leave names out")
        names, fits = [str(each) for each in fits[0]], list(fits[0].values())
    if names is not None and len(names) != len(fits):
        raise InputError(f"{len(names)} names are given for {len(fits)} fits")
    with tempfile.TemporaryDirectory() as folder:
        pairs = []
        for i, each in enumerate(fits):
            usual = chr(ord("a") + i) if i < 26 else str(i + 1)
            if isinstance(each, Fit):
                path = os.path.join(folder, str(i))
                _core.write_folder(path, list(each._files().items()))
            else:
                if not isinstance(each, (str, os.PathLike)):
                    raise InputError(f"{names[i] if names else f'fit {i + 1}'} is {type(each).__name__}; it is a fit, or the folder of a result")
                path = usual = os.fspath(each)
            pairs.append((names[i] if names else usual, path))
        yield pairs


def population(fit):
    """The units of a fit that can be followed; a fit keeps it."""
    from .fit import Fit

    found = fit._population if isinstance(fit, Fit) else population_of(fit)
    warn_unless(found.trusted)
    return found


def population_of(fit):
    with missing_files():
        return _core.population_of(*fitted(fit))


def warn_unless(trusted):
    if not trusted:
        warn("the fit that this rests on is not trusted: see its checks")


def rows_of(data, name):
    """A table of rows; a mapping of single values is one row."""
    if hasattr(data, "keys") and not hasattr(data, "columns") and not hasattr(data, "__arrow_c_stream__") and len(data):
        values = [data[key] for key in data.keys()]
        if all(_is_single(each) for each in values):
            data = {key: [data[key]] for key in data.keys()}
    with missing_files():
        return table_of(data, name)


def columns_of(table):
    """What ``_core.table_of`` makes the table of again."""
    found = []
    for heading in table.headings():
        try:
            values = table.numbers(heading)
        except InputError:
            values = table.words(heading)
        found.append((heading, table.unit(heading), values))
    return found


def _is_single(value):
    return isinstance(value, (str, bytes)) or not hasattr(value, "__len__")


def one_text(value, name):
    if not isinstance(value, str) or not value:
        raise InputError(f"{name} is {value!r}; it is a text")
    return value
