#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Checks the pages of the project: links, lines, sentences, words, named files and commands.

Usage: check_docs.py [ROOT]             the pages: README, CHANGELOG, CONTRIBUTING and docs/
       check_docs.py --sources [ROOT]   retired words in comments and texts of the sources
Prints a table of counts; on each fault one line FILE:LINE, and the exit status is 1.
"""
import glob
import json
import os
import re
import sys

from page import INLINE_CODE, Page, length
from retired_words import retired_words
from source_texts import source_texts

LINE_LIMIT = 100
SENTENCE_LIMIT, LONG_SHARE = 30, 0.03
SOURCE_FOLDERS = ["include", "src", "bench", "examples", "python", "cmake", "paper", "demo"]
NAMED_PATH = re.compile(r"(?:\.\./)*[\w.*+-]+(?:/[\w.*+-]+)+/?|[\w.-]+\.(?:md|cff|json)")
BOOTSTRAP = re.compile(r"bash cmake/bootstrap\.sh (\S+)(?:.*?--preset ([\w-]+))?")


def read(root, path):
    with open(os.path.join(root, path), encoding="utf-8") as file:
        return file.read()


def pages_of(root):
    paths = [name for name in ("README.md", "CHANGELOG.md", "CONTRIBUTING.md")
             if os.path.exists(os.path.join(root, name))]
    paths += sorted(os.path.relpath(path, root)
                    for path in glob.glob(os.path.join(root, "docs", "**", "*.md"), recursive=True))
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


def page_words(pages):
    for page in pages:
        for number, line in page.of_kind("prose", "table", "heading"):
            for word, instead in retired_words(INLINE_CODE.sub("", line)):
                yield page.path, number, f'"{word}": write "{instead}"'


def holds_anything(pattern):
    return any(os.path.isfile(path) or os.listdir(path) for path in glob.glob(pattern))


def missing_files(root, pages):
    folders = {name for name in os.listdir(root) if os.path.isdir(os.path.join(root, name))}
    folders |= {"include", "src", "tests", "docs", "paper"}
    for page in pages:
        for number, code in page.inline_code():
            if not NAMED_PATH.fullmatch(code):
                continue
            first = code.split("/")[0]
            if code.startswith("cayspin/"):
                code = "include/" + code
            elif "/" in code and (first not in folders or first in ("build", ".deps", "reproduction")):
                continue
            beside = os.path.join(root, os.path.dirname(page.path), code)
            if not holds_anything(os.path.join(root, code)) and not holds_anything(beside):
                yield page.path, number, f"`{code}` is not in the repository"


def wrong_commands(root, pages):
    usage = re.search(r"bootstrap\.sh ([\w-]+(?:\|[\w-]+)+)", read(root, "cmake/bootstrap.sh"))
    verbs = set(usage.group(1).split("|"))
    presets = {preset["name"]
               for preset in json.loads(read(root, "CMakePresets.json"))["configurePresets"]}
    for page in pages:
        for number, line in enumerate(page.lines, 1):
            for verb, preset in BOOTSTRAP.findall(line):
                verb = verb.strip("`,.;:)")
                if verb.lower() == verb and verb not in verbs:
                    yield page.path, number, f"bootstrap.sh has no verb {verb}"
                if preset.lower() == preset and preset and preset not in presets:
                    yield page.path, number, f"there is no preset {preset}"


def other_first_program(root, pages):
    """The README's first program is one that is compiled and runs."""
    example = "examples/01_switching_slab.cpp"
    if not os.path.exists(os.path.join(root, example)):
        return
    code = read(root, example)
    for page in pages:
        if page.path == "README.md":
            blocks = re.findall(r"^```cpp\n(.*?)^```$", "\n".join(page.lines), re.DOTALL | re.MULTILINE)
            if not blocks or blocks[0] != code[code.index("#include"):]:
                yield page.path, 1, f"the first program is not that of {example}"


def counts(page):
    sentences = page.sentences()
    every = page.words("prose", "heading", "table", "link definition")
    return [every, page.words("prose"), len(page.lines), len(sentences),
            sum(1 for _, sentence in sentences if length(sentence) > SENTENCE_LIMIT),
            sum(1 for _ in long_lines([page]))]


def check_pages(root, show=print):
    """All faults, as (file, line, sentence). Shows the table of counts."""
    pages = pages_of(root)
    rows = [(page.path, counts(page)) for page in pages]
    total = [sum(column) for column in zip(*(row for _, row in rows))]
    show(f"{'page':40} {'words':>7} {'prose':>7} {'lines':>7} {'sentences':>10} "
         f"{'over 30':>8} {'over 100':>9}")
    for path, row in rows + [("all", total)]:
        show(f"{path:40} {row[0]:7} {row[1]:7} {row[2]:7} {row[3]:10} {row[4]:8} {row[5]:9}")

    faults = [*wrong_links(root, pages), *long_lines(pages), *page_words(pages),
              *missing_files(root, pages), *wrong_commands(root, pages),
              *other_first_program(root, pages)]
    guide = [row for path, row in rows if path == "README.md" or path.startswith("docs" + os.sep)]
    words = sum(row[0] for row in guide)
    show(f"README and docs: {words} words; sentences over "
         f"{SENTENCE_LIMIT} words: {total[4] / max(total[3], 1):.1%} of at most {LONG_SHARE:.0%}")
    if total[4] > LONG_SHARE * total[3]:
        faults += long_sentences(pages)
    return faults


def check_sources(root):
    """Retired words in the sources' comments and texts, as (file, line, sentence)."""
    faults = []
    for folder in SOURCE_FOLDERS:
        for path in sorted(glob.glob(os.path.join(root, folder, "**", "*"), recursive=True)):
            for number, text in source_texts(path):
                faults += [(os.path.relpath(path, root), number, f'"{word}": write "{instead}"')
                           for word, instead in retired_words(text)]
    return faults


def main(arguments):
    sources = "--sources" in arguments
    rest = [argument for argument in arguments if argument != "--sources"]
    if len(rest) > 1 or any(argument.startswith("-") for argument in rest):
        print(__doc__, file=sys.stderr)
        return 2
    here = os.path.dirname(os.path.abspath(__file__))
    root = rest[0] if rest else os.path.join(here, "..", "..")
    faults = check_sources(root) if sources else check_pages(root)
    for path, number, sentence in faults:
        print(f"{path}:{number}: {sentence}")
    print(f"{len(faults)} faults" if faults else "no faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
