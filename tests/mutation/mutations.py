# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Small textual changes of C++ sources as clang-format writes them."""
import dataclasses
import re

SWAPS = [
    ("arithmetic", {"+": "-", "-": "+", "*": "/", "/": "*"}),
    ("comparison", {"<": "<=", "<=": "<", ">": ">=", ">=": ">", "==": "!=", "!=": "=="}),
    ("logic", {"&&": "||", "||": "&&"}),
    ("assignment", {"+=": "-=", "-=": "+=", "*=": "/=", "/=": "*="}),
]
WORDS = {"true": "false", "false": "true", "std::min": "std::max", "std::max": "std::min"}
NUMBER = re.compile(r"(?<![\w.'\"\[])(\d+(?:\.\d*)?(?:e[+-]?\d+)?)(?![\w.'\"])")
STATEMENT = re.compile(r"^\s+(?!return|using|friend|static|const|auto|throw|break|template|else)"
                       r"(?:[\w.>\[\]:()-]+(?:\(.*\))?|[\w.>\[\]()-]+ [-+*/]?= .*);\s*$")
ARGUMENTS = re.compile(r"(?<=\()(\w[\w.:]*(?:\(\))?), (\w[\w.:]*(?:\(\))?)(?=[,)])")
NOT_CODE = re.compile(r"^\s*(//|#|template <|using |namespace |friend |static_assert|typename )")


@dataclasses.dataclass(frozen=True)
class Mutation:
    kind: str
    line: int  # counted from 1
    begin: int  # column
    before: str
    after: str
    text: str  # of the line

    def applied(self, source):
        lines = source.split("\n")
        line = lines[self.line - 1]
        end = self.begin + len(self.before)
        assert line[self.begin:end] == self.before
        lines[self.line - 1] = line[:self.begin] + self.after + line[end:]
        return "\n".join(lines)

    def __str__(self):
        if self.kind == "statement":
            return f"statement dropped: {self.text}"
        return f"{self.kind}: `{self.before}` -> `{self.after}`: {self.text}"


def code_of(line):
    """The line with its comment and the contents of its texts blanked."""
    blanked = re.sub(r'"(?:\\.|[^"\\])*"', lambda m: '"' + " " * (len(m.group()) - 2) + '"', line)
    return re.sub(r"//.*", lambda m: " " * len(m.group()), blanked)


def other_number(text):
    if "." not in text and "e" not in text:
        return str(int(text) + 1)
    return repr(1.25 * float(text)) if float(text) != 0 else "1.0"


def mutations_of_line(line):
    code = code_of(line)
    for kind, swaps in SWAPS:
        for operator in re.finditer(r"(?<= )[-+*/<>=!&|]+(?= )", code):
            if operator.group() in swaps:
                yield kind, operator.start(), operator.group(), swaps[operator.group()]
    for word, other in WORDS.items():
        for found in re.finditer(rf"\b{word}\b", code):
            yield "word", found.start(), word, other
    for found in re.finditer(r"(?<=\()!(?=[\w(])|(?<=[&|] )!(?=[\w(])", code):
        yield "negation", found.start(), "!", ""
    for found in NUMBER.finditer(code):
        yield "constant", found.start(), found.group(), other_number(found.group())
    for found in ARGUMENTS.finditer(code):
        if found.group(1) != found.group(2):
            yield "arguments", found.start(), found.group(), f"{found.group(2)}, {found.group(1)}"
    if STATEMENT.match(code):
        begin = len(line) - len(line.lstrip())
        statement = line[begin:].rstrip()
        yield "statement", begin, statement, ";"


def mutations_of(text):
    found = []
    for number, line in enumerate(text.split("\n"), 1):
        if NOT_CODE.match(line):
            continue
        for kind, begin, before, after in mutations_of_line(line):
            shown = re.sub(r"\s*//.*", "", line).strip()
            found.append(Mutation(kind, number, begin, before, after, shown))
    return found
