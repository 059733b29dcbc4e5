# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# Sphinx reads a copy of this file and of the pages, which build_site.py makes.
import html
import textwrap

from docutils import nodes

project = "cayspin"
author = "the authors of cayspin"
extensions = ["myst_parser"]
language = "en"
smartquotes = False  # m' is a derivative
root_doc = "index"
myst_heading_anchors = 4  # the anchors that GitHub gives to headings
highlight_language = "none"
suppress_warnings = ["misc.highlighting_failure"]  # excerpts contain `...`

html_theme = "furo"
html_title = "cayspin"
html_theme_options = {"light_css_variables": {"color-brand-primary": "#1b5fa7",
                                              "color-brand-content": "#1b5fa7"}}
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_extra_path = ["../doxygen"]  # api/, by Doxygen
html_use_index = False
html_copy_source = False
html_show_sphinx = False
html_show_copyright = False


def describe(app, pagename, templatename, context, doctree):
    """Adds a description for search engines: the title of a page and the start of its text."""
    text = "Search the documentation of cayspin"
    if doctree:
        prose = (node.astext() for node in doctree.findall(nodes.paragraph)
                 if isinstance(node.parent, nodes.section) and not node.next_node(nodes.image))
        text = f"{app.env.titles[pagename].astext()}: {next(prose, 'of the source of cayspin')}"
    text = html.escape(textwrap.shorten(text, 160, placeholder=" ..."))
    context["metatags"] = context.get("metatags", "") + (
        f'<meta name="description" content="{text}" />')


def setup(app):
    app.connect("html-page-context", describe)
