"""Warranty returns in one line: a returns triangle, or units with their dates of sale and return."""

from . import toml
from .data import _pandas_na, headings_of, no_column, table_of
from .errors import InputError
from .fit_options import fits
from .life_families import families
from .preset_study import quantities
from .proposed import Priors, factor_27, lognormal, rounded_up
from .study import Study

_slope = ("slope", {"distribution": "lognormal", "median": 1.2, "log_sd": 0.5}, "below 1 early failures, above wear-out")

# Each under its own name, without a further argument.
_families = {name: each for name, each in families.items() if name != "log-location-scale"}


def _is_date(value):
    return hasattr(value, "isoformat") or type(value).__name__ in ("Period", "datetime64")


def _is_there(value):
    """Whether a cell has a value; lists and arrays have one, which the library refuses by name."""
    return value is not None and (hasattr(value, "__len__") or value is not _pandas_na() and bool(value == value))


def _text_of_date(value):
    """A day or a month as the library reads it; None where there is none."""
    if not _is_there(value) or str(value) == "NaT":
        return None
    return str(value)[:10] if _is_date(value) else value  # without a time of day


def _with_texts(data):
    """The table with months and days as texts, in its headings and its cells."""
    if not (hasattr(data, "iloc") and hasattr(data, "columns")):
        return data
    data = data.rename(columns={each: _text_of_date(each) for each in data.columns if _is_date(each)})
    for heading in data.columns:
        column = data[heading]
        if getattr(column, "ndim", 1) != 1:
            continue  # two columns of one name, which the library refuses
        first = next((each for each in column if _is_there(each)), None)
        if getattr(column.dtype, "kind", "O") == "M" or (column.dtype == object or type(column.dtype).__name__ == "PeriodDtype") and _is_date(first):
            data = data.assign(**{heading: [_text_of_date(each) for each in column]})
    return data


def _months(table, sold, returned, until):
    """How many months a table of single units covers."""
    import pandas

    if sold is None or returned is None:
        raise InputError(f"{'sold' if sold is None else 'returned'} is missing: the column of the date of {'sale' if sold is None else 'return'} of each unit")
    dates = {each for heading in (sold, returned) for each in table.words(heading)} | {"" if until is None else str(until)}
    found = [pandas.to_datetime(each, errors="coerce") for each in sorted(dates - {""})]
    found = [each for each in found if each == each]
    if not found:
        raise InputError("priors: no default can be proposed, since the dates of sale are of a form that is not known here; state priors={...}, "
                         "or write the dates as 2024-01-31")
    return max(1, (max(found) - min(found)).days / 30.4)


def _delay(value, name, tables):
    """A fixed time, a distribution, or a table of delays and shares."""
    if value is None or isinstance(value, (str, int, float)) or hasattr(value, "magnitude"):
        return None if value is None else toml.quantity(value, name)
    if isinstance(value, dict) and "distribution" in value:
        return toml.distribution(value, name)
    if isinstance(value, dict) and "file" in value:
        return value
    headings = headings_of(value, name)
    if headings is None or len(headings) != 2:
        raise InputError(f"{name}: the table has {'unknown' if headings is None else len(headings)} columns; it has two, delays with their unit and "
                         "the shares of units that have them")
    tables[name] = (table_of(value, name), value, None)
    return {"file": name, "delay": headings[0], "share": headings[1]}


@fits
def returns(data, *, sold=None, quantity=None, returned=None, until=None, period=None, ages="middle", warranty=None, delay_to_use=None,
            delay_of_report=None, hold_out=None, family="weibull", ahead="12 month", cost_per_return=None, planned_sales=None,
            survival_to=None, priors=None, b=(1, 10, 50), predict=None, title=None, seed=None, method=None, chains=None, warmup=None,
            draws=None, threads=0, report=True, progress=None):
    """Fit lives to warranty returns, and forecast the returns to come.

    Parameters
    ----------
    data : table
        A returns triangle (Nevada table): a row for each month of sale with the number of units sold, a column for each month of
        return. Or, with ``returned``, a row for each unit. Dates are texts ("2024-01", "Jan 2024", "2024-01-31"), or those of
        pandas.
    sold, quantity : str, optional
        Columns of the month of sale and of the number of units sold; recognized where it is clear.
    returned : str, optional
        Of single units: column of the month or day of return, empty for a unit that did not come back.
    until : str, optional
        Of single units: the last month that the table covers, "2025-12".
    period : {"month", "week"}, optional
        Length of a period, where the periods are numbers.
    ages : {"middle", "start", "end", "whole"}
        Where in its period of sale the age of a unit begins; ``whole``: a return k periods after the sale is exactly of age k.
    warranty : str or pint quantity, optional
        Length of the warranty in use, "36 month"; later failures are not claimed.
    delay_to_use, delay_of_report : str, dict or table, optional
        Time from the sale until a unit starts, and from a failure until the table has it: a time; a distribution,
        ``{"distribution": "lognormal", "median": "1 month", "log_sd": 0.6}``; or a table of delays and shares.
    hold_out : str, optional
        Last months that are forecast and compared, not fitted: "6 month".
    family : {"weibull", "exponential", "lognormal", "loglogistic", "frechet", "gamma", "inverse-gaussian", "birnbaum-saunders"}
        Distribution of the lives.
    ahead : str or None
        Time of the forecast.
    cost_per_return : str, optional
        Cost of one return, "180 EUR".
    planned_sales : table, optional
        Sales to come: months and units.
    survival_to : str or sequence of str, optional
        Ages to which the share of survivors is asked for, "36 month".
    priors : dict of str to dict, or "flat", optional
        Priors that replace defaults, by parameter. Defaults: the scale (``characteristic``, ``median_life`` or ``mean_life``) is
        lognormal with log_sd 2 and a median of ten times the length of the table, rounded up to 1, 2 or 5 times a power of ten;
        ``slope`` lognormal with median 1.2 and log_sd 0.5; shapes of other families as those of ``wearwell.life``.
    b : float or sequence of float
        Percentages of B-lives.
    predict : dict, optional
        Further keys of ``[predict]`` of a formula study.
    <what all fits share>

    Examples
    --------
    >>> import wearwell as ww
    >>> triangle = {"shipped in": ["Jun 2010", "Jul 2010", "Aug 2010"], "quantity": [100, 140, 150],
    ...             "Jul 2010": [3, None, None], "Aug 2010": [3, 2, None], "Sep 2010": [5, 4, 4]}
    >>> priors = {"characteristic": ww.uniform("1 month", "100 month"), "slope": ww.uniform(0.2, 8)}
    >>> fit = ww.returns(triangle, ages="whole", ahead="1 month", priors=priors, method="exact", report=False)
    >>> mode = fit.results["mode"]["parameters"]
    >>> round(mode["slope"]["value"], 2), round(mode["characteristic"]["value"], 2)
    (2.49, 6.7)
    >>> round(fit.results["returns"]["forecast"][0]["expected"])
    27
    """
    if family not in _families:
        raise InputError(f"family is {family!r}; it is {', '.join(_families)}. wearwell.Study has further ones, with priors that you state")
    data = _with_texts(data)
    table = table_of(data)
    headings = table.headings()
    for name, heading in (("sold", sold), ("quantity", quantity), ("returned", returned)):
        if heading is not None and heading not in headings:
            raise no_column(data, headings, heading, name)
    columns = {key: value for key, value in (("sold", sold), ("quantity", quantity), ("returned", returned), ("until", until), ("period", period))
               if value is not None}
    tables = {}
    columns["ages"] = ages
    for name, value in (("warranty", warranty), ("hold_out", hold_out)):
        if value is not None:
            columns[name] = toml.quantity(value, name)
    for name, value in (("delay_to_use", delay_to_use), ("delay_of_report", delay_of_report)):
        if (delay := _delay(value, name, tables)) is not None:
            columns[name] = delay
    scale, slots, shapes = _families[family]
    known = Priors(priors)
    if isinstance(priors, dict) and scale in priors or returned is None:
        length = max(1, len(headings) - 2)
    else:
        length = _months(table, sold, returned, until)
    known.add(scale, lognormal(rounded_up(10 * length), period or "month", 2), f"{factor_27} of ten times the length of the table, rounded up")
    for name, default, reason in [_slope] if family == "weibull" else shapes:
        known.add(name, default, reason)
    known.require_used()
    asked = {"next": ahead, "cost_per_return": cost_per_return, "b_lives": list(b) if hasattr(b, "__iter__") else [b],
             "survival_to": quantities(survival_to, "survival_to"), **(predict or {})}
    if planned_sales is not None:
        planned_sales = _with_texts(planned_sales)
        tables["planned_sales"] = (table_of(planned_sales, "planned_sales"), planned_sales, None)
        asked["planned_sales"] = {"file": "planned_sales"}
    parts = [toml.table("", {"title": title or "Warranty returns", "model": "formula"}), toml.table("data", {"file": "data"}),
             toml.table("data.returns", columns),
             toml.table("likelihood.life", {"family": family, **{slot: text.replace("{}", scale) for slot, text in slots.items()}}),
             toml.table("prior", known.laws, known.comments), toml.table("predict", {key: each for key, each in asked.items() if each is not None})]
    arguments = {f"data.returns.{key}": key for key in (*columns, "sold", "quantity", "returned", "until", "period", "warranty", "hold_out")}
    arguments["add them up, or name the column of failure modes: [data.returns] mode"] = "add them up"  # which this function does not take
    arguments.update({f"predict.{key}": {"b_lives": "b", "next": "ahead"}.get(key, key) for key in asked})
    study = Study._made("\n".join(parts), {"data": (table, data, None), **tables}, arguments)
    return study.fit(seed, method=method, chains=chains, warmup=warmup, draws=draws, threads=threads, report=report, progress=progress)
