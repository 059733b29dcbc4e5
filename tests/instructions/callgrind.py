# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Runs test_instructions under callgrind."""

import pathlib
import re
import subprocess
import sys
import tempfile

SITES = 1024  # of the lattice in steps.cpp


def dumps_of(program, *options):
    """Returns callgrind's output for each kernel, by name."""
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run(
            ["valgrind", "--tool=callgrind", "--collect-atstart=no",
             f"--callgrind-out-file={folder}/counts", *options, program], check=False, text=True,
            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        if done.returncode != 0:
            sys.exit(f"callgrind ended with {done.returncode}:\n{done.stderr}")
        texts = [path.read_text(encoding="utf-8")
                 for path in pathlib.Path(folder).glob("counts.*")]
    found = {}
    for text in texts:
        if match := re.search(r"^desc: Trigger: Client Request: (\w+)$", text, re.MULTILINE):
            found[match[1]] = text
    return dict(sorted(found.items()))
