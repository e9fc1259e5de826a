"""Plans of tests and inspections to come and decisions, as the functions of wearwell.plan and wearwell.decide make them."""

from .answer import Answer
from .errors import warn
from .question import found


class Plan(Answer):
    """A plan of tests or inspections to come, as the functions of ``wearwell.plan`` make it.

    Parameters
    ----------
    title, text, json : str
        What the plan is of, what the program prints, and all numbers as JSON.
    tables : sequence of tuple of str
        Name and CSV of each table.
    page : str
        The report, HTML.
    trusted : bool
        Whether the fit beneath is trusted.
    name : str
        Name of its JSON file, without ".json".

    Attributes
    ----------
    title : str
        What is planned.
    summary : dict
        All numbers, as ``wearwell plan --json`` prints them (plan.json).
    json : str
        The same as text, byte for byte that of the program.
    trusted : bool
        Whether the fit that the plan rests on is trusted; true without a fit.

    Examples
    --------
    >>> import wearwell as ww
    >>> plan = ww.plan.demonstrate("B10 >= 1e6 cycles")
    >>> plan
    <wearwell.Plan 'Show B10 >= 1e6 cycles'>
    >>> plan.summary["plans"][0]["specimens"]
    22
    """

    def __init__(self, title, text, json, tables, page, trusted, name="plan"):
        super().__init__(title, text, json, tables, page, trusted)
        self._file = name


def answer(kind, arguments, about=None, name="", tables=None, threads=0, progress=None):
    """The Plan of this kind."""
    plan = Plan(*found(kind, arguments, about, name, tables, threads, progress), {"decide": "decisions", "life": "life"}.get(kind, "plan"))
    if not plan.trusted:
        warn("the fit that this plan rests on is not trusted: see its checks")
    return plan
