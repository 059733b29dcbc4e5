#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Checks the links, named files, commands and line lengths of the pages.

Usage: check_docs.py [ROOT]              the pages: README and others beside it, .github/ and docs/
       check_docs.py --sources [ROOT]    files and commands in comments and texts of the sources, and
                                         in the workflows and forms of .github/
       check_docs.py --sentences [ROOT]  lists the long sentences of the pages, which are not faults
Prints a line FILE:LINE: SENTENCE for each fault; the exit status is then 1.
"""
import glob
import json
import os
import re
import sys

from page import Page, length
from source_texts import source_texts

LINE_LIMIT, SENTENCE_LIMIT = 100, 25
SOURCE_FOLDERS = ["include", "src", "bench", "examples", "python", "cmake", "paper", "demo", "scenes"]
WRITTEN_BY_RUNS = ("build", ".deps", "reproduction")
NAMED_PATH = re.compile(r"(?:\.\./)*[\w.*+-]+(?:/[\w.*+-]+)+/?|[\w.-]+\.(?:md|cff|json)")
PATH_IN_TEXT = re.compile(r"(?<![\w./$}{-])\w+(?:/[\w.-]*\w)+(?![\w{*])")
BOOTSTRAP = re.compile(r"bash cmake/bootstrap\.sh (\w[\w-]*)(?:.*?--preset ([\w-]+))?")


def read(root, path):
    with open(os.path.join(root, path), encoding="utf-8") as file:
        return file.read()


def pages_of(root):
    patterns = ("*.md", ".github/**/*.md", "docs/**/*.md")
    paths = [os.path.relpath(path, root) for pattern in patterns
             for path in sorted(glob.glob(os.path.join(root, pattern), recursive=True))]
    return [Page(path, read(root, path)) for path in paths]


def wrong_links(root, pages):
    anchors = {page.path: page.anchors() for page in pages}
    for page in pages:
        for number, is_image, target in page.links():
            if re.match(r"[a-z]+:", target):
                continue
            name, _, anchor = target.partition("#")
            path = page.path
            if name:
                path = os.path.normpath(os.path.join(os.path.dirname(page.path), name))
            if not os.path.exists(os.path.join(root, path)):
                yield page.path, number, f"{'image' if is_image else 'link'} to {target}: not there"
            elif anchor and anchor not in anchors.get(path, ()):
                yield page.path, number, f"link to {target}: {path} has no such heading"


def long_lines(pages):
    for page in pages:
        for number, line in page.of_kind("prose", "heading"):
            rest = re.sub(r"\]\([^)]*\)|https?://\S+", "", line)
            if len(line) > LINE_LIMIT and not (line.startswith("![") or len(rest) <= LINE_LIMIT / 2):
                yield page.path, number, f"line of {len(line)} columns; at most {LINE_LIMIT}"


def long_sentences(pages):
    for page in pages:
        for number, sentence in page.sentences():
            if length(sentence) > SENTENCE_LIMIT:
                yield page.path, number, (f"sentence of {length(sentence)} words: "
                                          f"{' '.join(sentence.split()[:8])} ...")


def holds_anything(pattern):
    return any(os.path.isfile(path) or os.listdir(path) for path in glob.glob(pattern))


def folders_of(root):
    return {name for name in os.listdir(root) if os.path.isdir(os.path.join(root, name))}


def missing_files(root, pages):
    folders = folders_of(root)
    for page in pages:
        for number, code in page.inline_code():
            if not NAMED_PATH.fullmatch(code):
                continue
            first = code.split("/")[0]
            if code.startswith("cayspin/"):
                code = "include/" + code
            elif "/" in code and (first not in folders or first in WRITTEN_BY_RUNS):
                continue
            beside = os.path.join(root, os.path.dirname(page.path), code)
            if not holds_anything(os.path.join(root, code)) and not holds_anything(beside):
                yield page.path, number, f"`{code}` is not in the repository"


def missing_files_of_sources(root, sources):
    folders = folders_of(root) - {*WRITTEN_BY_RUNS}
    for path, number, line in sources:
        for name in PATH_IN_TEXT.findall(line):
            if name.split("/")[0] in folders and not os.path.exists(os.path.join(root, name)):
                yield path, number, f"{name} is not in the repository"


def wrong_commands(root, lines):
    """Yields the faults of commands in `lines`, each of which is (file, line number, line)."""
    usage = re.search(r"bootstrap\.sh ([\w-]+(?:\|[\w-]+)+)", read(root, "cmake/bootstrap.sh"))
    verbs = set(usage.group(1).split("|"))
    presets = {preset["name"]
               for preset in json.loads(read(root, "CMakePresets.json"))["configurePresets"]}
    for path, number, line in lines:
        for verb, preset in BOOTSTRAP.findall(line):
            if verb.lower() == verb and verb not in verbs:
                yield path, number, f"bootstrap.sh has no verb {verb}"
            if preset.lower() == preset and preset and preset not in presets:
                yield path, number, f"there is no preset {preset}"


def other_first_program(root, pages):
    """Yields a fault if the README's first program is not that of an example, which is tested."""
    example = "examples/01_switching_slab.cpp"
    if not os.path.exists(os.path.join(root, example)):
        return
    code = read(root, example)
    for page in pages:
        if page.path == "README.md":
            blocks = re.findall(r"^```cpp\n(.*?)^```$", "\n".join(page.lines), re.DOTALL | re.MULTILINE)
            if not blocks or blocks[0] != code[code.index("#include"):]:
                yield page.path, 1, f"the first program is not that of {example}"


def check_pages(root):
    """Returns all faults of the pages, as (file, line, sentence)."""
    pages = pages_of(root)
    lines = [(page.path, number, line)
             for page in pages for number, line in enumerate(page.lines, 1)]
    return [*wrong_links(root, pages), *long_lines(pages), *missing_files(root, pages),
            *wrong_commands(root, lines), *other_first_program(root, pages)]


def check_sources(root):
    """Returns all faults of the sources' comments and texts, as (file, line, sentence)."""
    paths = [path for folder in SOURCE_FOLDERS
             for path in sorted(glob.glob(os.path.join(root, folder, "**", "*"), recursive=True))]
    lines = [(os.path.relpath(path, root), number, line)
             for path in paths for number, line in source_texts(path)]
    lines += [(os.path.relpath(path, root), number, line)
              for path in sorted(glob.glob(os.path.join(root, ".github/**/*.yml"), recursive=True))
              for number, line in enumerate(read(root, path).split("\n"), 1)]
    return [*missing_files_of_sources(root, lines), *wrong_commands(root, lines)]


def main(arguments):
    options = [argument for argument in arguments if argument.startswith("-")]
    rest = [argument for argument in arguments if argument not in options]
    if len(rest) > 1 or len(options) > 1 or {*options} - {"--sources", "--sentences"}:
        print(__doc__, file=sys.stderr)
        return 2
    here = os.path.dirname(os.path.abspath(__file__))
    root = rest[0] if rest else os.path.join(here, "..", "..")
    if "--sentences" in options:
        found, name = list(long_sentences(pages_of(root))), "long sentences"
    else:
        found, name = check_sources(root) if options else check_pages(root), "faults"
    for path, number, sentence in found:
        print(f"{path}:{number}: {sentence}")
    print(f"{len(found) or 'no'} {name}")
    return 1 if found and name == "faults" else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
