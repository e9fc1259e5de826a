"""```{cpp-header} bayes/log_density.h``` puts what a header declares there: its classes, enumerations, functions and constants, in
the order of the header, as Doxygen read them. A header that is not in Doxygen's XML, or declares nothing, is an error.
"""

import os
import xml.etree.ElementTree as xml
from functools import lru_cache
from pathlib import Path

from docutils import nodes
from docutils.statemachine import StringList
from sphinx.util.docutils import SphinxDirective

_of_kind = {"enum": "doxygenenum", "typedef": "doxygentypedef", "variable": "doxygenvariable", "define": "doxygendefine"}


@lru_cache
def _declared(folder):
    """By header: (line, directive, argument, options), in order."""
    result = {}

    def add(location, directive, argument, options=()):
        file = location.get("declfile") or location.get("file")
        line = int(location.get("declline") or location.get("line"))
        result.setdefault(file.removeprefix("src/"), set()).add((line, directive, argument, tuple(options)))

    index = xml.parse(folder / "index.xml").getroot()
    for compound in index.findall("compound"):
        kind, name = compound.get("kind"), compound.findtext("name")
        if kind not in ("class", "struct", "namespace"):
            continue
        root = xml.parse(folder / (compound.get("refid") + ".xml")).getroot().find("compounddef")
        if kind != "namespace":
            outer = name.rpartition("::")[0].rpartition("::")[2]
            if not outer[:1].isupper() and root.get("prot") == "public":
                add(root.find("location"), "doxygen" + kind, name, [":members:"])
            continue
        for member in root.iter("memberdef"):
            full = f"{name}::{member.findtext('name')}"
            kind = member.get("kind")
            if kind == "function":
                types = ", ".join("".join(p.find("type").itertext()) for p in member.findall("param"))
                add(member.find("location"), "doxygenfunction", f"{full}({types})")
            elif kind in _of_kind:
                add(member.find("location"), _of_kind[kind], full)
    return {file: sorted(all) for file, all in result.items()}


class CppHeader(SphinxDirective):
    required_arguments = 1

    def run(self):
        header = "wearwell/" + self.arguments[0]
        folder = Path(self.config.breathe_projects[self.config.breathe_default_project])
        declared = _declared(folder).get(header)
        if not declared:
            raise self.error(f"{header} is not in {folder}, or declares nothing")
        lines = []
        for _, directive, argument, options in declared:
            lines += [f"```{{{directive}}} {argument}", *options, "```", ""]
        node = nodes.container()
        self.state.nested_parse(StringList(lines, header), self.content_offset, node)
        include = nodes.literal_block("", f'#include "{header}"', language="none")
        return [include, *node.children]


def setup(app):
    app.add_directive("cpp-header", CppHeader)
    return {"parallel_read_safe": True}
