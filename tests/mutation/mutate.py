#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Breaks the sources in small ways, one at a time, and says which of them no test sees.

Usage: mutate.py [--count N] [--seed S] [--only PATH]... [--skip N] [--list] [--work FOLDER]
       mutate.py --self-test

Works in a copy of the tracked files, which it builds without optimisation. For each mutation it
builds and runs the tests of tests.py in their order, until one fails. Prints a line for each one:
killed (a test failed or hung), survived, or refused (it did not compile).
"""
import argparse
import collections
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import time

from mutations import mutations_of
from tests import EXCLUDED, SOURCES, tests_of

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD_LIMIT, TEST_LIMIT = 600, 400  # seconds


def run(command, limit, **options):
    """The exit status, with None for a command that took too long."""
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                               start_new_session=True, **options)
    try:
        return process.wait(limit)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, 9)
        process.wait()
        return None


class Tree:
    """A copy of the tracked files and its build folder."""

    def __init__(self, work):
        self.sources, self.build = work / "tree", work / "build"

    def prepare(self, options):
        names = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, check=True, text=True,
                               capture_output=True).stdout.split("\0")
        for name in filter(None, names):
            here, there = ROOT / name, self.sources / name
            if not here.is_file():
                continue
            if not there.exists() or here.read_bytes() != there.read_bytes():
                there.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(here, there)
        command = ["cmake", "-S", self.sources, "-B", self.build, "-G", "Ninja",
                   "-DCMAKE_BUILD_TYPE=Debug", "-DCMAKE_CXX_FLAGS_DEBUG=-O0",
                   "-DCAYSPIN_BUILD_TESTS=ON", "-DCAYSPIN_BUILD_APP=ON",
                   "-DCAYSPIN_BUILD_EXAMPLES=OFF", "-DCAYSPIN_BUILD_BENCH=OFF",
                   "-DCAYSPIN_BUILD_PYTHON=OFF", *options]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)

    def compiles(self, target):
        return run(["nice", "cmake", "--build", self.build, "--target", target],
                   BUILD_LIMIT) == 0

    def passes(self, test):
        environment = dict(os.environ, OMP_NUM_THREADS="2", OMP_PROC_BIND="false",
                           OMP_WAIT_POLICY="passive")
        command = [self.build / "bin" / test.target, "--gtest_brief=1", "--gtest_fail_fast"]
        if test.filter:
            command.append(f"--gtest_filter={test.filter}")
        return run(["nice", *command], TEST_LIMIT, env=environment, cwd=self.build) == 0


def judge(tree, name, changed, tests):
    """What happens to the tests when the file `name` has the text `changed`."""
    path = tree.sources / name
    before = path.read_text(encoding="utf-8")
    path.write_text(changed, encoding="utf-8")
    try:
        for test in tests:
            if not tree.compiles(test.target):
                return "refused"
            if not tree.passes(test):
                return "killed"
        return "survived"
    finally:
        path.write_text(before, encoding="utf-8")


def require_green(tree, tests):
    for test in tests:
        if not tree.compiles(test.target) or not tree.passes(test):
            sys.exit(f"{test.target} fails without a mutation")


def all_mutations(root, only):
    found = []
    for pattern in SOURCES:
        for path in sorted(root.glob(pattern)):
            name = path.relative_to(root).as_posix()
            if name in EXCLUDED:
                continue
            if only and not any(name.startswith(prefix) for prefix in only):
                continue
            text = path.read_text(encoding="utf-8")
            found += [(name, mutation) for mutation in mutations_of(text)]
    return found


def survey(arguments):
    found = all_mutations(ROOT, arguments.only)
    random.Random(arguments.seed).shuffle(found)
    chosen = sorted(found[arguments.skip:arguments.skip + arguments.count], key=lambda m: m[0])
    print(f"{len(chosen)} of {len(found)} mutations, seed {arguments.seed}", flush=True)
    if arguments.list:
        for name, mutation in chosen:
            print(f"{name}:{mutation.line}: {mutation}")
        return
    tree = Tree(arguments.work)
    tree.prepare(arguments.cmake)
    require_green(tree, list(dict.fromkeys(t for name, _ in chosen for t in tests_of(name))))
    results = collections.Counter()
    for name, mutation in chosen:
        begin = time.monotonic()
        text = (tree.sources / name).read_text(encoding="utf-8")
        result = judge(tree, name, mutation.applied(text), tests_of(name))
        results[result] += 1
        print(f"{result:8} {time.monotonic() - begin:4.0f} s  {name}:{mutation.line}: {mutation}",
              flush=True)
    seen = results["killed"] + results["survived"]
    print(", ".join(f"{count} {result}" for result, count in sorted(results.items())))
    print(f"seen: {results['killed']} of {seen} that compile")


def self_test():
    """Two mutations of a program of two functions: its test sees one of them."""
    class Test:
        target, filter = "toy", ""

    class Toy(Tree):
        def __init__(self, work):
            self.sources = self.build = work
            (work / "bin").mkdir()

        def compiles(self, target):
            compiler = os.environ.get("CXX", "c++")
            program = self.build / "bin" / target
            return run([compiler, "-o", program, self.sources / "toy.cpp"], 60) == 0

    text = ("// a > b in a comment\n"
            "int larger(int a, int b) { return a > b ? a : b; }\n"
            "int main() { return larger(2, 3) != 3; }  // a == b\n")
    with tempfile.TemporaryDirectory() as folder:
        tree = Toy(pathlib.Path(folder))
        (tree.sources / "toy.cpp").write_text(text)
        mutations = [m for m in mutations_of(text) if m.kind == "comparison"]
        assert [str(m) for m in mutations] == ["comparison: `>` -> `>=`: " + text.split("\n")[1],
                                               "comparison: `!=` -> `==`: int main() { return "
                                               "larger(2, 3) != 3; }"], mutations
        results = [judge(tree, "toy.cpp", m.applied(text), [Test]) for m in mutations]
        assert results == ["survived", "killed"], results
        assert (tree.sources / "toy.cpp").read_text() == text
        assert judge(tree, "toy.cpp", text.replace("larger(2", "lesser(2"), [Test]) == "refused"
    for prefix in SOURCES:
        for path in ROOT.glob(prefix):
            assert tests_of(path.relative_to(ROOT).as_posix()), path
    print("two mutations of the toy: one seen, one not")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--skip", type=int, default=0, help="the first so many of the seed")
    parser.add_argument("--only", action="append", metavar="PATH", help="files that begin so")
    parser.add_argument("--list", action="store_true", help="the mutations, without trying them")
    parser.add_argument("--work", type=pathlib.Path, default=ROOT / "build" / "mutation")
    parser.add_argument("--cmake", action="append", default=[], metavar="OPTION",
                        help="for the configuration, as -DKokkos_ROOT=...")
    parser.add_argument("--self-test", action="store_true")
    arguments = parser.parse_args()
    self_test() if arguments.self_test else survey(arguments)


if __name__ == "__main__":
    main()
