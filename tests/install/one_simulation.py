# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Checks that the shared library has the only copy of the simulation and of a static Kokkos:
one_simulation.py NM LIBRARY PROGRAM..., with the programs and libraries that link it.

A copy shows as a function or variable that the library and a program both define or, where symbols
are stripped, as a large file. Symbols of inline functions, templates and static functions do not
count, as every file that uses them has them.
"""

import os
import re
import subprocess
import sys

OF_EVERY_PROGRAM = {"_init", "_fini", "_start", "_edata", "_end", "__bss_start", "main"}
# Functions that the library must contain: those of the simulation, of scenes and of files.
EXPECTED = (r"N7cayspin10simulation", r"N7cayspin\w*?2io\d")


def symbols(nm, file, *options, kinds):
    done = subprocess.run([nm, *options, file], capture_output=True, text=True, check=True)
    return {re.sub("@.*", "", line.split()[-1]) for line in done.stdout.splitlines()
            if line.split()[-2] in kinds}


def problems_of(nm, library, programs):
    shown = symbols(nm, library, "-D", "--defined-only", kinds="TDBR")
    for part in EXPECTED:
        if not any(re.search(part, name) for name in shown):
            yield f"{library} has no function of {part}"
    for program in programs:
        if not symbols(nm, program, "-D", "--undefined-only", kinds="U") & shown:
            yield f"{program} takes nothing from {library}"
        if os.path.getsize(program) > os.path.getsize(library) / 4:
            yield f"{program} is larger than a quarter of {library}"
        own = symbols(nm, program, "--defined-only", kinds="TDBR")
        copied = sorted((own & shown) - OF_EVERY_PROGRAM)
        if copied:
            yield (f"{program} has {len(copied)} functions and variables of {library}, too: "
                   f"{', '.join(copied[:5])}")


def main():
    if len(sys.argv) < 4:
        sys.exit("usage: one_simulation.py NM LIBRARY PROGRAM...")
    nm, library, *programs = sys.argv[1:]
    problems = list(problems_of(nm, library, programs))
    print("\n".join(problems) or f"{len(programs)} programs and libraries have no copy")
    sys.exit(1 if problems else 0)


if __name__ == "__main__":
    main()
