# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""What the tests of the compilers for devices have in common."""

import json
import re
import shlex
import subprocess


def compile_entry(commands, source):
    """The directory and the words of the command that compiles a source."""
    entry = next(entry for entry in json.loads(commands.read_text()) if entry["file"] == source)
    return entry["directory"], shlex.split(entry["command"])


def short_names(symbols):
    """What a kernel does and to which precision, without Kokkos' wrapping."""
    names = subprocess.run(["c++filt"], input="\n".join(symbols), check=True, text=True,
                           stdout=subprocess.PIPE).stdout.splitlines()
    for name in names:
        inner = re.search(r"ParallelFor<(.*?), Kokkos::RangePolicy", name)
        yield re.sub(r"(cayspin|detail|stepper|tableau)::", "", inner[1] if inner else name)
