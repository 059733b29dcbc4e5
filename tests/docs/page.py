# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""A Markdown page taken apart: prose, tables, code, headings, links and sentences."""
import re

FENCE = re.compile(r"^\s*(```+|~~~+)\s*(\w*)")
LINK_DEFINITION = re.compile(r"^\s*\[[^\]]+\]:\s")
LIST_ITEM = re.compile(r"^\s*(?:[-*+]|\d+\.)\s+")
INLINE_CODE = re.compile(r"``.+?``|`[^`]+`")
LINK = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^()\s]+(?:\([^()]*\))?)[^()]*\)")
SENTENCE_END = re.compile(r"(?<=[.!?])[\"')\]*]*\s+(?=[\"'(\[*`|A-Z0-9])")
NO_SENTENCE_END = re.compile(r"\b(?:e\.g|i\.e|cf|Sec|Fig|Eq|vs|al)\.\s")


class Page:
    """The lines of a page by kind: prose, table, code, heading, link definition or blank. Lines
    count from 1."""

    def __init__(self, path, text):
        self.path = path
        self.lines = text.split("\n")
        self.kinds = []
        self._classify()

    def _classify(self):
        fence = None
        for line in self.lines:
            mark = FENCE.match(line)
            if fence is None and mark:
                fence, kind = mark.group(1), "code"
            elif fence is not None:
                kind = "code"
                if mark and mark.group(1).startswith(fence) and not mark.group(2):
                    fence = None
            elif not line.strip():
                kind = "blank"
            elif line.lstrip().startswith("|"):
                kind = "table"
            elif line.startswith("#"):
                kind = "heading"
            elif line.startswith("    ") and self.kinds and self.kinds[-1] in ("blank", "code"):
                kind = "code"
            elif LINK_DEFINITION.match(line):
                kind = "link definition"
            else:
                kind = "prose"
            self.kinds.append(kind)

    def of_kind(self, *kinds):
        """Returns (number, line) of each line of these kinds."""
        return [(number, line)
                for number, (line, kind) in enumerate(zip(self.lines, self.kinds), 1)
                if kind in kinds]

    def links(self):
        """Returns (line number, whether it is an image, target) of every link outside of code."""
        found = []
        for number, line in self.of_kind("prose", "table", "heading"):
            line = INLINE_CODE.sub("code", line)
            for match in LINK.finditer(line):
                for inner in LINK.finditer(match.group(2)):
                    found.append((number, inner.group(1) == "!", inner.group(3)))
                found.append((number, match.group(1) == "!", match.group(3)))
        return found

    def inline_code(self):
        """Returns (line number, text) of every piece of code in prose and tables."""
        return [(number, match.group(0).strip("`"))
                for number, line in self.of_kind("prose", "table")
                for match in INLINE_CODE.finditer(line)]

    def anchors(self):
        """Returns the anchors that GitHub gives to the headings."""
        seen, anchors = {}, set()
        for _, line in self.of_kind("heading"):
            text = INLINE_CODE.sub(lambda code: code.group(0).strip("`"), line.lstrip("#").strip())
            text = LINK.sub(lambda link: link.group(2), text).lower()
            slug = re.sub(r"[^\w\- ]", "", text).replace(" ", "-")
            count = seen.get(slug, 0)
            seen[slug] = count + 1
            anchors.add(slug if count == 0 else f"{slug}-{count}")
        return anchors

    def sentences(self):
        """Returns (line number of the paragraph, sentence) for each sentence of prose. A piece of
        code counts as one word, a link as its text, and an image as nothing."""
        blocks, previous = [], "blank"
        for number, (line, kind) in enumerate(zip(self.lines, self.kinds), 1):
            if kind == "prose":
                if previous != "prose" or LIST_ITEM.match(line):
                    blocks.append((number, []))
                blocks[-1][1].append(LIST_ITEM.sub("", line).strip())
            previous = kind
        found = []
        for number, lines in blocks:
            text = INLINE_CODE.sub("Code", " ".join(lines))
            text = LINK.sub(lambda link: "" if link.group(1) else link.group(2), text)
            text = NO_SENTENCE_END.sub(lambda end: end.group(0).replace(". ", " "), text)
            found += [(number, sentence) for sentence in SENTENCE_END.split(text)
                      if re.search(r"\w", sentence)]
        return found


def length(sentence):
    """Returns the number of words of a sentence that contain a letter or a digit."""
    return sum(1 for word in sentence.split() if re.search(r"\w", word))
