#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Builds the documentation as a site: FOLDER/site/index.html, with Doxygen's pages in site/api.

Needs Doxygen, Sphinx, myst-parser, and the theme furo (requirements.txt), which may be in
.deps/site. Warnings are errors.
"""

import argparse
import os
import pathlib
import shutil
import subprocess
import sys

from pages import write_pages

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]


def run_doxygen(program, folder):
    settings = (ROOT / "docs/Doxyfile").read_text(encoding="utf-8")
    settings += f"\nOUTPUT_DIRECTORY = {folder}\nHTML_OUTPUT = api\n"
    subprocess.run([program, "-"], input=settings, cwd=ROOT, text=True, check=True)


def run_sphinx(source, site):
    paths = filter(None, [str(ROOT / ".deps/site"), os.environ.get("PYTHONPATH")])
    subprocess.run([sys.executable, "-m", "sphinx", "-W", "--keep-going", "-q", "-b", "html",
                    "-d", site.parent / "doctrees", source, site], check=True,
                   env=os.environ | {"PYTHONPATH": os.pathsep.join(paths)})


def build(folder, doxygen):
    for name in ("source", "doxygen", "doctrees", "site"):
        shutil.rmtree(folder / name, ignore_errors=True)
        (folder / name).mkdir(parents=True)
    run_doxygen(doxygen, folder / "doxygen")
    source = folder / "source"
    write_pages(ROOT, source)
    shutil.copy(HERE / "conf.py", source)
    (source / "_static").mkdir()
    shutil.copy(HERE / "site.css", source / "_static")
    run_sphinx(source, folder / "site")
    return folder / "site"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", nargs="?", type=pathlib.Path, default=ROOT / "build/docs")
    parser.add_argument("--doxygen", default="doxygen", help="the program (default: doxygen)")
    arguments = parser.parse_args()
    try:
        print(build(arguments.folder.resolve(), arguments.doxygen) / "index.html")
    except (OSError, subprocess.CalledProcessError) as error:
        sys.exit(f"the site is not complete: {error}")


if __name__ == "__main__":
    main()
