"""Lives that are asked of a fit later, at any level."""

import math
import re

from . import toml
from .ask import _written, axis_of, columns_of, conditions_of, tables_of
from .errors import InputError
from .lives_of import require_lives
from .messages import in_python

_inf, _nan = float("inf"), float("nan")
_b_life = re.compile(r"B(\S+) (?:remaining useful )?life\Z")
# What each other model's [predict] has that a life needs.
_kept = {"archard-joint": ("limit", "risk", "work_per_cycle"),
         "bearing-wear": ("limit", "risk", "pressure", "speed", "contact", "radius", "clearance"),
         "sn": ("types", "stress")}


def _levels(b, confidence):
    b = list(b) if hasattr(b, "__iter__") and not isinstance(b, str) else [b]
    for each in b:
        if isinstance(each, (str, bool)) or not 0 < each < 100:
            raise InputError(f"b holds {each!r}; B-lives are percentages between 0 and 100, like [1, 10]")
    if not b:
        raise InputError("b is empty; B-lives are percentages, like [1, 10]")
    if isinstance(confidence, (str, bool)) or not 0 < confidence < 1:
        raise InputError(f"confidence is {confidence!r}; it lies between 0 and 1, like 0.95")
    return [float(each) for each in dict.fromkeys(b)], float(confidence)


def _of_formula(study, limit, unit, survived, along):
    """The keys of [predict] for a study of a formula."""
    table = {} if survived is None else {"survived": toml.quantity(survived, "survived")}
    if limit is None:
        if unit is not None:
            raise InputError("unit needs a limit, fit.life(limit=..., unit=...): where the data are lives, the life of each item is "
                             "known, and fit.life predicts that of the next one: leave unit out")
        if survived is not None:  # a plain number is in the unit of the measured life
            require_lives(study, [survived], "survived")
            measured = next(iter(study["likelihood"]))
            shown = columns_of(study)[measured]
            if not isinstance(table["survived"], str) and shown[:1].isdigit():  # "1e6 cycles": multiples, or cycles?
                raise InputError(f"survived is {survived} without a unit, and {measured} is in '{shown}': write the number with its unit")
            table["survived"] = _written(table["survived"], shown, "survived")
        return table
    columns = columns_of(study)
    if not isinstance(limit, dict):
        measured = list(study["likelihood"])
        if len(measured) != 1:
            raise InputError(f"limit: of which? {{'{measured[0]}': '...'}} says so")
        limit = {measured[0]: limit}
    axis = axis_of(study, columns, along)
    if axis is None:
        raise InputError(f"along is missing: the column along which it wears ({', '.join(conditions_of(study, columns))})")

    def named(key):  # expressions do not name what is measured, but that of a process
        slots = study["likelihood"].get(key, {})
        return key if "family" in slots and slots["family"].endswith("process") else slots.get("mean", slots.get("median", key))

    return {**table, "along": axis, "limit": {named(k): toml.quantity(v, "limit") for k, v in limit.items()}}


def _of_preset(study, limit, unit, survived, along):
    model = study["model"]
    if unit is not None:
        raise InputError(f"unit needs a study of a formula with random effects; the model {model} predicts the next item: leave "
                         "unit out")
    if survived is not None:
        raise InputError(f"survived needs a study of a formula; for the model {model} "
                         + ("fit.ask(predict) with survival_to gives the probability of survival" if model == "sn" else
                            "fit.results['life'] has the time within which to inspect"))
    if along is not None:
        raise InputError(f"along needs a study of a formula; lives of the model {model} have their axis: leave along out")
    table = {k: v for k, v in study.get("predict", {}).items() if k in _kept[model]}
    if model == "sn":
        if limit is not None:
            raise InputError("limit is of wear; a life of an S-N study ends with failure: leave limit out")
        return table if table else {"types": "all"}
    if limit is not None:
        table["limit"] = toml.quantity(limit, "limit")
    if "limit" not in table:
        raise InputError("limit is missing: fit.life(limit='100 mm^3')" if model == "archard-joint" else
                         "limit is missing: fit.life(limit='80 um')")
    return table


def _asked(fit, table, values):
    try:
        return fit.ask(table)
    except InputError as error:
        keys = {"predict.b_lives": "b", "predict.credible_level": "confidence", **{f"predict.{key}": key for key in values}}
        raise InputError(in_python(str(error), keys, values)) from None


def _number(value):  # null of a life: never
    return _inf if value is None else value


def _row(each, unit=None):
    return {"name": each["name"], "of": each["of"], "at": each["at"], "unit": unit or each["unit"],
            **{q: _number(each[q]) for q in ("q05", "q50", "q95")},
            "predictive": _number(each["predictive"]) if "predictive" in each else _nan,
            "bound": _number(each["bound"]) if "bound" in each else _nan, "undetermined": each.get("undetermined", False)}


def require_determined(rows, what, survived):
    """No row begins where hardly any survive: the library determines no life from there on."""
    if any(row.get("undetermined") for row in rows):
        left = min(row["q50"] if math.isnan(row.get("predictive", _nan)) else row["predictive"]
                   for row in rows if row["name"].startswith("survival to "))
        raise InputError(f"survived: {what} survives to {survived} with a probability of {max(0.0, left):.2g} %; lives from there on "
                         "need at least 0.1 %")


def life(fit, limit, b, confidence, unit, survived, along, given):
    import pandas

    study = tables_of(fit, ("formula", *_kept))
    b, confidence = _levels(b, confidence)
    formula = study["model"] == "formula"
    table = (_of_formula if formula else _of_preset)(study, limit, unit, survived, along)
    if given:
        table = {**table, **({"given": given} if formula else given)}
    answers = _asked(fit, {**table, "b_lives": b, "credible_level": confidence}, {"limit": limit, "survived": survived, "given": given})
    rows = [_row(each) for each in answers.get("quantities", [])]
    if "life" in answers:
        life = answers["life"]
        of = answers["life"].get("of", "")
        rows = [{"name": "life", "of": of or "joint", "at": f"to {life['limit']:g} {life['limit_unit']}", "unit": life["unit"],
                 **{q: _number(life[k]) for q, k in (("q05", "q05"), ("q50", "b50"), ("q95", "q95"))}, "predictive": _nan,
                 "bound": _nan}, *rows] if study["model"] == "archard-joint" else rows
    wanted = "remaining useful life" if unit is not None or (formula and survived is not None) else "life"
    if unit is None:
        def mine(row):  # the next one's, and of all
            return not row["of"].startswith("median ") if not formula else row["of"].startswith("new ") or " " not in row["of"]
    else:
        def mine(row):
            return row["of"].split(" ", 1)[-1] == str(unit) and not row["of"].startswith("new ")
        seen = sorted({row["of"].split(" ", 1)[-1] for row in rows if row["name"] == wanted and not row["of"].startswith("new ")})
        if str(unit) not in seen:
            raise InputError(f"the study has no item '{unit}' (items: {', '.join(seen)})")
    if survived is not None and unit is not None:
        begins = [row["at"] for row in rows if row["name"] == wanted and (mine(row) or row["of"].startswith("new "))]
        if len(set(at.rsplit("from ", 1)[-1] for at in begins)) > 1:
            last = next(row["at"] for row in rows if row["name"] == wanted and mine(row)).rsplit("from ", 1)[-1]
            raise InputError(f"survived: the last row of {unit} is at {last.removesuffix(' on')}, and {survived} lies before: leave survived "
                             "out; the remaining life counts from the last row")
    rows = [row for row in rows if mine(row) and (row["name"] == wanted or row["name"].startswith("survival to ")
                                                  or (_b_life.match(row["name"]) and row["name"].endswith(" " + wanted)
                                                      and ("remaining" in row["name"]) == (wanted != "life")))]
    require_determined(rows, unit if unit is not None else "a new item", survived)
    # Of one thing, whose life only the posterior spreads, the bound is that of its life, and B-lives are its quantiles.
    one = formula and limit is not None and (unit is not None or not ("random_effects" in study or any(
        slots["family"].endswith("process") for slots in study["likelihood"].values()))) or study["model"] == "archard-joint"
    found = []
    for row in rows:
        if row["name"] == wanted:
            of_all = [each for each in rows if _b_life.match(each["name"]) and each["at"] == row["at"]]
            for each in of_all:
                row[f"b{float(_b_life.match(each['name'])[1]):g}"] = each["predictive"]
            if one and of_all:
                row["bound"] = of_all[0]["bound"]
        if not (one and _b_life.match(row["name"])):
            found.append(row)
    columns = ["name", "of", "at", "unit", "q05", "q50", "q95", *(f"b{percent:g}" for percent in b), "predictive", "bound"]
    return pandas.DataFrame(found, columns=columns)
