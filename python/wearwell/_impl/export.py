"""A fitted formula as C or SQL: what ``wearwell export`` does."""

import os
from collections.abc import Mapping
from json import dumps

from . import _core
from .errors import InputError, missing_files
from .fitted import fitted, one_text, warn_unless


def _given(**arguments):
    return dumps({key: value for key, value in arguments.items() if value is not None})


def _texts(value, name):
    """One text or several; a mapping is NAME=VALUE."""
    if value is None:
        return None
    if isinstance(value, Mapping):
        return [f"{one_text(key, name)}={one_text(each, name)}" for key, each in value.items()]
    return [one_text(each, name) for each in ([value] if isinstance(value, str) else value)]


def export_c(fit, folder, *, name="unit", unit=None, lines=None):
    """Write one unit of a fitted formula as C99 for a controller: readings in, remaining useful life out.

    Writes what ``wearwell export c`` writes: a header, a source without allocation, and a test with reference numbers.

    Parameters
    ----------
    fit : Fit, str or path
        A fit of a formula with a failure threshold, or the folder of its result.
    folder : str or path
        Folder for NAME_unit.h, NAME_unit.c and NAME_test.c. Files of an earlier result are replaced.
    name : str
        Prefix of the names of files and functions.
    unit : str, optional
        A unit of the study, conditioned on its readings; by default a new unit.
    lines : int, optional
        Points of the posterior, 16 to 20 000: more are more precise and need more memory. By default as in the monitor.

    Returns
    -------
    str
        Number of nodes, and sizes of the tables in bytes.

    Raises
    ------
    InputError
        If the study is of another model, its formula or scatter cannot be exported, or an argument is wrong.
    MachineError
        If the disk fails.

    Warns
    -----
    CheckWarning
        If the fit is not trusted.

    Examples
    --------
    >>> import os, tempfile
    >>> import wearwell as ww
    >>> fit = ww.fit("examples/fleet/study.toml", seed=1, method="exact", draws=100, report=False)
    >>> folder = os.path.join(tempfile.mkdtemp(), "pump")
    >>> print(ww.export_c(fit, folder, name="pump", lines=64).split(",")[0])
    640 nodes on 64 lines
    >>> sorted(each for each in os.listdir(folder) if each.startswith("pump"))
    ['pump_test.c', 'pump_unit.c', 'pump_unit.h']
    """
    if isinstance(lines, bool):
        raise InputError(f"lines is {lines!r}; it is a whole number from 16 to 20000")
    arguments = _given(name=one_text(name, "name"), unit=None if unit is None else one_text(unit, "unit"), lines=lines)
    with missing_files():
        files, text, trusted = _core.export_c(*fitted(fit), arguments)
    _core.write_folder(os.fspath(folder), files)
    warn_unless(trusted)
    return text


def export_sql(fit, dialect, table, *, value=None, unit=None, columns=None, keep=None, prefix="wearwell", draws=400, part="all"):
    """SQL that computes a value of a fitted formula with its interval for every row of a table.

    The text is what ``wearwell export sql`` prints.

    Parameters
    ----------
    fit : Fit, str or path
        A fit of a formula, or the folder of its result.
    dialect : {"duckdb", "postgresql", "clickhouse"}
        The database.
    table : str
        SCHEMA.TABLE; a part in double quotes may hold dots.
    value : str, optional
        An expression of the formula; by default the one that the first measured column observes.
    unit : str, optional
        Unit of the answer.
    columns : dict of str to str, or sequence of str, optional
        Columns of the table that have other names or units than the study: ``{"force": "F:kN"}``, or "force=F:kN".
    keep : str or sequence of str, optional
        Further columns of the table to include in the answer.
    prefix : str
        Name of the table of draws that the statements create.
    draws : int
        Number of draws, a multiple of 20; more give more precise intervals.
    part : {"all", "setup", "query"}
        Both statements or one of them.

    Returns
    -------
    str
        The statements, with comments.

    Raises
    ------
    InputError
        If the study is of another model, a name, unit or expression is wrong, or the engine cannot compute it.

    Warns
    -----
    CheckWarning
        If the fit is not trusted.

    Examples
    --------
    >>> import wearwell as ww
    >>> fit = ww.fit("examples/fleet/study.toml", seed=1, method="exact", draws=100, report=False)
    >>> sql = ww.export_sql(fit, "duckdb", "fleet.liners", columns={"use": "hours:h"}, draws=20)
    >>> "create table if not exists" in sql, "formula_q95" in sql
    (True, True)
    """
    if part not in ("all", "setup", "query"):
        raise InputError(f"part is {part!r}; it is 'all', 'setup' or 'query'")
    if isinstance(draws, bool):
        raise InputError(f"draws is {draws!r}; it is a multiple of 20")
    arguments = _given(dialect=one_text(dialect, "dialect"), table=one_text(table, "table"), value=value, unit=unit,
                       columns=_texts(columns, "columns"), keep=_texts(keep, "keep"), prefix=one_text(prefix, "prefix"), draws=draws, part=part)
    with missing_files():
        text, trusted = _core.export_sql(*fitted(fit), arguments)
    warn_unless(trusted)
    return text
