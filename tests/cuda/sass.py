#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Counts the instructions of the main kernels on a GPU, from their machine code, and compares the
counts with recorded ones, to 2 %. Nothing is run.

A thread walks over a few sites. The instructions of this loop, which run once for each site, are
counted by kind; the rest of a kernel, which runs once for each thread, counts only in "total".
Every instruction of the loop has a kind. "shared" is access to scratch memory. "integer" is any
that is neither arithmetic of the method, nor a load, a store or a load of a constant: addressing,
ends of the lattice, branches. In double precision, a kernel may have no more of these than
arithmetic instructions, unless it computes several stages. A kernel with all stages of a step has
no loop: each thread has one site, and all instructions are counted by kind."""

import collections
import pathlib
import re
import subprocess
import sys

from device_kernels import (
    compile_entry, device_command, kernels_of_log, output_of, parser_of)

MARGIN = 0.02
NVCC = "release 13.0"
COLUMNS = ("total", "arithmetic", "loads", "shared", "integer", "stores", "constants", "registers")
KINDS = {
    "arithmetic": "DADD DMUL DFMA DSETP DMNMX FADD FMUL FFMA FSETP FMNMX FCHK MUFU F2F".split(),
    "loads": ["LDG", "LD"],
    "shared": ["LDS", "STS"],
    "stores": ["STG", "ST"],
    "constants": ["LDC", "ULDC", "LDCU"],
}
PRECISIONS = {"float": "f32", "double": "f64"}
METHODS = {
    ("Euler", "Lie"): "LieEuler",
    ("Heun", "LieUncorrected"): "LieHeun",
    ("Classical4", "Lie"): "Rkmk4",
    ("Heun", "Stereographic"): "StereographicHeun",
    ("Classical4", "Stereographic"): "StereographicRk4",
}


def kernel_name(symbol):
    """Returns precision, method and stage of a symbol; None if the kernel has 64-bit indices."""
    name = subprocess.run(["c++filt", symbol], check=True, text=True,
                          stdout=subprocess.PIPE).stdout
    stage = r"RungeKuttaStage<cayspin::v\w+::tableau::(\w+), cayspin::v\w+::update::(\w+)"
    if found := re.search(r"StagePairOnTiles<int, cayspin::v\w+::detail::" + stage +
                          r".*?, (\d+), cayspin.*?, (float|double)>, cayspin::v\w+::detail::" +
                          stage + r".*?, (\d+), cayspin", name):
        method = METHODS[found[1], found[2]]
        return f"{PRECISIONS[found[4]]}_{method}InPairs_{found[3]}+{found[7]}"
    if found := re.search(r"StepInTiles<(float|double), cayspin::v\w+::detail::" + stage, name):
        return f"{PRECISIONS[found[1]]}_{METHODS[found[2], found[3]]}InTiles_all"
    found = re.search(r"TileLoop<int, .*?OnDeviceSite<(float|double), .*?RungeKuttaStage<"
                      r"cayspin::v\w+::tableau::(\w+), cayspin::v\w+::update::(\w+).*?, (\d+), "
                      r"cayspin", name)
    if not found:
        return None
    return f"{PRECISIONS[found[1]]}_{METHODS[found[2], found[3]]}_{found[4]}"


def operation(text):
    return re.sub(r"^@!?U?P\w+\s+", "", text).split()[0].split(".")[0]


def kind(text):
    return next((kind for kind, words in KINDS.items() if operation(text) in words), "integer")


def instructions(lines):
    """Returns [(labels before an instruction, its text)] of a kernel."""
    found, labels = [], set()
    for line in lines:
        if match := re.match(r"(\.L\w+):", line):
            labels.add(match[1])
        elif match := re.match(r"\s*/\*[0-9a-f]{4,}\*/\s+(.*?)\s*;", line):
            if operation(match[1]) != "NOP":
                found.append((labels, match[1]))
                labels = set()
    return found


def site_loop(code, name):
    """Returns the instructions of the shortest loop that loads from memory."""
    at = {label: index for index, (labels, _) in enumerate(code) for label in labels}
    loops = []
    for index, (_, text) in enumerate(code):
        jump = re.search(r"\bBRA `\((\.L\w+)\)", text)
        if jump and at[jump[1]] < index:
            body = [text for _, text in code[at[jump[1]]:index + 1]]
            if any(kind(text) == "loads" for text in body):
                loops.append(body)
    if not loops:
        sys.exit(f"{name}: no loop over sites")
    return min(loops, key=len)


def has_stages(name):
    return "InPairs" in name or "InTiles" in name


def counts_of_kernels(listing, registers):
    counts = {}
    for section in re.split(r"^\t\.section\t\.text\.", listing, flags=re.MULTILINE)[1:]:
        symbol = section.split(",", 1)[0]
        if name := kernel_name(symbol):
            if "launch_local_memory" not in symbol and "InPairs" not in name:
                sys.exit(f"{name}: more than 512 bytes of arguments, so launches wait")
            code = instructions(section.splitlines())
            in_tiles = "InTiles" in name
            loop = [text for _, text in code] if in_tiles else site_loop(code, name)
            # Kokkos divides 64-bit integers in kernels of teams.
            if not in_tiles and (calls := [text for text in loop if operation(text) == "CALL"]):
                sys.exit(f"{name}: {calls[0]} in the loop over sites")
            by_kind = collections.Counter(map(kind, loop))
            counts[name] = [len(code), *(by_kind[column] for column in COLUMNS[1:-1]),
                            registers[symbol]]
    return dict(sorted(counts.items()))


def read_counts(path):
    rows = [line.split() for line in path.read_text().splitlines() if not line.startswith("#")]
    return {row[0]: list(map(int, row[1:])) for row in rows}


def wrong_counts(found, expected):
    for name in sorted(found.keys() | expected.keys()):
        if name not in found or name not in expected:
            yield f"{name}: {'not compiled' if name in expected else 'not expected'}"
            continue
        row = dict(zip(COLUMNS, found[name]))
        if name.startswith("f64") and not has_stages(name) and row["integer"] > row["arithmetic"]:
            yield f"{name}: {row['integer']} integer for {row['arithmetic']} of arithmetic"
        for column, count, before in zip(COLUMNS, found[name], expected[name]):
            if abs(count - before) > MARGIN * before:
                yield f"{name}: {count} {column}, expected {before}"


def main():
    parser = parser_of(__doc__.split("\n\n")[0])
    parser.add_argument("expected", type=pathlib.Path)
    parser.add_argument("--nvdisasm", required=True)
    parser.add_argument("--record", action="store_true", help="write what is found")
    arguments = parser.parse_args()
    directory, words = compile_entry(arguments)
    version = subprocess.run([words[0], "--version"], text=True, stdout=subprocess.PIPE).stdout
    if NVCC not in version or "-arch=sm_90" not in words:
        print(f"skipped: the numbers are those of nvcc, {NVCC}, for sm_90")
        return 0
    if not pathlib.Path(arguments.nvdisasm).is_file():
        print("skipped: there is no nvdisasm")
        return 0
    log = output_of(device_command(words, arguments.output), directory)
    registers = {row.symbol: row.registers for row in kernels_of_log(log)}
    listing = output_of([arguments.nvdisasm, "-c", arguments.output], directory)
    found = counts_of_kernels(listing, registers)
    lines = [" ".join(map(str, [name, *row])) for name, row in found.items()]
    text = "\n".join(["# kernel " + " ".join(COLUMNS), *lines])
    print(text)
    if arguments.record:
        arguments.expected.write_text(text + "\n")
        return 0
    if wrong := list(wrong_counts(found, read_counts(arguments.expected))):
        sys.exit("\n  ".join([f"more than {MARGIN:.0%} away, or too much:", *wrong,
                              "Where that is meant, build the target record_sass."]))
    return 0


if __name__ == "__main__":
    sys.exit(main())
