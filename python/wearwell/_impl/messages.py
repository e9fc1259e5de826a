"""What the library says of keys of a study file and of options of the command line, as arguments of a function."""

import re

_place = re.compile(r"\Astudy:\d+:\d+: ")
_excerpt = re.compile(r"\n    \[[^\]\n]*\]\n    \^\Z")  # the head of a table alone: it shows nothing
# A key of the study, which the caller did not write as such, and its value.
_line = re.compile(r"\n    [\w.\"'\[\]-]+ = ([^\n]*)\n +\^(?:\n    right: [^\n]*)?\Z")


def in_python(message, arguments=None, values=None):
    """``arguments``: of keys, the arguments that they came from, as {"data.columns.status": "event"}. ``values``: of arguments, what the
    caller wrote."""
    arguments = arguments or {}
    status = arguments.get("data.columns.status", "status")
    message = _excerpt.sub("", _place.sub("", message))
    message = re.sub(r"(?<=\d) 1 (?=must be )", " ", message)  # the unit of a plain number
    line = _line.search(message)
    message = message[:line.start()] if line else message
    message = re.sub(r'status = \{ column = ("[^"]*"), failure = (\d|"[^"]*") \}', rf'{status}={{"column": \1, "failure": \2}}', message)
    message = re.sub(r'status = ("[^"]*")', rf"{status}=\1", message)
    message = re.sub(r'mode = ("[^"]*") and \[failure_modes\] column = "mode" in a formula study', r"mode=\1 in wearwell.life", message)
    message = re.sub(r"unused = (\[[^\]]*\]) under \[data\]", r"unused=\1", message)
    message = re.sub(r'unused = (\[[^\]]*\])', r"unused=\1", message)
    message = re.sub(r'give the study a status column(, or write \[failure_modes\] runout = ("[^"]*"))?',
                     lambda m: f"name a column as {status}" + (f", or write mode={{'column': ..., 'runout': {m[2]}}}" if m[1] else ""), message)
    message = message.replace("must be a text in quotes", "must be a text")
    message = re.sub(r"\A(?:study: )?\d+ keys are missing; with values of yours: ", "these are missing, here with values of an example: ", message)
    message = re.sub(r'\bfamily "([\w-]+)"', r"family '\1'", message)
    message = re.sub(r'\bfamily = "([\w-]+)"', r"family='\1'", message)
    message = re.sub(r"\b(lives_of|units) = (\[[^\]]*\])", r'predict={"\1": \2}', message)
    message = re.sub(r"\A(\w+)(, column '[^']*' has no unit: name it '([^'\[\]]*) \[([^'\]]*)\]')\Z", lambda m: m[1] + m[2] + ", or write units=" + (
        f"{{'{m[3]}': '{m[4]}'}}" if m[1] == "data" else f"{{'{m[1]}': {{'{m[3]}': '{m[4]}'}}}}"), message)
    message = re.sub(r'needs a unit: \w+ = \{ column = "([^"]*)", unit = "([^"]*)" \}', r"needs a unit: units={'\1': '\2'}", message)
    message = re.sub(r"data\.missing_cycles = ", "missing_cycles=", message)
    for key, argument in sorted(arguments.items(), key=lambda each: -len(each[0])):
        message = re.sub(rf"(?<![\w.]){re.escape(key)}(?![\w])", argument, message)
    message = re.sub(r"\bneeds (predict\.)?given\.(\w+)",
                     lambda m: f"needs predict={{'given': {{'{m[2]}': ...}}}}" if m[1] else f"needs given={{'{m[2]}': ...}}", message)
    message = re.sub(r"\b(needs|and) predict\.(?!given\b)(\w+)", r"\1 predict={'\2': ...}", message)
    return _with_value(re.sub(r"(?<![\w.])prior\.(?=[A-Za-z])", "priors: ", message), values or {}, line[1] if line else "")


def _with_value(message, values, written):
    """The value behind the argument that a message begins with: "times: '5 kg': unit ...". ``written``: that of the study's key."""
    match = re.match(r"(predict\.\w+|\w+)(?:\.\w+)?: (?:entry (\d+): )?", message)
    value = values.get(match[1]) if match else None
    if match and value is None and re.fullmatch(r'"[^"]*"', written):
        value = written[1:-1]
    if value is None or isinstance(value, dict):
        return message
    if match[2] and isinstance(value, (list, tuple)):
        value = value[int(match[2]) - 1]
    rest = message[match.end():]
    return f"{match[1]}: {rest}" if f"'{value}" in rest or f'"{value}' in rest else f"{match[1]}: {value!r}: {rest}"


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
    message = re.sub(r"(?:(?<=[\s(])|\A)--b-lives(?![\w=-])", "b", message)  # whose argument is shorter
    return _option.sub(lambda m: m[1].replace("-", "_"), message)
