"""Data frames of what a fit found, made of summary.json. Null is NaN; of a life it is infinity: the life never ends."""

from .errors import InputError

_nan, _inf = float("nan"), float("inf")
_quantiles = ["q05", "q50", "q95", "b1", "b10", "b50"]


def _frame(rows, columns, index=None):
    import pandas

    frame = pandas.DataFrame(rows, columns=columns)
    return frame.set_index(index) if index else frame


def _number(value):
    return _nan if value is None else value


def _life(value):
    return _inf if value is None else value


def require(summary, key, what):
    """This part of the summary of a posterior; InputError where the model has none."""
    if "sampler" not in summary or key not in summary:
        raise InputError(f"a study of the model {summary['model']} has no {what}; fit.results and fit.tables hold what it found")
    return summary[key]


def parameters(summary):
    rows = []
    for name, each in require(summary, "parameters", "parameters").items():
        rows.append({
            "name": name, "unit": each["unit"], **{k: _number(each[k]) for k in ("mean", "sd", "q05", "q50", "q95")},
            **{k: _number(each["draws"][k]) for k in ("mcse", "ess_bulk", "ess_tail", "rhat")}, "exact": each["by"] == "quadrature",
            "prior": each.get("prior", {}).get("words", ""), "default_prior": each.get("prior", {}).get("default", False)})
    return _frame(rows, ["name", "unit", "mean", "sd", "q05", "q50", "q95", "mcse", "ess_bulk", "ess_tail", "rhat", "exact",
                         "prior", "default_prior"], "name")


def predictions(summary):
    rows = []
    for each in require(summary, "predictions", "predictions of a posterior"):
        at = next(iter(each))  # "cycles": the first key is what it is at
        rows.append({"at_name": at, "at": each[at], "quantity": each["quantity"], "unit": each["unit"],
                     **{k: _number(each[k]) for k in ("mean", "ci05", "ci95", "pi05", "pi95")},
                     "measured": _number(each.get("measured"))})
    return _frame(rows, ["at_name", "at", "quantity", "unit", "mean", "ci05", "ci95", "pi05", "pi95", "measured"])


def _lives_and_quantities(summary):
    rows = []
    for each in summary.get("quantities", []):
        is_life = "b10" in each
        null_is_never = is_life and not each.get("undetermined")
        rows.append({
            "name": each["name"], "of": each["of"], "at": each["at"], "unit": each["unit"], "is_life": is_life,
            **{q: (_life if null_is_never else _number)(each[q]) if q in each else _nan for q in _quantiles},
            "predictive": _number(each.get("predictive")), "bound": _number(each.get("bound")), "upper_bound": _number(each.get("upper_bound")),
            "credible_level": _number(each.get("credible_level")), "mean": _number(each.get("mean"))})
    return rows


def quantities(summary):
    upper = ["upper_bound"] if any("upper_bound" in each for each in summary.get("quantities", [])) else []  # with predict.sides
    return _frame(_lives_and_quantities(summary),
                  ["name", "of", "at", "unit", "is_life", *_quantiles, "predictive", "bound", *upper, "credible_level", "mean"])


def lives(summary):
    if "sampler" not in summary:
        require(summary, "life", "lives of this form")
    rows = [row for row in _lives_and_quantities(summary) if row["is_life"]]
    if "life" in summary:
        life = {"q50": summary["life"]["b50"], **summary["life"]}  # the median has one name of the two there
        rows.insert(0, {"name": "life", "of": life.get("of", ""), "at": f"to {life['limit']:g} {life['limit_unit']}",
                        "unit": life["unit"], **{q: _life(life[q]) if q in life else _nan for q in _quantiles}, "predictive": _nan,
                        "bound": _nan, "credible_level": _nan})
    stated = [key for key in ("predictive", "bound", "credible_level") if any(row[key] == row[key] for row in rows)]
    return _frame(rows, ["name", "of", "at", "unit", *_quantiles, *stated])
