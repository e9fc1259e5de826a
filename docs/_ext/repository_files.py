"""Links of a page to files of the repository that are not pages (`../../examples/clutch/truth.toml`): the file is copied beside the
page, as a download. A folder cannot be downloaded: its link becomes its name. A file that is missing is a warning, and so an error.
"""

from pathlib import Path

from docutils import nodes
from sphinx import addnodes
from sphinx.transforms import SphinxTransform
from sphinx.util import logging

log = logging.getLogger(__name__)


class RepositoryFiles(SphinxTransform):
    default_priority = 5

    def apply(self):
        page = Path(self.document["source"])
        for ref in list(self.document.findall(addnodes.pending_xref)):
            target = ref.get("reftarget", "")
            if ref.get("reftype") != "myst" or not target or target.startswith("#"):
                continue
            path = (page.parent / target.partition("#")[0]).resolve()
            if path.suffix == ".md" and path.is_relative_to(self.env.srcdir):
                continue
            if path.is_file():
                name = str(path)
                link = addnodes.download_reference("", "", *ref.children, refdomain="", reftarget="/" + _relative(path, self.env.srcdir),
                                                   refdoc=self.env.docname, refwarn=True, refexplicit=True)
                link.source, link.line = ref.source, ref.line
                ref.replace_self(link)
            elif path.is_dir():
                ref.replace_self(nodes.inline("", "", *ref.children))


def _relative(path, folder):
    import os

    return os.path.relpath(path, folder)


def setup(app):
    app.add_transform(RepositoryFiles)
    return {"parallel_read_safe": True}
