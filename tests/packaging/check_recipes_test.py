# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Each check of check_recipes.py fails on a recipe with that fault."""

import pathlib
import unittest

from check_recipes import problems_of, recipes_of

ROOT = pathlib.Path(__file__).resolve().parents[2]
SPACK, CONDA, VARIANTS = recipes_of(ROOT)


class Recipes(unittest.TestCase):
    def expect(self, words, spack=SPACK, conda=CONDA, variants=VARIANTS):
        self.assertNotEqual((spack, conda, variants), (SPACK, CONDA, VARIANTS))
        problems = problems_of(ROOT, spack, conda, variants)
        self.assertTrue(any(words in line for line in problems), problems)

    def test_as_they_are(self):
        self.assertEqual(problems_of(ROOT, SPACK, CONDA, VARIANTS), [])

    def test_spack(self):
        for old, new, words in [
                ('version("0.1.0")', 'version("9.1.0")', "spack: no version"),
                ('depends_on("fmt@9:")', "pass", "spack: fmt is required"),
                ("kokkos@4.5:5", "kokkos@4.5:", "spack: kokkos has to be"),
                ("cmake@3.25:", "cmake@3.20:", "spack: cmake has to be"),
                ('when="+shared")', 'when="+static")', "depends on static, which is no variant"),
                ("CAYSPIN_BUILD_BENCH", "CAYSPIN_BUILD_BENCHES", "option CAYSPIN_BUILD_BENCHES"),
                ('"examples", "scenes"', '"examples", "scene"', "tests need scene, which"),
                ("macrospin", "microspin", "tests need scenes/microspin.toml")]:
            with self.subTest(words):
                self.expect(words, spack=SPACK.replace(old, new))

    def test_spack_variant_of_an_option(self):
        with self.assertRaisesRegex(KeyError, "there is no variant app"):
            problems_of(ROOT, SPACK.replace('_APP", "program"', '_APP", "app"'), CONDA, VARIANTS)

    def test_conda(self):
        for old, new, words in [
                ('version = "0.1.0"', 'version = "0.2.0"', "conda: the version"),
                ("    - muparser >=2.3.3\n", "", "conda: muparser is required"),
                ("kokkos >=4.5,<6\n    - hdf5", "kokkos >=4.5\n    - hdf5", "conda: kokkos has"),
                ("cmake >=3.25", "cmake", "conda: cmake has to be"),
                ("DCAYSPIN_INSTALL", "DCAYSPIN_INSTAL", "conda: there is no CMake option"),
                ("\nabout:", "\nabouts:", "conda: no section about"),
                ("    - scenes\n", "    - scene\n", "conda: its tests need scene, which"),
                ("scenes/macrospin", "scenes/microspin", "tests need scenes/microspin.toml")]:
            with self.subTest(words):
                self.expect(words, conda=CONDA.replace(old, new))

    def test_conda_variants(self):
        self.expect("does not say what stdlib is", variants=VARIANTS.replace("c_stdlib:", "libc:"))


if __name__ == "__main__":
    unittest.main()
