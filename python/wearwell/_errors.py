"""Exceptions and warnings: the words are those of the command line."""

import os
import sys
import warnings


class InputError(ValueError):
    """The request or the data is wrong; the message names file, row, column and value, and what is allowed."""


class MachineError(OSError, RuntimeError):
    """The machine failed: disk, memory, a library that is missing."""


class NotTrusted(RuntimeError):
    """``Fit.require_trusted()`` of a fit of which a check failed."""


class CheckWarning(UserWarning):
    """A check of a fit warns, or fails; all of them stand in ``Fit.checks``."""


for _each in (InputError, MachineError, NotTrusted, CheckWarning):
    _each.__module__ = "wearwell"


def warn(message):
    """A CheckWarning at the line that called the package."""
    here, frame, level = os.path.dirname(__file__), sys._getframe(1), 2
    while frame is not None and os.path.dirname(frame.f_code.co_filename) == here:
        frame, level = frame.f_back, level + 1
    warnings.warn(message, CheckWarning, stacklevel=level)


def warn_of(checks):
    for check in checks:
        if check.verdict != "pass":
            word = "warns" if check.verdict == "warn" else "fails"
            warn(f"{check.name} {word}: {check.detail}. {check.advice}".rstrip())
