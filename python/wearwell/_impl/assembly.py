"""The text of a study that is put together of a formula, data and priors."""

import re

from . import toml
from .data import columns_of_few_kinds, headings_of, no_column, table_of
from .errors import InputError

_name = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
_heading = re.compile(r"\s*([A-Za-z][A-Za-z0-9_]*)\s*(?:[\[(].*)?\Z", re.DOTALL)
_text = re.compile(r'"[^"]*"|\[[^\]]*\]')  # of an expression: texts and units are no names
_index = re.compile(r"[A-Za-z0-9_]\[([A-Za-z][A-Za-z0-9_]*)\]")  # m[supplier]: a value for each level of a label
_special = ("status", "lower", "upper", "entry", "count")
# Of a family: the slot that the formula gives, the slot of its scatter, and the default name of that parameter.
_slots = {
    "normal": ("mean", "sd", "sigma"),
    "lognormal": ("median", "log_sd", "sigma"),
    "log10-normal": ("median", "log10_sd", "sigma"),
    "weibull": ("scale", "shape", "shape"),
    "loglogistic": ("scale", "shape", "shape"),
    "frechet": ("scale", "shape", "shape"),
    "inverse-gaussian": ("mean", "shape", "shape"),
    "birnbaum-saunders": ("scale", "shape", "shape"),
    "smallest-extreme-value": ("location", "scale", "sigma"),
    "largest-extreme-value": ("location", "scale", "sigma"),
    "exponential": ("mean", None, None),
    "poisson": ("mean", None, None),
}
# Distributions of priors that say nothing of a sign, or of a fraction; under all others a parameter is positive.
_of_any_sign = ("flat", "uniform", "normal", "student-t", "smallest-extreme-value", "largest-extreme-value", "beta", "default", None)


def _names_in(*texts):
    found = set()
    for text in texts:
        if isinstance(text, dict):
            found |= _names_in(*text.keys(), *text.values())
        elif isinstance(text, (list, tuple)):
            found |= _names_in(*text)
        elif isinstance(text, str):
            found |= set(_name.findall(_text.sub(" ", text))) | set(_index.findall(text))
    return found


def _lines(formula):
    if isinstance(formula, dict):
        return {str(k).strip(): v for k, v in formula.items()}
    if not isinstance(formula, str):
        raise InputError(f"the formula is {type(formula).__name__}; it is a text like 'V = k*F*s', one equation a line")
    lines = {}
    for line in re.split(r"[\n;]", formula):
        if not line.strip():
            continue
        # The first = that is no comparison.
        parts = re.split(r"(?<![<>=!])=(?!=)", line, maxsplit=1)
        if len(parts) != 2 or not parts[0].strip() or not parts[1].strip():
            raise InputError(f"'{line.strip()}' is not an equation; write one like 'V = k*F*s'")
        name = parts[0].strip()
        if name in lines:
            raise InputError(f"the formula gives '{name}' twice")
        lines[name] = parts[1].strip()
    if not lines:
        raise InputError("the formula is empty; write one like 'V = k*F*s'")
    return lines


def _status(status, data, columns, headings):
    """(heading, what stands in [data.columns])"""
    entry = dict(status) if isinstance(status, dict) else {"column": status}
    heading = columns.get(entry.get("column"), entry.get("column"))
    if heading not in headings:
        raise InputError(f"{no_column(data, headings, heading, 'status')}; it is like 'event' or {{'column': 'event', 'failure': 1}}")
    entry["column"] = heading
    return heading, entry if len(entry) > 1 else heading


def _middles(lines, likelihood):
    """The formula without the scatter of measurements about it."""
    scatters = ("family", "sd", "log_sd", "log10_sd", "shape", "df", "trials")
    return list(lines.values()) + [text for slots in likelihood.values() for slot, text in slots.items() if slot not in scatters]


def _varies(random_effects, unit, texts, priors):
    in_law = [p for p in priors if p in _names_in(texts)]
    if random_effects is None:
        if len(in_law) != 1:
            raise InputError(
                f"which of {', '.join(in_law) or 'its parameters'} differ from {unit} to {unit}? "
                f"random_effects=['{in_law[0] if in_law else 'k'}'] says so"
            )
        random_effects = in_law
    if isinstance(random_effects, str):
        random_effects = [random_effects]
    if not isinstance(random_effects, dict):
        random_effects = {p: "normal" if priors.get(p, {}).get("distribution") in _of_any_sign else "lognormal" for p in random_effects}
    entries, added = {}, {}
    for parameter, how in random_effects.items():
        if not isinstance(how, str) or parameter == "correlation":
            entries[parameter] = how
            continue
        scatter = f"{parameter}_scatter"
        entries[parameter] = {"distribution": how, ("log_sd" if how == "lognormal" else "sd"): scatter}
        if scatter not in priors:
            if how != "lognormal":
                raise InputError(f"priors has no '{scatter}': by how much {parameter} differs from {unit} to {unit}")
            added[scatter] = {"distribution": "half-normal", "scale": 1}
    return entries, added


def _likelihood(lines, columns, family, scatter):
    if family not in _slots:
        raise InputError(f"family '{family}': a formula does not give one of its parameters; likelihood={{...}} gives all of them "
                         f"(families that take a formula: {', '.join(_slots)})")
    middle, spread, usual = _slots[family]
    measured = [name for name in lines if name in columns]
    if not measured:
        raise InputError(f"no left side of the formula is a column of data: {', '.join(lines)} (columns: {', '.join(columns)})")
    likelihood = {}
    for name in measured:
        slots = {"family": family, middle: lines[name]}
        if spread:
            each = scatter.get(name) if isinstance(scatter, dict) else scatter
            slots[spread] = each if each is not None else usual
        likelihood[name] = slots
    return likelihood, {k: v for k, v in lines.items() if k not in measured}


def assemble(formula, data, priors, units, unit, random_effects, family, scatter, likelihood, constants, predict, sampler, title, status,
             unused):
    """The study as TOML, its table, and the columns of ``data`` that the table holds (None: all)."""
    units = {k: toml.unit_text(v) for k, v in (units or {}).items()}
    headings = headings_of(data)
    table = None
    if headings is None:
        table = table_of(data)
        headings = table.headings()
    columns, name_of = {}, {}
    for heading in headings:
        match = _heading.match(heading) if isinstance(heading, str) else None
        if match and columns.setdefault(match[1], heading) != heading:
            raise InputError(f"data: the columns '{columns[match[1]]}' and '{heading}' have one name, {match[1]}")
        if match:
            name_of[heading] = match[1]
    for key in units:
        if key not in name_of and key not in columns:
            raise no_column(data, headings, key, "units")
    units = {name_of.get(k, k): v for k, v in units.items()}
    if unit is not None and unit not in columns:
        raise no_column(data, headings, unit, "unit")
    lines = _lines(formula)
    priors = dict(priors)
    for parameter, prior in priors.items():
        if not isinstance(prior, dict):
            raise InputError(f"priors: {parameter} is {type(prior).__name__}; wearwell.lognormal(...) and its like make one")
    if likelihood is None:
        likelihood, lines = _likelihood(lines, columns, family, scatter)
    entries, added = _varies(random_effects, unit, _middles(lines, likelihood), priors) if unit is not None else ({}, {})
    if unit is None and random_effects is not None:
        raise InputError("random_effects needs unit: the column that names the units")
    priors.update(added)
    used = _names_in(lines, likelihood, predict or {}, [k for k in likelihood]) | set(_special) | {unit}
    chosen = {n: h for n, h in columns.items() if n in used}
    in_file = {n: {"column": h, "unit": units[n]} if n in units else h for n, h in chosen.items()}
    if status is not None:
        chosen["status"], in_file["status"] = _status(status, data, columns, headings)
    unused = [unused] if isinstance(unused, str) else list(unused or ())
    for key in unused:
        if key not in name_of and key not in columns and key not in headings:
            raise no_column(data, headings, key, "unused")
    unused = [columns.get(key, key) for key in unused]
    parts = [toml.table("", {"title": title or "; ".join(f"{k} = {v}" for k, v in _lines(formula).items()), "model": "formula"})]
    parts.append(toml.table("data", {"file": "data", **({"unused": unused} if unused else {})}))
    parts.append(toml.table("data.columns", in_file))
    if constants:
        parts.append(toml.table("constants", {k: toml.quantity(v, f"constants.{k}") for k, v in constants.items()}))
    if lines:
        parts.append(toml.table("formula", lines))
    for measured, slots in likelihood.items():
        parts.append(toml.table(f"likelihood.{measured}", slots))
    parts.append(toml.table("prior", priors))
    if entries:
        parts.append(toml.table(f"random_effects.{unit}", entries))
    if predict:
        parts.append(toml.table("predict", predict))
    if sampler:
        parts.append(toml.table("sampler", sampler))
    only = None
    if table is None:
        # Columns that may say how lives ended go along: the library refuses to pass over them.
        only = set(chosen.values())
        only |= columns_of_few_kinds(data, [h for h in headings if h not in only and h not in unused])
        table = table_of(data, only=only)
    return "\n".join(parts), table, only
