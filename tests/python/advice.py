# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""trade and advise run the program and return records."""

import json
import os
import subprocess
import unittest
import unittest.mock

import cayspin
import matplotlib
import numpy as np
from cayspin.view.run import Run
from package_test import PROGRAM, PackageTest, scene, stepped

matplotlib.use("Agg")

SPIN = {"lattice": {"shape": [1], "spacing": None, "boundary": None},
        "field": {"exchange": None, "slab_demag": None},
        "integrator": {"method": "rkmk4", "dt": 0.05, "steps": 40}}


class Advice(PackageTest):
    def test_what_is_advised_runs(self):
        advice = cayspin.advise(scene(**SPIN), error=1e-4, precision="double", threads=1)
        self.assertEqual(advice.precision, "double")
        self.assertEqual(advice.threads, 1)
        self.assertLessEqual(advice.error, 1e-4)
        sim = cayspin.Simulation(advice.scene, advice.precision)
        sim.run()
        self.assertEqual(sim.steps, advice.steps)
        reference = stepped(scene(**{**SPIN, "integrator": {"method": "rkmk8", "dt": 0.05}}), 40)
        distance = np.linalg.norm(sim.spins - reference, axis=-1).max()
        self.assertGreater(distance, 0)
        self.assertLess(distance, 4e-4)
        self.assertLessEqual(advice.seconds, min(one["seconds"] for one in advice.others))

    def test_text_and_json_say_the_same(self):
        command = [PROGRAM, "advise", self.written(scene(**SPIN)), "--error", "1e-3", "--threads", "1"]
        keys = set(json.loads(subprocess.run([*command, "--json"], check=True, text=True,
                                             capture_output=True).stdout))
        self.assertEqual(keys, {"method", "precision", "dt", "steps", "tolerance", "error",
                                "seconds", "memory", "horizon", "units", "warning", "overrides",
                                "others", "space", "threads"})
        text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
        for word in ("scene ", "method ", "error ", "memory ", "run it ", "the next best:"):
            self.assertIn(word, text)

    def test_what_only_this_program_can_run(self):
        for of in (scene(field={"applied": lambda t: (0, 0, 1)}),
                   scene(initial=np.ones((2, 3, 7, 3)))):
            self.assert_refused(cayspin.CayspinError, "the program cannot run", cayspin.advise,
                                of, error=1e-3)

    def test_messages_name_neither_options_nor_files_of_the_program(self):
        for part, options in (("^advise: error 5; accepted: ", {"error": 5}),
                              ("^advise: precision half: accepted: ", {"precision": "half"}),
                              ("^advise: threads Value 0 not in range 1 to 65536$", {"threads": 0})):
            with self.assertRaisesRegex(cayspin.CayspinError, part):
                cayspin.advise(scene(), **{"error": 0.1, **options})
        with self.assertRaisesRegex(cayspin.CayspinError, "^integrator: is missing"):
            cayspin.advise(scene(integrator=None), 0.1)

    def test_warnings_name_no_file_of_the_package(self):
        answer = {"method": "rkmk4", "error": 0.01, "seconds": 1, "memory": 1, "dt": 0.5,
                  "precision": "double", "steps": 2, "tolerance": None, "horizon": 1,
                  "units": "reduced", "space": "Serial", "threads": 1, "others": [],
                  "overrides": [], "warning": "FILE:3: integrator.dt: 0.5 is above the stable 0.4"}
        program = self.folder / "program"
        program.write_text(f"#!/bin/sh\nsed \"s|FILE|$2|\" <<'TXT'\n{json.dumps(answer)}\nTXT\n")
        program.chmod(0o755)
        with unittest.mock.patch.dict(os.environ, {"CAYSPIN_PROGRAM": str(program)}):
            advice = cayspin.advise(scene(), error=0.1)
        self.assertEqual(advice.warning, "integrator.dt: 0.5 is above the stable 0.4")

    def test_a_program_that_ends_without_a_word(self):
        with unittest.mock.patch.dict(os.environ, {"CAYSPIN_PROGRAM": "/bin/false"}):
            self.assert_refused(cayspin.CayspinError, "advise: the program ended with status 1",
                                cayspin.advise, scene(), error=0.1)

    def test_programs_are_no_ranks(self):
        ranked = dict.fromkeys(
            ("PMI_RANK", "PMI_SIZE", "PMIX_RANK", "OMPI_COMM_WORLD_SIZE"), "2")
        program, text = self.folder / "program", self.folder / "environment"
        program.write_text(f"#!/bin/sh\nenv > '{text}'\necho it ends >&2\nexit 2\n")
        program.chmod(0o755)
        file = self.written(scene(output={"file": "out.h5"}))

        def assert_alone(names):
            self.assertIn("PATH", names)
            self.assertFalse(set(ranked) & set(names))

        with unittest.mock.patch.dict(os.environ, {"CAYSPIN_PROGRAM": str(program), **ranked}):
            for error, call in ((cayspin.CayspinError, lambda: cayspin.advise(scene(), error=0.1)),
                                (ValueError, lambda: Run(str(program), file))):
                self.assert_refused(error, "it ends", call)
                assert_alone([line.partition("=")[0] for line in text.read_text().splitlines()])
                text.unlink()
            with unittest.mock.patch("subprocess.Popen", side_effect=OSError) as popen:
                self.assertRaises(OSError, cayspin.view, file)
            assert_alone(popen.call_args.kwargs["env"])


class Trade(PackageTest):
    def test_records_and_picture(self):
        trade = cayspin.trade(scene(**SPIN), seconds=0.01, precision="double", threads=1)
        for run in trade:
            self.assertEqual({"dt", "tolerance"} & set(run), {"dt"} if "dt" in run
                             else {"tolerance"})
            self.assertGreater(run["evaluations"], 0)
        self.assertGreater(len({run["method"] for run in trade}), 10)
        named = {run["method"] for run in trade if run["front"]}
        axes = trade.plot(cost="evaluations")
        self.assertEqual({text.get_text() for text in axes.get_legend().get_texts()}, named)


if __name__ == "__main__":
    unittest.main()
