"""Questions that a fit answers later: predictions under new conditions."""

import difflib
import json
import re
from collections.abc import Mapping

from .data import headings_of
from .errors import InputError
from .toml import of_numpy, quantity


def tables_of(fit, models=("formula",)):
    """The study's tables as dicts; of a study of these models alone."""
    try:
        import tomllib
    except ImportError:
        raise InputError("fit.predict and fit.life read the study's text with tomllib, of Python 3.11 and later; "
                         "fit.ask(predict) does without") from None
    study = tomllib.loads(fit.study.toml)
    if study.get("model") not in models:
        raise InputError(f"this needs a study of the model {' or '.join(models)}, and this study is of the model "
                         f"{study.get('model')}: use fit.ask(predict) with the keys of its [predict], or fit.quantities and "
                         "fit.tables")
    return study


def columns_of(study):
    """Names of the columns with their units; "" where the heading says it, or where there is none."""
    columns = {}
    for name, entry in study["data"]["columns"].items():
        heading = entry if isinstance(entry, str) else entry["column"]
        unit = "" if isinstance(entry, str) else entry.get("unit", "")
        if not unit and (match := re.search(r"[\[(](.*)[\])]\s*\Z", heading)):
            unit = match[1]
        columns[name] = unit
    return columns


def conditions_of(study, columns):
    """Columns that are neither measured nor name the items or failure modes."""
    skip = set(study["likelihood"]) | set(study.get("random_effects", {})) | {"status", "lower", "upper", "entry", "count"}
    skip.add(study.get("failure_modes", {}).get("column"))
    return [name for name in columns if name not in skip]


def axis_of(study, columns, along):
    """The column of wear and life, None if the study does not state it."""
    known = along or study.get("predict", {}).get("along")
    if known:
        if known not in columns:
            raise InputError(f"along: the study has no column '{known}' (columns: {', '.join(columns)})")
        return known
    rates = [line for line in study.get("formula", {}) if line.startswith("d(")]
    text = json.dumps(study.get("formula", {})) + json.dumps(study["likelihood"])
    if rates or "cum(" in text:
        raise InputError("along is missing: the column along which the formula is a rate or a running sum")
    return None


def _written(value, unit, what):
    """A number with its unit, a text and a quantity of pint with their own."""
    if hasattr(value, "total_seconds"):
        raise InputError(f"{what} is {type(value).__name__}; it is a number, or a text with a unit, like '100 h'")
    if hasattr(value, "magnitude") and hasattr(value, "units"):
        return quantity(value, what)
    if hasattr(value, "tolist"):
        value = of_numpy(value, what)
        value = value[0] if isinstance(value, list) and len(value) == 1 else value
    if isinstance(value, str) or not unit:
        return value
    return f"{value!r} {unit}"


def in_column(heading, value, names):
    """The column that a heading with a unit means, "T [degC]", and a value with that unit."""
    match = None if heading in names or not isinstance(heading, str) else re.match(r"\s*(.*?)\s*[\[(](.*)[\])]\s*\Z", heading)
    if not match or match[1] not in names:
        return heading, value
    return match[1], value if value is None or isinstance(value, (str, Mapping)) or value != value else _written(value, match[2], heading)


def _frame_of(new):
    import pandas

    if headings_of(new) is None:
        raise InputError(f"new is {type(new).__name__}; it is a data frame or a dict of columns")
    frame = new if isinstance(new, pandas.DataFrame) else pandas.DataFrame(dict(new))
    if len(frame) == 0:
        raise InputError("new has no rows")
    twice = frame.columns[frame.columns.duplicated()]
    if len(twice):
        raise InputError(f"new: two columns are called '{twice[0]}'")
    return frame


def require_columns(frame, needed):
    """That a frame ``new`` has these columns; one may be a level of its index, or have another spelling."""
    of = [each for each in frame.columns if isinstance(each, str)]
    bare = [in_column(each, None, needed)[0] for each in of]
    missing = [each for each in needed if each not in bare]
    if not missing:
        return
    levels = [each for each in missing if each in frame.index.names]
    if levels:
        raise InputError(f"new has no column '{levels[0]}'; it is a level of the index, and new.reset_index() makes it a column")
    near = difflib.get_close_matches(missing[0], [each for each in of if each not in needed], n=1, cutoff=0.75)
    has = f" (its columns: {', '.join(of)})" if of else ""
    raise InputError(f"new has no column {' and no column '.join(repr(each) for each in missing)}{has}" + (f"; did you mean '{near[0]}'?" if near else ""))


def _by_name(frame, columns):
    """The columns of a frame that a study has, by its names: "F [kN]" is F, with texts where its unit is another; and those that hold numbers.
    Others are ignored."""
    import pandas

    named, numbers = {}, []
    for heading in frame.columns:
        name, _ = in_column(heading, None, columns)
        if name not in columns:
            continue
        if name in named:
            raise InputError(f"new: '{heading}' and another column are both '{name}'")
        other = name != heading and f"[{columns[name]}]" not in heading.replace("(", "[").replace(")", "]")
        if frame[heading].dtype.kind in "iufb":
            numbers.append(name)
        named[name] = [in_column(heading, value, columns)[1] for value in frame[heading]] if other else frame[heading]
    return pandas.DataFrame(named, index=frame.index), numbers


def _whose(frame, label):
    """For each row the item that it is of, None for a new one."""
    if label not in frame:
        raise InputError(f"new has no column '{label}', which says of which {label} each row is (empty: of a new one)")
    names = []
    for value in frame[label]:
        value = value.item() if hasattr(value, "item") else value
        if isinstance(value, float):
            value = None if value != value else int(value) if value.is_integer() else value
        names.append(None if value is None or str(value) in ("", "<NA>", "NaT") else str(value))
    return names


def _require_values(frame, columns):
    for name in columns:
        missing = frame[name].isna().to_numpy()
        if missing.any():
            raise InputError(f"new, row {int(missing.argmax()) + 1}, column '{name}': a value is missing")
        if frame[name].dtype.kind in "fc":
            wild = ~frame[name].abs().lt(float("inf")).to_numpy()
            if wild.any():
                raise InputError(f"new, row {int(wild.argmax()) + 1}, column '{name}': {frame[name].iloc[wild.argmax()]} is not a finite number")


def _answers(fit, table, level, name, new):
    """Of each place its predictions by measured column, of the item of that name or of a new one. ``new``: the caller's frame, for
    messages."""
    units = [] if name is None else [name]  # none: no paths of items are computed
    try:
        found = fit.ask({**table, "units": units}, level)["predictions"]
    except InputError as error:
        if needed := re.search(r"needs predict(?:={'given': {'|\.given\.)(\w+)", str(error)):
            require_columns(new, [needed[1]])
        unknown = re.search(r"predict.units: the data have no (.*) '(.*)' (\(.*\))", str(error), re.DOTALL)
        if not unknown:
            raise
        raise InputError(f"new, column '{unknown[1]}': the data have no {unknown[1]} '{unknown[2]}' {unknown[3]}; an empty cell is a "
                         "new one") from None
    # Entries come by measured column, then by whom they are of, then by place.
    by_column = {}
    for entry in found:
        seen = entry.get("mean_of") is not None and entry["mean_of"] == entry["pi_of"]
        if seen == (name is not None):
            by_column.setdefault(entry["quantity"], []).append(entry)
    return [list(each) for each in zip(*by_column.values())] or [[]] * len(table["at"])


def predict(fit, new, level, kind, along):
    import pandas

    if kind not in ("mean", "next", "unit"):
        raise InputError(f"kind is {kind!r}; it is 'mean', 'next' or 'unit'")
    study = tables_of(fit)
    columns = columns_of(study)
    conditions = conditions_of(study, columns)
    frame = _frame_of(new)
    if along is None:
        from .lives_of import is_of_lives, predict as predict_lives

        if is_of_lives(study) and axis_of(study, columns, None) is None:
            return predict_lives(fit, study, frame, level, kind)
    written = frame
    frame, of_numbers = _by_name(frame, columns)
    label = next(iter(study.get("random_effects", {})), None)
    if kind == "unit" and label is None:
        raise InputError("kind='unit' needs a study with random effects, and this one has none: kind='next' predicts a "
                         "measurement of a new item")
    whose = _whose(frame, label) if kind == "unit" else [None] * len(frame)
    asked = [c for c in frame.columns if c in conditions]
    numbers = [c for c in asked if c in of_numbers]
    axis = axis_of(study, columns, along)
    if axis is None and kind == "unit" and len(numbers) > 1:
        raise InputError(f"along is missing: the column along which it wears ({', '.join(numbers)}), since beyond its last row "
                         "the path of an item goes on from its present value")
    axis = axis or next(iter(numbers), None)
    if axis is None or axis not in asked:
        require_columns(written, [axis or conditions[0]])
        raise InputError(f"new: column '{axis or conditions[0]}' holds no numbers")
    _require_values(frame, asked)
    others = [c for c in asked if c != axis]
    answers = {}
    rows = list(frame[asked].itertuples(index=False, name=None))
    groups = {}
    for position, row in enumerate(rows):
        each = dict(zip(asked, row))
        groups.setdefault((whose[position], *(each[c] for c in others)), []).append((position, each[axis]))
    for (_, *given), places in groups.items():
        table = {"along": axis, "at": [_written(at, columns[axis], axis) for _, at in places]}
        if others:
            table["given"] = {c: _written(v, columns[c], c) for c, v in zip(others, given)}
        for (position, _), found in zip(places, _answers(fit, table, level, whose[places[0][0]], written)):
            answers[position] = found
    if not all(answers[i] for i in range(len(rows))):
        raise InputError("measurements of a new item are not predicted with two random effects, or of a process; its path is: "
                         "fit.ask({'along': ..., 'at': ...})['quantities']")
    ends = ("ci05", "ci95") if kind == "mean" else ("pi05", "pi95")
    several = len(study["likelihood"]) > 1
    columns_out = {}
    for i in range(len(rows)):
        for entry in answers[i]:
            prefix = f"{entry['quantity']} " if several else ""
            for name, key in (("mean", "mean"), ("lower", ends[0]), ("upper", ends[1])):
                value = entry[key]
                columns_out.setdefault(prefix + name, []).append(float("nan") if value is None else value)
            unit = entry["unit"]
    result = pandas.DataFrame(columns_out, index=frame.index)
    if not several:
        result.attrs["unit"] = unit
    return result
