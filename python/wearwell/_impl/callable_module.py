"""Modules that can be called: ``wearwell.bearing(...)`` fits a table, ``wearwell.bearing.rate(...)`` computes one bearing."""

import sys
import types


def make_callable(name, function):
    """The module of this name does what ``function`` does when it is called."""

    class CallableModule(types.ModuleType):
        __call__ = staticmethod(function)
        __signature__ = None  # of the module: inspect shows that of __call__

    del CallableModule.__signature__
    sys.modules[name].__class__ = CallableModule
