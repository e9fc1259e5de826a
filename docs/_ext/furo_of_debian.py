"""Debian's furo lacks two things: its style sheet imports normalize.css from the root of the server, and the rules for readers whose
system is dark were lost when it was compiled. Both are put right in the copy of the style sheet that belongs to the site.
"""

import re
from pathlib import Path

normalize = Path("/usr/share/javascript/normalize.css/normalize.css")
imported = "@import url(/javascript/normalize.css/normalize.css);"


def _complete(app, error):
    sheet = Path(app.outdir) / "_static" / "styles" / "furo.css"
    if error or not sheet.is_file():
        return
    text = sheet.read_text()
    if imported in text:
        text = text.replace(imported, normalize.read_text() if normalize.is_file() else "body { margin: 0; }")
    dark = re.search(r'@media not print \{\n(  body\[data-theme="dark"\].*?\} )\}', text, re.S)
    if dark and "prefers-color-scheme" not in text:
        text += "\n@media screen and (prefers-color-scheme: dark) {\n" + dark[1].replace('"dark"', '"auto"') + "}\n"
    sheet.write_text(text)


def setup(app):
    app.connect("build-finished", _complete)
    return {"parallel_read_safe": True}
