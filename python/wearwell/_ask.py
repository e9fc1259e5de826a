"""Questions that a fit answers later: predictions under new conditions, lives."""

import json
import re

from . import _toml
from ._data import headings_of
from ._errors import InputError


def _tables(fit):
    """The study's tables as dicts."""
    try:
        import tomllib
    except ImportError:
        raise InputError("fit.predict and fit.life read the study's text with tomllib, of Python 3.11 and later; "
                         "fit.ask(predict) does without") from None
    study = tomllib.loads(fit.study.toml)
    if study.get("model") != "law":
        raise InputError(f"fit.predict and fit.life are of studies of a law (model = \"law\"), and this one is of the model "
                         f"{study.get('model')}; fit.ask(predict) asks it by the keys of its own [predict]")
    return study


def _columns(study):
    """Names of the columns with their units; "" where the heading says it, or where there is none."""
    columns = {}
    for name, entry in study["data"]["columns"].items():
        heading = entry if isinstance(entry, str) else entry["column"]
        unit = "" if isinstance(entry, str) else entry.get("unit", "")
        if not unit and (match := re.search(r"[\[(](.*)[\])]\s*\Z", heading)):
            unit = match[1]
        columns[name] = unit
    return columns


def _conditions(study, columns):
    """Columns that are neither measured nor name the items."""
    skip = set(study["likelihood"]) | set(study.get("varies", {})) | {"status", "lower", "upper", "entry", "count"}
    return [name for name in columns if name not in skip]


def _axis(study, columns, along):
    known = along or study.get("predict", {}).get("along")
    if known:
        if known not in columns:
            raise InputError(f"along: the study has no column '{known}' (columns: {', '.join(columns)})")
        return known
    rates = [line for line in study.get("law", {}) if line.startswith("d(")]
    text = json.dumps(study.get("law", {})) + json.dumps(study["likelihood"])
    if rates or "cum(" in text:
        raise InputError("along is missing: this law is a rate or a running sum along a column")
    return None


def _written(value, unit):
    if hasattr(value, "item"):
        value = value.item()
    if isinstance(value, str) or not unit:
        return value
    return f"{value!r} {unit}"


def predict(fit, new, level, kind, along):
    import pandas

    if kind not in ("mean", "next", "unit"):
        raise InputError(f"kind is {kind!r}; it is 'mean' or 'next'")
    if kind == "unit":
        raise InputError("kind='unit', a measurement of an item that was seen, is not computed yet; its remaining life is: "
                         "fit.life(limit=..., unit=...)")
    study = _tables(fit)
    columns = _columns(study)
    conditions = _conditions(study, columns)
    if headings_of(new) is None:
        raise InputError(f"new is {type(new).__name__}; it is a data frame or a dict of columns")
    frame = new if isinstance(new, pandas.DataFrame) else pandas.DataFrame(dict(new))
    if len(frame) == 0:
        raise InputError("new has no rows")
    unknown = [c for c in frame.columns if c not in columns]
    if unknown:
        raise InputError(f"new: the study has no column '{unknown[0]}' (columns: {', '.join(conditions)})")
    asked = [c for c in frame.columns if c in conditions]
    numbers = [c for c in asked if frame[c].dtype.kind in "iufb"]
    axis = _axis(study, columns, along) or next(iter(numbers), None)
    if axis is None or axis not in asked:
        raise InputError(f"new has no column '{axis or conditions[0]}'")
    missing = frame[asked].isna().any()
    if missing.any():
        raise InputError(f"new, column '{missing.idxmax()}': a value is missing")
    others = [c for c in asked if c != axis]
    answers = {}
    rows = list(frame[asked].itertuples(index=False, name=None))
    groups = {}
    for position, row in enumerate(rows):
        each = dict(zip(asked, row))
        groups.setdefault(tuple(each[c] for c in others), []).append((position, each[axis]))
    for given, places in groups.items():
        table = {"along": axis, "at": [_written(at, columns[axis]) for _, at in places]}
        if others:
            table["given"] = {c: _written(v, columns[c]) for c, v in zip(others, given)}
        found = fit.ask(table, level)["predictions"]
        each = len(found) // len(places)  # one for each measured column
        for i, (position, _) in enumerate(places):
            answers[position] = found[i * each:(i + 1) * each]
    ends = ("ci05", "ci95") if kind == "mean" else ("pi05", "pi95")
    several = len(study["likelihood"]) > 1
    columns_out = {}
    for i in range(len(rows)):
        for entry in answers[i]:
            best = {**entry, **entry.get("exact", {})}
            prefix = f"{entry['quantity']} " if several else ""
            for name, key in (("mean", "mean"), ("lower", ends[0]), ("upper", ends[1])):
                value = best[key]
                columns_out.setdefault(prefix + name, []).append(float("nan") if value is None else value)
            unit = entry["unit"]
    result = pandas.DataFrame(columns_out, index=frame.index)
    if not several:
        result.attrs["unit"] = unit
    return result


def life(fit, limit, b, confidence, unit, survived, along, given):
    import pandas

    study = _tables(fit)
    columns = _columns(study)
    b = [b] if isinstance(b, (int, float)) else list(b)
    table = {"given": given} if given else {}
    if limit is None:
        if unit is not None:
            raise InputError("unit is of lives to a limit: fit.life(limit=..., unit=...)")
        table.update({"b_lives": b, "credible_level": confidence})
        if survived is not None:
            table["survival_to"] = [_toml.quantity(survived, "survived")]
    else:
        if survived is not None:
            raise InputError("survived is of lives that are measured; a life to a limit counts from the item's last row")
        if confidence != 0.9:
            raise InputError(f"confidence is {confidence}; of lives to a limit the interval of 90 % is computed, not another yet")
        unknown = [p for p in b if p not in (1, 10, 50)]
        if unknown:
            raise InputError(f"b: B{unknown[0]:g} of a life to a limit is not computed yet; B1, B10 and B50 are")
        if not isinstance(limit, dict):
            measured = list(study["likelihood"])
            if len(measured) != 1:
                raise InputError(f"limit: of which? {{'{measured[0]}': '...'}} says so")
            limit = {measured[0]: limit}
        axis = _axis(study, columns, along)
        if axis is None:
            raise InputError(f"along is missing: the column along which it wears ({', '.join(_conditions(study, columns))})")
        # What is measured is no name in expressions; its law is.
        limit = {study["likelihood"][k].get("mean", study["likelihood"][k].get("median", k)) if k in study["likelihood"] else k:
                 _toml.quantity(v, "limit") for k, v in limit.items()}
        table.update({"along": axis, "limit": limit})
    found = fit.ask(table).get("quantities", [])
    rows = []
    seen = sorted({q["of"] for q in found if q["name"] == "remaining life"})
    for each in found:
        if limit is not None:
            remaining = each["name"] == "remaining life"
            if remaining != (unit is not None) or each["name"] not in ("life", "remaining life"):
                continue
            if unit is not None and each["of"].split(" ", 1)[-1] != str(unit):
                continue
        best = {**each, **each.get("exact", {})}
        row = {"name": each["name"], "of": each["of"], "at": each["at"], "unit": each["unit"]}
        for key in ("q05", "q50", "q95"):
            row[key] = best.get(key)
        if limit is not None:
            row.update({f"b{p:g}": best.get(f"b{p:g}") for p in b})
        else:
            row.update({"predictive": best.get("predictive"), "bound": best.get("bound")})
        rows.append({k: float("inf") if v is None and k[0] in "qb" and limit is not None else v for k, v in row.items()})
    if unit is not None and not rows:
        raise InputError(f"the study has no item '{unit}' (items: {', '.join(s.split(' ', 1)[-1] for s in seen)})")
    return pandas.DataFrame(rows)
