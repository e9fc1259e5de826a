"""Survival, hazard and percentiles under conditions: one question to the posterior for each condition."""

import itertools
import json
import re
from collections.abc import Mapping

from . import toml
from .ask import _written, columns_of, conditions_of, in_column, require_columns, tables_of
from .errors import InputError
from .messages import in_python

_of_life = ("status", "lower", "upper", "entry")
_asked = ("b_lives", "survival_to", "hazard_at", "mean_life")
_quantiles = ("q05", "q50", "q95")


def is_of_lives(study):
    """Whether what a study of a formula measures are lives: it says how they ended, or asks for them without a threshold."""
    predict = study.get("predict", {})
    return "limit" not in predict and (any(each in study["data"]["columns"] for each in _of_life) or any(each in predict for each in _asked))


def _study_of_lives(fit, what):
    study = tables_of(fit)
    if not is_of_lives(study):
        raise InputError(f"{what} is of lives that are measured, and this study measures {', '.join(study['likelihood'])}; lives to a failure "
                         "threshold are those of fit.life(limit=...)")
    return study


def _levels(fit, study, columns):
    """By label its levels, of labels that parameters are indexed by."""
    text = json.dumps([study.get("formula", {}), study["likelihood"]])
    found = {}
    for base, label in re.findall(r"([A-Za-z][A-Za-z0-9_]*)\[([A-Za-z][A-Za-z0-9_]*)\]", text):
        if label in columns and label != study.get("failure_modes", {}).get("column"):
            levels = [name[len(base) + 1:-1] for name in fit.results["parameters"] if name.startswith(f"{base}[") and name.endswith("]")]
            if levels:
                found.setdefault(label, levels)
    return found


def _rows(given):
    """Conditions, one dict a row; whether there are several."""
    if hasattr(given, "to_dict") and hasattr(given, "columns"):
        return [{k: v for k, v in row.items()} for row in given.to_dict("records")]
    given = dict(given)
    if any(isinstance(value, (list, tuple)) or hasattr(value, "__array__") and getattr(value, "ndim", 0) for value in given.values()):
        import pandas

        return pandas.DataFrame(given).to_dict("records")
    return [given]


def conditions(fit, study, given):
    """(the names of conditions that differ, for each row its labels and the dict for [predict] given)"""
    columns = columns_of(study)
    names = conditions_of(study, columns)
    usual = dict(study.get("predict", {}).get("given", {}))
    levels = _levels(fit, study, columns)
    if given is None:
        differ = list(levels)
        rows = [dict(zip(levels, each)) for each in itertools.product(*levels.values())]
    else:
        rows = _rows(given)
        if not rows:
            raise InputError("given has no rows")
        differ = [in_column(key, None, names)[0] for key in rows[0]]
    found = []
    for number, row in enumerate(rows):
        values = {}
        for key, value in row.items():
            key, value = in_column(key, value, names)
            if key not in names:
                raise InputError(f"given: the study has no condition '{key}' (conditions: {', '.join(names) or 'none'})")
            if value is None or value != value:
                raise InputError(f"given, row {number + 1}: {key} has no value")
            if key in levels:
                if str(value) not in levels[key]:
                    raise InputError(f"given: {key} has no '{value}' ({', '.join(levels[key])})")
                values[key] = str(value)
            elif isinstance(value, Mapping):  # a distribution over the units
                values[key] = toml.distribution(value, f"given.{key}")
            else:
                values[key] = _written(value, columns[key], f"given: {key}")
        found.append((tuple(str(value) if isinstance(value, Mapping) else value for value in row.values()) if given is not None else tuple(row[key] for key in differ), {**usual, **values}))
    return differ, found


def _measured(study):
    """(the name of the life, its unit)"""
    name = next(iter(study["likelihood"]))
    columns = columns_of(study)
    return name, columns.get(name, columns.get("lower", ""))


def _list(values, what):
    values = [values] if isinstance(values, (str, int, float)) or not hasattr(values, "__iter__") else list(values)
    if not values:
        raise InputError(f"{what} is empty")
    return values


def _frame(rows, differ, name, columns, unit):
    """Rows with the labels of a condition and a place, as a frame that they index."""
    import pandas

    index = [(*labels, place) for labels, place, _ in rows]
    frame = pandas.DataFrame([values for *_, values in rows], columns=columns)
    frame.index = pandas.MultiIndex.from_tuples(index, names=[*differ, name]) if differ else pandas.Index([each[0] for each in index], name=name)
    if unit is not None:
        frame.attrs["unit"] = unit
    return frame


# Lives that may lie below 0.
_of_both_signs = ("normal", "student-t", "smallest-extreme-value", "largest-extreme-value")


def require_lives(study, values, what):
    """Lives that an argument holds: none below 0 where the family has none."""
    slots = next(iter(study["likelihood"].values()))
    if slots.get("family") in _of_both_signs or "threshold" in slots:
        return
    for each in values:
        each = each.item() if hasattr(each, "item") else each
        number = getattr(each, "magnitude", each)
        match = re.match(r"\s*([+-]?[0-9.]+(?:[eE][+-]?\d+)?)", number) if isinstance(number, str) else None
        try:
            number = float(match[1] if match else number)
        except (TypeError, ValueError):
            continue  # which is refused with its unit
        if number < 0:
            raise InputError(f"{what} is {each!r}; lives of this study are 0 or more" if len(values) == 1 else
                             f"{what} holds {each!r}; lives of this study are 0 or more")


def _asked_of(fit, values, what, arguments=None):
    """``arguments``: of keys of ``what``, (name of the argument, its value, a unit that it may have)."""
    table = {"given": values} if values else {}
    try:
        answers = fit.ask({**table, **what}).get("quantities", [])
    except InputError as error:
        asked = (arguments or {}).values()
        said = in_python(str(error), {"predict.given": "given", **{f"predict.{key}": each[0] for key, each in (arguments or {}).items()}},
                         {name: value for name, value, _ in asked})
        unit = next((unit for name, _, unit in asked if unit and said.startswith(f"{name}: ")), None)
        raise InputError(f"{said}; {unit}" if unit else said) from None
    # Of failure modes: those of the part, which come first; the others are of each mode alone, under the same names.
    return [each for each in answers if each["of"].removeprefix("new ") == answers[0]["of"].removeprefix("new ")]


def _life_row(each, keys):
    """Null of a life is infinity: it never ends."""
    inf, nan = float("inf"), float("nan")
    return {key: (inf if each[key] is None else each[key]) if key in each else nan for key in keys}


def _units_of_lives(name, unit):
    return f"{name} is in {unit}" if unit not in ("", "1") else f"{name} is a plain number"


def survival_function(fit, times, given):
    study = _study_of_lives(fit, "survival_function")
    times = _list(times, "times")
    require_lives(study, times, "times")
    name, unit = _measured(study)
    differ, found = conditions(fit, study, given)
    keys = (*_quantiles, "predictive")
    rows = []
    for labels, values in found:
        answers = [each for each in _asked_of(fit, values, {"survival_to": [_written(each, unit, "times") for each in times]},
                                                       {"survival_to": ("times", times, _units_of_lives(name, unit))})
                   if each["name"].startswith("survival to ")]
        rows += [(labels, at, {key: each[key] / 100 for key in keys}) for at, each in zip(times, answers, strict=True)]
    return _frame(rows, differ, name, list(keys), "1")


def hazard(fit, times, given):
    study = _study_of_lives(fit, "hazard")
    times = _list(times, "times")
    require_lives(study, times, "times")
    name, unit = _measured(study)
    differ, found = conditions(fit, study, given)
    rows, of = [], None
    for labels, values in found:
        answers = [each for each in _asked_of(fit, values, {"hazard_at": [_written(each, unit, "times") for each in times]},
                                                       {"hazard_at": ("times", times, _units_of_lives(name, unit))})
                   if each["name"].startswith("hazard at ")]
        rows += [(labels, at, {key: each[key] for key in _quantiles}) for at, each in zip(times, answers, strict=True)]
        of = answers[0]["unit"]
    return _frame(rows, differ, name, list(_quantiles), of)


def _percentages(p):
    found = []
    for each in _list(p, "p"):
        if isinstance(each, str):
            match = re.match(r"\s*([0-9.eE+-]+)\s*%\s*\Z", each)
            number = float(match[1]) if match else -1.0
        elif isinstance(each, bool):
            number = -1.0
        else:
            number = float(each)
            if 0 < number < 1:
                raise InputError(f"p is {each!r}, which may be a percentage, the life by which {each} % have failed: write '{each} %'; or a "
                                 f"fraction: {100 * number:g} is the life by which the fraction {each} has failed, and "
                                 f"{100 - 100 * number:g} that which the fraction {each} survives (percentile of lifelines)")
        if not 0 < number < 100:
            raise InputError(f"p holds {each!r}; it is a percentage that has failed, like 10 or '0.1 %'")
        found.append(number)
    return found


def percentile(fit, p, given, confidence):
    study = _study_of_lives(fit, "percentile")
    p = _percentages(p)
    differ, found = conditions(fit, study, given)
    keys = (*_quantiles, "predictive", "bound")
    rows, of = [], None
    for labels, values in found:
        answers = {each["name"]: each for each in _asked_of(fit, values, {"b_lives": p, "credible_level": confidence},
                                                               {"b_lives": ("p", p, ""), "credible_level": ("confidence", confidence, "")})}
        for each in p:
            answer = answers[f"B{each:.6g} life"]
            rows.append((labels, each, _life_row(answer, keys)))
            of = answer["unit"]
    return _frame(rows, differ, "p", list(keys), of)


def conditional(fit, survived, b, given, confidence):
    from .lives import require_determined

    study = _study_of_lives(fit, "conditional")
    b = _percentages(b)
    require_lives(study, [survived], "survived")
    name, unit = _measured(study)
    differ, found = conditions(fit, study, given)
    keys = (*_quantiles, "predictive", "bound")
    rows = []
    for labels, values in found:
        answers = _asked_of(fit, values, {"survived": _written(survived, unit, "survived"), "b_lives": b, "mean_life": True, "credible_level": confidence},
                            {"survived": ("survived", survived, _units_of_lives(name, unit)), "credible_level": ("confidence", confidence, "")})
        require_determined(answers, "a new item", survived)
        wanted = [each for each in answers if each["name"].startswith("survival to ")]
        wanted += [each for each in answers if each["name"] == "mean remaining useful life"]
        wanted += [each for each in answers if each["name"].startswith("B") and each["name"].endswith(" remaining useful life")]
        rows += [(labels, each["name"], {"unit": each["unit"], **_life_row(each, keys)}) for each in wanted]
    return _frame(rows, differ, "quantity", ["unit", *keys], None)


def predict(fit, study, new, level, kind):
    """For each row of conditions the mean life of all items, or the life of the next one."""
    import pandas

    if level != 0.9:
        raise InputError(f"level is {level}; intervals of lives hold 90 %, and percentile(p, given, confidence) has bounds at any level")
    if kind == "unit":
        raise InputError("kind='unit' predicts measurements of an item along its path; lives are those of new items: kind='next'")
    frame = new if isinstance(new, pandas.DataFrame) else pandas.DataFrame(dict(new))
    names = conditions_of(study, columns_of(study))
    known = [each for each in frame.columns if in_column(each, None, names)[0] in names]
    if len(known) < len(frame.columns) or any(each in names for each in frame.index.names):
        require_columns(frame, names)  # a condition that is missing has its usual value, unless another column may mean it
    _, found = conditions(fit, study, frame[known])
    rows, of = [], ""
    for _, values in found:
        asked = {"mean_life": True} if kind == "mean" else {"mean_life": True, "b_lives": [50]}
        answers = {each["name"]: each for each in _asked_of(fit, values, asked)}
        mean = answers["mean life"]
        ends = mean if kind == "mean" else answers["life"]
        rows.append({"mean": float("inf") if mean["predictive"] is None else mean["predictive"], **dict(zip(
            ("lower", "upper"), _life_row(ends, ("q05", "q95")).values()))})
        of = mean["unit"]
    result = pandas.DataFrame(rows, index=frame.index)
    result.attrs["unit"] = of
    return result
