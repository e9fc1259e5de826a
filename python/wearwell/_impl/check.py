"""The checks of a result."""

from typing import NamedTuple

from .messages import in_arguments


class Check(NamedTuple):
    """One check of a result: of the computation, of the model against the data, or of the question.

    Attributes
    ----------
    name : str
        Name of the check, such as "proper-posterior" or "computation".
    verdict : str
        "pass", "warn" or "fail". A fit with a check that fails is not trusted.
    detail : str
        What the check found.
    advice : str
        What to do about it; empty where the check passes.

    Examples
    --------
    >>> import wearwell as ww
    >>> fit = ww.fit("examples/joint/study.toml", seed=1, report=False)
    >>> fit.checks[0].name, fit.checks[0].verdict
    ('proper-posterior', 'pass')
    """

    name: str
    verdict: str
    detail: str
    advice: str


def checks_of(summary):
    """The checks of summary.json."""
    return [Check(c["name"], c["verdict"], in_arguments(c["detail"]), in_arguments(c.get("advice", ""))) for c in summary["checks"]]
