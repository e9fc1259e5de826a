"""```{r-help} ww_fit``` puts R's help page r/man/ww_fit.Rd there, as R itself renders it."""

import re
import subprocess
from pathlib import Path

from docutils import nodes
from sphinx.errors import ExtensionError
from sphinx.util.docutils import SphinxDirective

man = Path(__file__).resolve().parents[2] / "r" / "man"


def _link(match):
    """A help page of ours is a heading of this page; those of other packages are not here."""
    name, text = match[1], match[2]
    return f'<a href="#{name.replace("_", "-")}">{text}</a>' if (man / (name + ".Rd")).is_file() else text


class RHelp(SphinxDirective):
    required_arguments = 1

    def run(self):
        page = man / (self.arguments[0] + ".Rd")
        self.env.note_dependency(str(page))
        if not page.is_file():
            raise self.error(f"{page}: no such help page")
        code = f"tools::Rd2HTML({str(page)!r}, outputEncoding = 'UTF-8')"
        try:
            text = subprocess.run(["Rscript", "--vanilla", "-e", code], capture_output=True, text=True, check=True).stdout
        except (OSError, subprocess.CalledProcessError) as error:
            raise ExtensionError(f"Rscript cannot render {page}: {error}") from error
        # Headings of R's own page lie below the heading of ours; links between help pages go to places on this page.
        text = re.search(r"</h2>(.*?)(?:<hr />|</body>)", text, re.S)[1].rstrip().removesuffix("</div>")
        text = re.sub(r"<(/?)h3[^>]*>", r"<\1h4>", text)
        text = re.sub(r"<a href=\"[^\"]*?([\w.-]+)\.html\"[^>]*>(.*?)</a>", _link, text, flags=re.S)
        return [nodes.raw("", text, format="html")]


def setup(app):
    app.add_directive("r-help", RHelp)
    return {"parallel_read_safe": True}
