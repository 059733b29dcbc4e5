#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Each check of check_docs.py passes a good page and fails a broken one."""
import os
import tempfile
import unittest

import check_docs

GOOD = """# A page

One claim a sentence, with a [link](other.md#second-part) and `docs/guide/other.md`.

```sh
bash cmake/bootstrap.sh build --preset serial
```

| a table may be as wide as it likes | """ + "wide " * 30 + """|
|---|---|
"""
FILES = {
    "README.md": "# Name\n\n![a picture](docs/picture.png)\n",
    "docs/picture.png": "",
    "docs/guide/other.md": "# Other\n\n## Second part\n\nText.\n",
    "cmake/bootstrap.sh": "Usage: bash cmake/bootstrap.sh deps|build [--preset NAME]\n",
    "CMakePresets.json": '{"configurePresets": [{"name": "serial"}]}',
}


class CheckDocs(unittest.TestCase):
    def faults(self, page, more=()):
        """Returns the faults of a project with this page, docs/guide/page.md."""
        with tempfile.TemporaryDirectory() as root:
            for path, text in {**FILES, "docs/guide/page.md": page, **dict(more)}.items():
                full = os.path.join(root, path)
                os.makedirs(os.path.dirname(full), exist_ok=True)
                with open(full, "w", encoding="utf-8") as file:
                    file.write(text)
            return check_docs.check_pages(root) + check_docs.check_sources(root)

    def expect(self, page, sentence, line=None, more=()):
        found = self.faults(page, more)
        self.assertEqual([fault for fault in found if sentence not in fault[2]], [])
        self.assertEqual(len(found), 1, found)
        if line is not None:
            self.assertEqual(found[0][1], line)

    def test_a_good_page_has_no_faults(self):
        self.assertEqual(self.faults(GOOD), [])

    def test_links(self):
        self.expect(GOOD + "\nA [link](nowhere.md).\n", "link to nowhere.md: not there", 12)
        self.expect(GOOD + "\nA [link](other.md#third).\n", "has no such heading", 12)
        self.expect(GOOD + "\nA [link](#no-part).\n", "has no such heading", 12)
        self.expect(GOOD + "\n![picture](nothing.png)\n", "image to nothing.png", 12)

    def test_lines(self):
        self.expect(GOOD + "\n" + "word " * 12 + "\n" + "long" * 26 + "\n", "line of 104 columns", 13)

    def test_sentences(self):
        long = GOOD + "\nWith " + "a\n" * 30 + "word.\n"
        found = list(check_docs.long_sentences([check_docs.Page("page.md", long)]))
        self.assertEqual([(line, text.split(":")[0]) for _, line, text in found],
                         [(12, "sentence of 32 words")])
        self.assertEqual(self.faults(long), [])

    def test_named_files(self):
        self.expect(GOOD + "\nSee `docs/guide/gone.md`.\n", "is not in the repository", 12)
        self.expect(GOOD + "\nSee `cayspin/gone.hpp`.\n", "is not in the repository", 12)
        self.assertEqual(self.faults(GOOD + "\nSee `build/release` and `docs/guide/*.md`.\n"), [])

    def test_commands(self):
        self.expect(GOOD + "\n```sh\nbash cmake/bootstrap.sh fly\n```\n", "no verb fly", 13)
        self.expect(GOOD + "\nType `bash cmake/bootstrap.sh build --preset moon`.\n",
                    "no preset moon", 12)

    def test_pages_outside_of_docs(self):
        self.expect(GOOD, "link to gone.md: not there", 3, {"SECURITY.md": "# Title\n\n[a](gone.md)\n"})
        self.expect(GOOD, "no verb fly", 1, {".github/form.md": "`bash cmake/bootstrap.sh fly`\n"})

    def test_workflows(self):
        step = "steps:\n  - run: bash cmake/bootstrap.sh "
        self.assertEqual(self.faults(GOOD, {".github/workflows/a.yml": step + "build\n"}), [])
        self.expect(GOOD, "no verb fly", 2, {".github/workflows/a.yml": step + "fly\n"})
        self.expect(GOOD, "docs/gone.md is not in the repository", 1,
                    {".github/ISSUE_TEMPLATE/a.yml": "value: Read docs/gone.md\n"})

    def test_first_program(self):
        program = {"examples/01_switching_slab.cpp": "// A slab.\n#include <cstdio>\nint main() {}\n"}
        readme = FILES["README.md"]
        program["README.md"] = readme + "\n```cpp\n#include <cstdio>\nint main() {}\n```\n"
        self.assertEqual(self.faults(GOOD, program), [])
        program["README.md"] = program["README.md"].replace("main() {}", "main() { }")
        self.assertIn("is not that of", self.faults(GOOD, program)[0][2])

    def test_sources(self):
        missing = "docs/gone.md is not in the repository"
        self.expect(GOOD, missing, 2, {"include/a.hpp": "int gone;\n// See docs/gone.md.\n"})
        self.expect(GOOD, missing, 1, {"src/a.cpp": 'print("read docs/gone.md");\n'})
        self.expect(GOOD, missing, 2, {"python/a.py": "a = docs/gone.md\n# as docs/gone.md says\n"})
        self.expect(GOOD, missing, 1, {"scenes/a.toml": "# of docs/gone.md\n"})
        self.expect(GOOD, "no verb fly", 1, {"cmake/a.sh": "# bash cmake/bootstrap.sh fly\n"})
        self.assertEqual(self.faults(GOOD, {"src/b.cpp": "// docs/guide/other.md, a/b, build/docs\n"
                                            'auto const path = "/docs/gone.md";\n'}), [])


if __name__ == "__main__":
    unittest.main()
