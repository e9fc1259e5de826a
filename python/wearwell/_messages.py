"""What the library says of keys of a study file, as arguments of a function."""

import re

_place = re.compile(r"\Astudy:\d+:\d+: ")
_excerpt = re.compile(r"\n    \[[^\]\n]*\]\n    \^\Z")  # the head of a table alone: it shows nothing


def in_python(message, arguments=None):
    """``arguments``: of keys, the arguments that they came from, as {"data.columns.status": "event"}."""
    arguments = arguments or {}
    status = arguments.get("data.columns.status", "status")
    message = _excerpt.sub("", _place.sub("", message))
    message = re.sub(r'status = \{ column = ("[^"]*"), failure = (\d|"[^"]*") \}', rf'{status}={{"column": \1, "failure": \2}}', message)
    message = re.sub(r'status = ("[^"]*")', rf"{status}=\1", message)
    message = re.sub(r'mode = ("[^"]*") and \[failure_modes\] column = "mode" in a formula study', r"mode=\1 in wearwell.life", message)
    message = re.sub(r"unused = (\[[^\]]*\]) under \[data\]", r"unused=\1", message)
    message = re.sub(r'unused = (\[[^\]]*\])', r"unused=\1", message)
    message = re.sub(r'give the study a status column(, or write \[failure_modes\] runout = ("[^"]*"))?',
                     lambda m: f"name a column as {status}" + (f", or write mode={{'column': ..., 'runout': {m[2]}}}" if m[1] else ""), message)
    for key, argument in sorted(arguments.items(), key=lambda each: -len(each[0])):
        message = re.sub(rf"(?<![\w.]){re.escape(key)}(?![\w])", argument, message)
    return re.sub(r"(?<![\w.])prior\.(?=[A-Za-z])", "priors: ", message)
