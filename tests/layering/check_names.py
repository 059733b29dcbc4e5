# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Checks that files which are compiled as one define no name twice in their anonymous namespaces:
check_names.py ROOT, or check_names.py --self-test. The fuzzers, which ordinary tests do not build,
compile the readers in this way."""

import pathlib
import re
import sys

COMPILED_AS_ONE = [
    ["src/files", "src/hdf5", "src/ovf"],
    ["src/scene"],
    ["src/trajectory", "src/program/end_of_process.cpp", "src/program/read_in_child.cpp"],
]

ANONYMOUS = re.compile(r"^namespace \{\n(.*?)^\}  // namespace\n", re.MULTILINE | re.DOTALL)
ALIAS = re.compile(r"^(?:using|namespace) (\w+) = (.*?);", re.MULTILINE | re.DOTALL)
TYPE = re.compile(r"^(?:struct|class|enum class|enum) (\w+)", re.MULTILINE)
CONSTANT = re.compile(r"^(?:inline )?(?:constexpr|const) [\w:<>, *]+? (\w+)(?: =|\[|\{)", re.MULTILINE)
FUNCTION = re.compile(r"^[A-Za-z][\w:<>,\s&*]*?[ &*](\w+)\(([^)]*)\)[^;{]*\{", re.MULTILINE)


def names(text):
    """Returns (name, kind, meaning) of each name. The kind of a function is the types of its
    arguments, so that overloads differ. An alias may be repeated with the same meaning."""
    found = []
    for block in ANONYMOUS.findall(text):
        for name, meaning in ALIAS.findall(block):
            found.append((name, "alias", " ".join(meaning.split())))
        for name in TYPE.findall(block) + CONSTANT.findall(block):
            found.append((name, "", ""))
        for name, arguments in FUNCTION.findall(block):
            types = re.sub(r"\b\w+\s*(,|$)", r"\1", " ".join(arguments.split()))
            found.append((name, types, ""))
    return found


def repeated(files):
    """Returns a sentence for each name that two of the files define. A file: (path, text)."""
    seen, sentences = {}, []
    for path, text in files:
        for name, kind, meaning in names(text):
            before, old_meaning = seen.setdefault((name, kind), (path, meaning))
            if before != path and (kind != "alias" or meaning != old_meaning):
                sentences.append(f"{path}: {name} is also in {before}, with which it is compiled as one")
    return sentences


def files_of(root, places):
    for place in places:
        path = root / place
        for file in sorted(path.glob("*.cpp")) if path.is_dir() else [path]:
            yield str(file.relative_to(root)), file.read_text()


def self_test():
    def count(first, second):
        return len(repeated([(name, f"namespace {{\n{text}\n}}  // namespace\n")
                             for name, text in (("a.cpp", first), ("b.cpp", second))]))

    function = "int one(Key const& key, int more) {\n  return 1;\n}"
    assert count(function, "int one(Key const& other,\n        int less) {\n  return 2;\n}") == 1
    assert count(function, "int one(Key const& key, long more) {\n  return 2;\n}") == 0
    assert count("using Key = int;", "using Key = long;") == 1
    assert count("using Key = int;", "using Key = int;") == 0
    assert count("struct Key {};", "class Key;") == 1
    assert count("constexpr int most = 1;", "constexpr long most = 2;") == 1
    assert count("int other;", function) == 0
    print("7 mistakes and non-mistakes told apart")


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    root = pathlib.Path(sys.argv[1])
    sentences, count = [], 0
    for places in COMPILED_AS_ONE:
        files = list(files_of(root, places))
        count += len(files)
        sentences += repeated(files)
    if sentences:
        sys.exit("\n".join(sentences))
    assert count > 60, f"only {count} files"
    print(f"{count} files: no name twice")


if __name__ == "__main__":
    main()
