"""Exceptions and warnings: the words are those of the command line, with arguments in place of its options."""

import contextlib
import os
import sys
import warnings

from .messages import in_arguments, in_python


class InputError(ValueError):
    """The request or the data is wrong. It is a ValueError.

    The message names file and key, or row, column and value, and says what is allowed.

    Examples
    --------
    >>> import wearwell as ww
    >>> try:
    ...     ww.lognormal([1e-7], log_sd=3)
    ... except ww.InputError as error:
    ...     print(str(error).split(";")[0])
    median is list
    """

    def __init__(self, *args):
        super().__init__(*(in_arguments(each) if isinstance(each, str) else each for each in args))


class MissingFileError(InputError, FileNotFoundError):
    """A file is missing: a study, or a table. It is an InputError and a FileNotFoundError.

    Examples
    --------
    >>> import wearwell as ww
    >>> try:
    ...     ww.fit("nope.toml")
    ... except FileNotFoundError as error:
    ...     print(type(error).__name__)
    MissingFileError
    """


class MachineError(OSError, RuntimeError):
    """The machine failed: disk, memory, or a missing library. It is an OSError and a RuntimeError.

    Examples
    --------
    >>> import wearwell as ww
    >>> issubclass(ww.MachineError, OSError)
    True
    """


class NotTrusted(RuntimeError):
    """A check of a fit failed: ``Fit.require_trusted`` raises it.

    Examples
    --------
    Three readings and flat priors do not hold a wear coefficient:

    >>> import wearwell as ww
    >>> fit = ww.fit("examples/joint/improper_normal.toml", seed=1, report=False)
    >>> try:
    ...     fit.require_trusted()
    ... except ww.NotTrusted as error:
    ...     print(str(error).split(":")[0])
    proper-posterior
    """


class CheckWarning(UserWarning):
    """A check of a fit or a selection warns or fails. ``Fit.checks`` has all of them.

    Examples
    --------
    >>> import warnings
    >>> import wearwell as ww
    >>> with warnings.catch_warnings(record=True) as caught:
    ...     warnings.simplefilter("always")
    ...     fit = ww.fit("examples/joint/study.toml", seed=1, report=False)
    >>> [str(each.message).split(":")[0] for each in caught if issubclass(each.category, ww.CheckWarning)]
    ['fit warns']
    """


@contextlib.contextmanager
def missing_files():
    """An InputError of a file that is not there is a FileNotFoundError too."""
    try:
        yield
    except InputError as error:
        if "no such file" in str(error) and not isinstance(error, MissingFileError):
            raise MissingFileError(str(error)) from None
        raise


@contextlib.contextmanager
def in_words_of_caller(words):
    """An InputError of a study that a function made of its arguments speaks of these. ``words``: (arguments by key, their values), None where the
    caller wrote the study."""
    try:
        yield
    except InputError as error:
        if words is None or isinstance(error, MissingFileError):
            raise
        raise InputError(in_python(str(error), *words)) from None


def warn(message):
    """A CheckWarning at the line that called the package."""
    package, frame, level = os.path.dirname(os.path.dirname(__file__)), sys._getframe(1), 2
    while frame is not None and frame.f_code.co_filename.startswith(package + os.sep):
        frame, level = frame.f_back, level + 1
    warnings.warn(in_arguments(message), CheckWarning, stacklevel=level)


def warn_of(checks):
    for check in checks:
        if check.verdict != "pass":
            word = "warns" if check.verdict == "warn" else "fails"
            warn(f"{check.name} {word}: {check.detail}. {check.advice}".rstrip())
