"""What the library says of keys of a study file and of options of the command line, as arguments of a function."""

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


_option = re.compile(r"(?:(?<=[\s(])|\A)--([a-z][a-z-]*[a-z])(?![\w=-])")  # a quoted one is the user's text
_words = re.compile(r"( ?)(?<![\w-])--(method|repeated)(\s+)(exact|nuts|metropolis|once|another)(?![\w-])")  # options whose values are few
_functions = re.compile(r"`?\bwearwell (plan (?:next|size|inspect|demonstrate|accelerate)|decide|update)\b`?(?! -)")


def in_arguments(message):
    """A message, a check's advice or a report in text, with arguments and functions in place of options and commands."""
    if not re.search(r"--|-o |wearwell ", message):
        return message
    message = message.replace("fitted with --no-report", "fitted with report=False")
    message = re.sub(r"-o writes all to tables/([\w-]+)\.csv", r'tables["\1"] has all', message)
    message = re.sub(r"with --rows here,\s+or in", "in", message)
    message = re.sub(r"\bwearwell update \S+ TESTS -o NEW", "wearwell.update(fit, tests)", message)
    message = message.replace("wearwell decide --inspect-after", "wearwell.decide(inspect_after=...)")
    if "for the command line" not in message:
        message = _functions.sub(lambda m: "wearwell." + m[1].replace(" ", "."), message)
    # The blank of a wrapped line is kept: the line breaks there.
    message = _words.sub(lambda m: (m[1] if m[3] == " " else m[3]) + f'{m[2]}="{m[4]}"', message)
    return _option.sub(lambda m: m[1].replace("-", "_"), message)
