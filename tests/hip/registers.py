#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Compiles the device code of a source with hipcc and prints the registers that its kernels take;
fails if a kernel that does not match --may-spill spills vector registers to memory. Scalar
registers may spill, as they spill into lanes of vector registers."""

import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "cuda"))
from device_kernels import compile_entry, output_of, parser_of, short_names  # noqa: E402

REMARK = re.compile(r"remark:\s+(Function Name|VGPRs|AGPRs|ScratchSize|SGPRs Spill|VGPRs Spill)"
                    r"(?: \[[^\]]*\])?: (\S+)")


def kernels(output):
    """Returns the compiler's statistics of each kernel, as dictionaries."""
    found = []
    for name, value in REMARK.findall(output):
        if name == "Function Name":
            found.append({"symbol": value})
        elif found:
            found[-1][name] = int(value)
    return [kernel for kernel in found if "cayspin" in kernel["symbol"]]


def main():
    parser = parser_of(__doc__)
    parser.add_argument("--may-spill", metavar="PATTERN", default="(?!)")
    arguments = parser.parse_args()
    directory, words = compile_entry(arguments)
    words[words.index("-o") + 1] = arguments.output
    log = output_of([*words, "--cuda-device-only", "-Rpass-analysis=kernel-resource-usage"],
                    directory)
    found = kernels(log)
    if not found:
        sys.exit(f"{log}\nno kernels")

    spilled, refused = 0, 0
    print("VGPRs  AGPRs  scratch (bytes)  spilled VGPRs  spilled SGPRs")
    for name, row in sorted(zip(short_names(row["symbol"] for row in found), found),
                            key=lambda pair: pair[0]):
        spilled += row["VGPRs Spill"] > 0
        refused += row["VGPRs Spill"] > 0 and not re.search(arguments.may_spill, name)
        print(f"{row['VGPRs']:>5}  {row['AGPRs']:>5}  {row['ScratchSize']:>15}  "
              f"{row['VGPRs Spill']:>13}  {row['SGPRs Spill']:>13}  {name}")
    print(f"{len(found)} kernels, {spilled} spill vector registers, {refused} that should not")
    return refused > 0


if __name__ == "__main__":
    sys.exit(main())
