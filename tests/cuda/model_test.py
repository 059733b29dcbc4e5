#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Tests the model of the kernels' times on a GPU, and that, according to this model, the kernels
reach the required share of the bandwidth. Tests the report of a run on a GPU, with made-up
results."""

import contextlib
import io
import json
import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "bench"))
import gpu_report  # noqa: E402
import model_gpu  # noqa: E402

H100 = model_gpu.CARDS["H100"]
# Instruction counts of geometric Euler in double precision, from a version whose loop divided and
# branched.
BRANCHING = model_gpu.Kernel("f64_LieEuler_0 577 126 21 0 388 3 39 45")


def share(kernels, precision, method):
    time, memory, _ = model_gpu.steps(kernels, H100, 256)[precision, method]
    return memory / time


class Model(unittest.TestCase):
    def setUp(self):
        self.kernels = model_gpu.read_kernels()

    def test_words_are_those_of_the_benchmarks(self):
        words = {}
        for kernel in self.kernels:
            key = kernel.precision, model_gpu.METHODS[kernel.method]
            words[key] = words.get(key, 0) + kernel.words
        of_bench = {"Euler": 6, "Heun": 21, "RKMK4": 57, "Heun tangent": 15, "RKMK4 tangent": 39,
                    "Euler in pairs": 6, "Heun in pairs": 6, "RKMK4 in pairs": 27, "Heun tangent in pairs": 6,
                    "RKMK4 tangent in pairs": 21}
        for precision in ("f32", "f64"):
            for method, count in of_bench.items():
                self.assertEqual(words[precision, method], count, method)

    def test_times_of_one_kernel(self):
        kernel = model_gpu.Kernel("f64_LieEuler_0 240 80 21 0 40 3 16 56")
        times = model_gpu.seconds(kernel, H100, 256)
        self.assertEqual(kernel.warps, 36)
        self.assertAlmostEqual(times["memory"] * 1e12, 48 / 3.35, places=6)
        # 160 instructions for a site and 80 for a thread, which has 8 sites; 4 schedulers of 32
        # lanes
        self.assertAlmostEqual(times["issue"] * 1e12, 170 / 128 / 132 / 1.755e-3, places=6)
        self.assertAlmostEqual(times["arithmetic"] * 1e12, 80 / 64 / 132 / 1.755e-3, places=6)

    def test_share_of_the_bandwidth(self):
        for method in ("Euler", "Heun", "RKMK4"):
            self.assertGreaterEqual(share(self.kernels, "f64", method), 0.9, method)
            self.assertGreaterEqual(share(self.kernels, "f32", method), 0.8, method)

    def test_batches_of_small_lattices(self):
        # Instructions of integers: 60 for a site and 80 for a thread, which has one site
        kernel = model_gpu.Kernel("f64_LieEuler_0 240 60 21 0 60 3 16 56")
        with contextlib.redirect_stdout(io.StringIO()) as text:
            model_gpu.print_replicas([kernel])
        expected = 140 / 64 / 132 / 1.755e-3
        self.assertIn(f"| Euler | {expected:.1f} (integers) |", text.getvalue())

    def test_small_films(self):
        # 49 teams of 256 threads: two warps for each scheduler
        tiles = model_gpu.Kernel("f64_Rkmk4InTiles_all 4000 400 30 74 700 4 130 64")
        stages = [model_gpu.Kernel(f"f64_Rkmk4_{stage} 300 100 27 0 70 6 7 48")
                  for stage in range(4)]
        passes, in_one = model_gpu.film_steps([*stages, tiles])["f64", "RKMK4"]
        self.assertAlmostEqual(passes, 1e5, places=6)
        self.assertAlmostEqual(in_one, 1 / (800e-9 + 8000 / 1.755e9), places=6)

    def test_a_branching_kernel_is_not_bound_by_memory(self):
        self.assertLess(share([BRANCHING], "f64", "Euler"), 0.8)


def host_result(ns_per_spin):
    def case(name, **counters):
        return {"run_name": f"{name}/real_time", "run_type": "iteration", "family_index": 0,
                **counters}

    context = {"execution_space": "OpenMP", "threads": "2",
               "kokkos_configuration": "Kokkos::Cuda[ 0 ] NVIDIA H200 : Selected\n"}
    return {"context": context,
            "benchmarks": [case("stream copy", **{"GB/s": 4000.0}),
                           case("f64/Euler/256", **{"ns/spin": ns_per_spin})]}


class Report(unittest.TestCase):
    def report(self, ns_per_spin, tests):
        with tempfile.TemporaryDirectory() as folder:
            build = pathlib.Path(folder)
            (build / "bench-results").mkdir()
            (build / "bench-results" / "large.json").write_text(
                json.dumps(host_result(ns_per_spin)))
            (build / "gpu-bench.txt").write_text("a table\n")
            if tests:
                (build / "gpu-tests.txt").write_text(tests)
            return gpu_report.report(build)

    def test_measured_beside_the_model(self):
        text, complete = self.report(0.0262, "100% tests passed, 0 tests failed out of 3\n")
        self.assertTrue(complete)
        self.assertIn("measured on NVIDIA H200; copy of the memory 4.000 TB/s, 0.83 of", text)
        # The model says 13.1 ps, limited by the second-level cache; 48 bytes at the rate of the
        # copy take 12 ps.
        self.assertIn("| f64/Euler/256 | 26.2 | 13.1 | 2.00 | 0.46 |", text)
        self.assertIn("a table", text)

    def test_failures_are_named(self):
        text, complete = self.report(0.02, "67% tests passed, 1 tests failed out of 3\n\n"
                                     "The following tests did not run:\n\t 5 - sass (Skipped)\n\n"
                                     "The following tests FAILED:\n\t 7 - stepper (Failed)\n")
        self.assertFalse(complete)
        self.assertIn("**stepper**: Failed", text)
        self.assertIn("Skipped: sass.", text)

    def test_what_is_missing_is_named(self):
        text, complete = self.report(0.02, None)
        self.assertFalse(complete)
        self.assertIn("**Missing: gpu-tests.txt.**", text)


if __name__ == "__main__":
    unittest.main()
