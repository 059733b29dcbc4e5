# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Comments and string literals of source files: what a reader or a user reads as prose."""
import os
import re

C_LIKE = re.compile(
    r'(?P<raw>R"\((?:.|\n)*?\)")|(?P<text>"(?:\\.|[^"\\\n])*")|(?P<line>//[^\n]*)|'
    r"(?P<block>/\*(?:.|\n)*?\*/)")
HASH_LIKE = re.compile(
    r'(?P<doc>"""(?:.|\n)*?""")|(?P<text>"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\')|'
    r"(?P<line>(?<!\S)#[^\n]*)")
SYNTAX = {".hpp": C_LIKE, ".cpp": C_LIKE, ".h": C_LIKE, ".in": HASH_LIKE, ".py": HASH_LIKE,
          ".sh": HASH_LIKE, ".cmake": HASH_LIKE, ".txt": HASH_LIKE, ".toml": HASH_LIKE}


def source_texts(path):
    """Yields (line number, line) of every line of a comment or literal; none for other files."""
    syntax = SYNTAX.get(os.path.splitext(path)[1])
    if syntax is None or not os.path.isfile(path):
        return
    with open(path, encoding="utf-8") as file:
        source = file.read()
    for match in syntax.finditer(source):
        first = source.count("\n", 0, match.start()) + 1
        for offset, line in enumerate(match.group(0).split("\n")):
            yield first + offset, line
