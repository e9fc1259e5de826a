"""Every public function, class, method and property of the package, with its docstring."""

import functools
import inspect
import types

import wearwell


def _members(name, cls):
    for each in inspect.classify_class_attrs(cls):
        member = each.object.__func__ if isinstance(each.object, (classmethod, staticmethod)) else each.object
        own = each.defining_class.__module__.split(".")[0] == "wearwell"
        if own and not each.name.startswith("_") and isinstance(member, (types.FunctionType, property, functools.cached_property)):
            yield f"{name}.{each.name}", member


def _of_module(prefix, module, names):
    for name in names:
        each = getattr(module, name)
        if isinstance(each, types.ModuleType):
            own = [n for n, value in vars(each).items() if not n.startswith("_") and getattr(value, "__module__", "") == each.__name__]
            if callable(each):  # wearwell.bearing(...)
                yield prefix + name, each.__call__
            yield from _of_module(f"{name}.", each, own)
        else:
            yield prefix + name, each
        if isinstance(each, type):
            yield from _members(prefix + name, each)


def public_names():
    """By name: the object."""
    return dict(_of_module("", wearwell, wearwell.__all__))


def docstrings():
    """By name, modules included: the docstring without its indentation."""
    objects = {"wearwell": wearwell, "module bearing": wearwell.bearing, "module clutch": wearwell.clutch, "plan": wearwell.plan, **public_names()}
    return {name: inspect.cleandoc(each.__doc__ or "") for name, each in objects.items()}


def sections(docstring):
    """By title: the lines below a title that is underlined, in the form of numpydoc."""
    lines = docstring.split("\n")
    found, title = {}, ""
    for i, line in enumerate(lines):
        if i + 1 < len(lines) and line and lines[i + 1] == "-" * len(line):
            title = line
            found[title] = []
        elif title:
            found[title].append(line)
    return {title: below[1:] for title, below in found.items()}
