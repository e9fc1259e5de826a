"""Columns that a study does not use although they look like numbers of equal items, or like labels of units with several lives."""

import re

import numpy as np

from .errors import warn

# The words are those of the R package (r/R/response.R).
_counts = re.compile(r"(counts?|weights?|n|quantity|qty|freq|frequency|number)\Z", re.IGNORECASE)
_units = re.compile(r"(units?|machines?|serial|id|(unit|machine|serial)[ ._-]?(id|no|nr|number))\Z", re.IGNORECASE)


def may_be_counts(name):
    return _counts.match(name) is not None


def may_be_units(name, noun=""):
    """``noun``: what else a column of units is called, such as "bearing"."""
    return _units.match(name) is not None or (noun != "" and re.match(f"{noun}s?([ ._-]?(id|no|nr|number))?\\Z", name, re.IGNORECASE) is not None)


def are_counts(values):
    """Whether they are whole positive numbers, neither all 1, which changes nothing, nor those of the rows: 1, 2, 3, ..."""
    if isinstance(values, list) or not len(values):
        return False
    values = np.asarray(values, dtype=float)
    whole = bool(np.all(np.isfinite(values)) and np.all(values > 0) and np.all(values == np.round(values)))
    return whole and bool(np.any(values != 1)) and not np.array_equal(values, np.arange(1, len(values) + 1))


def are_units(values):
    """Whether there are several labels, and one of them stands in several rows."""
    labels = [each for each in (values if isinstance(values, list) else np.asarray(values).tolist()) if each not in (None, "") and each == each]
    return 1 < len(set(labels)) < len(labels)


def warn_of_counts(heading):
    warn(f"column '{heading}' looks like a number of equal rows and is not used: write count=\"{heading}\", or unused=\"{heading}\" if it says "
         "something else")


def warn_of_units(heading, instead, otherwise, count_as="independent"):
    """``instead``: the argument that has no place beside unit; ``otherwise``: what to write if the rows are what they count as."""
    write = f'unit="{heading}"{f" in place of {instead}" if instead else ""}' if count_as == "independent" else (
        f'wearwell.degradation(..., unit="{heading}"), whose rate differs from unit to unit')
    warn(f"column '{heading}' looks like a label of units with several rows each and is not used, so all rows count as {count_as}: write "
         f"{write}, or {otherwise} if that is so")
