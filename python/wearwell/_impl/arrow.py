"""Tables out, by the Arrow C data interface."""

import numpy as np

from . import _core
from .errors import InputError


class ArrowTable:
    """A table that readers of the Arrow C data interface take: DuckDB, polars, pyarrow, pandas 2.2 and later.

    ``Fit.arrow`` and ``wearwell.arrow`` make it. It can be read any number of times; columns of float64 and int64 are not
    copied. The unit of a column is the field's metadata "unit".

    Parameters
    ----------
    columns : sequence of (str, str, array)
        Name, unit ("" for none) and values of each column; all of one length.

    Examples
    --------
    >>> import pandas as pd
    >>> import wearwell as ww
    >>> loads = ww.arrow(pd.DataFrame({"F": [100.0, 200.0]}), units={"F": "N"})
    >>> loads
    <wearwell.ArrowTable of 2 rows: F>
    >>> ww.table(loads).headings()
    ['F']
    """

    def __init__(self, columns):
        self._columns = columns

    @property
    def columns(self):
        """Names of the columns, in order.

        Returns
        -------
        list of str
            The names.

        Examples
        --------
        >>> import pandas as pd
        >>> import wearwell as ww
        >>> ww.arrow(pd.DataFrame({"F": [100.0], "s": [4e4]})).columns
        ['F', 's']
        """
        return [name for name, _, _ in self._columns]

    def __len__(self):
        return len(self._columns[0][2]) if self._columns else 0

    def __arrow_c_stream__(self, requested_schema=None):
        """A capsule "arrow_array_stream" of one batch. Another schema that is asked for is not made; readers convert."""
        return _core.arrow_stream_of(self._columns)

    def __repr__(self):
        return f"<wearwell.ArrowTable of {len(self)} rows: {', '.join(self.columns)}>"


def _values(column, name):
    values = column.to_numpy()
    if values.dtype.kind in "fiub":
        return values
    if values.dtype.kind != "O":
        raise InputError(f"column '{name}' holds {values.dtype}, which is neither numbers nor texts")
    texts = [None if each is None or each is getattr(column, "NA", None) or each != each else each for each in values.tolist()]
    if all(isinstance(each, bool) for each in texts) and texts:
        return np.asarray(texts, dtype=bool)
    return texts


def arrow(frame, units=None):
    """A data frame as an ArrowTable, such as ``Fit.predict`` and ``Fit.life`` return.

    Parameters
    ----------
    frame : pandas.DataFrame
        The frame. An index with names, or one that does not count rows from 0, becomes columns before the others.
    units : dict of str to str, optional
        Units by column, kept as metadata "unit".

    Returns
    -------
    ArrowTable
        An object with ``__arrow_c_stream__``.

    Raises
    ------
    InputError
        If it is not a data frame, a heading is not a text or occurs twice, or a column holds neither numbers nor texts.

    Examples
    --------
    >>> import pandas as pd
    >>> import wearwell as ww
    >>> len(ww.arrow(pd.DataFrame({"F": [100.0, 200.0]}), units={"F": "N"}))
    2
    """
    if not hasattr(frame, "columns") or not hasattr(frame, "iloc"):
        raise InputError(f"frame is {type(frame).__name__}; it is a data frame")
    units = dict(units or {})
    columns = []
    index = frame.index
    counted = index.nlevels == 1 and index.name is None and type(index).__name__ == "RangeIndex"
    for level in range(0 if counted else index.nlevels):
        name = index.names[level] or ("index" if index.nlevels == 1 else f"index{level + 1}")
        columns.append((str(name), index.get_level_values(level)))
    for i, name in enumerate(frame.columns):
        if not isinstance(name, str):
            raise InputError(f"frame: the heading {name!r} is {type(name).__name__}; headings are texts")
        columns.append((name, frame.iloc[:, i]))
    names = [name for name, _ in columns]
    twice = [name for name in names if names.count(name) > 1]
    if twice:
        raise InputError(f"frame: two columns are called '{twice[0]}'")
    return ArrowTable([(name, str(units.get(name, "")), _values(values, name)) for name, values in columns])
