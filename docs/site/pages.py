# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Writes the sources of the site: the pages, with links that lead within the site and a tree of
pages, and a listing of each file or folder of the repository that a page links to."""

import os
import pathlib
import re
import shutil

TREE = {
    "Tutorials": ["docs/guide/tutorial_film", "docs/guide/tutorial_skyrmions",
                  "docs/guide/tutorial_spin_waves", "docs/guide/tutorial_lifetime",
                  "docs/guide/tutorial_switches", "docs/guide/tutorial_kokkos"],
    "Guide": ["docs/README", "docs/guide/installing", "docs/guide/first_run",
              "docs/guide/first_program", "docs/gallery", "docs/guide/theory",
              "docs/guide/what_a_scene_can_hold", "docs/guide/choosing_a_method",
              "docs/guide/equilibria", "docs/guide/normal_modes", "docs/guide/spectra",
              "docs/guide/paths", "docs/guide/python",
              "docs/guide/units", "docs/guide/coming_from", "docs/guide/own_field_term",
              "docs/guide/own_generator", "docs/guide/own_views", "docs/guide/many_ranks",
              "docs/guide/linking", "docs/guide/troubleshooting"],
    "Reference": ["docs/reference/scene", "docs/reference/command_line",
                  "docs/reference/file_format", "docs/reference/python_api",
                  "docs/reference/conventions", "docs/reference/field_terms",
                  "docs/reference/methods", "docs/reference/classes", "docs/reference/gpu",
                  "docs/reference/glossary"],
    "Reports": ["docs/reports/validation", "docs/reports/standard_problems",
                "docs/reports/extremes", "docs/reports/paper", "docs/reports/reliability",
                "docs/reports/other_programs", "docs/reports/performance", "docs/reports/trade",
                "docs/reports/long_runs", "docs/reports/appendix", "docs/reports/extremes_tables"],
    "Project": ["ROADMAP", "CHANGELOG", "CONTRIBUTING", "docs/architecture", "RELEASING",
                "CODE_OF_CONDUCT", "SECURITY"],
}
LANGUAGES = {".cpp": "cpp", ".hpp": "cpp", ".h": "c", ".c": "c", ".f90": "fortran", ".py": "python",
             ".toml": "toml", ".yaml": "yaml", ".cff": "yaml", ".cmake": "cmake", ".txt": "none",
             ".sh": "sh"}
TARGET = re.compile(r"\]\(([^()\s]+)\)")
API = "\n<p><a href=\"../../api/index.html\">Every class and function</a></p>\n"


def toctrees():
    return "".join(f"\n```{{toctree}}\n:caption: {caption}\n:hidden:\n\n" + "\n".join(names)
                   + "\n```\n" for caption, names in TREE.items())


class Writer:
    def __init__(self, root, folder):
        self.root, self.folder = root, folder
        self.listed = set()

    def write(self, path, text):
        target = self.folder / path
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(text, encoding="utf-8")

    def page(self, path):
        text = (self.root / path).read_text(encoding="utf-8")
        lines, in_code = [], False
        for line in text.split("\n"):
            in_code ^= line.lstrip().startswith("```")
            lines.append(line if in_code else TARGET.sub(
                lambda link: f"]({self.target(path, link.group(1))})", line))
        text = "\n".join(lines)
        if path.name == "classes.md":
            text += API
        if path == pathlib.Path("README.md"):
            path, text = pathlib.Path("index.md"), text + toctrees()
        self.write(path, text)

    def target(self, page, link):
        """Returns the path or address to which a link of a page leads in the site. If the link is
        to a listing or an image, creates that file."""
        name, mark, anchor = link.partition("#")
        path = pathlib.Path(os.path.normpath(page.parent / name))
        if not name or ":" in name:
            return link
        if path == pathlib.Path("README.md"):
            path = pathlib.Path("index.md")
        elif (self.root / path).is_dir() or path.suffix in LANGUAGES:
            path = self.listing(path)
        elif path.suffix != ".md":
            (self.folder / path).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(self.root / path, self.folder / path)
        return os.path.relpath(path, page.parent) + mark + anchor

    def listing(self, path):
        """Writes a page with the text of a file, or with links to the files of a folder, and
        returns its path."""
        page = path / "index.md" if (self.root / path).is_dir() else path.with_name(path.name + ".md")
        if path in self.listed:
            return page
        self.listed.add(path)
        text = f"# {path}\n\n"
        if (self.root / path).is_dir():
            names = sorted(entry.name for entry in (self.root / path).iterdir()
                           if entry.suffix in {*LANGUAGES, ".ipynb"})
            text += "".join(f"- [{name}]({self.target(page, name)})\n" for name in names)
        else:
            code = (self.root / path).read_text(encoding="utf-8")
            text += f"``````{LANGUAGES[path.suffix]}\n{code}\n``````\n"
        self.write(page, f"---\norphan: true\n---\n\n{text}")
        return page


def write_pages(root, folder):
    writer = Writer(root, folder)
    shutil.copytree(root / "docs/images", folder / "docs/images")
    for name in ["README", *(name for names in TREE.values() for name in names)]:
        writer.page(pathlib.Path(name + ".md"))
