#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""check_site.py passes a good site and finds what is wrong in others."""
import contextlib
import io
import pathlib
import tempfile
import unittest

import check_site

HEAD = '<meta name="description" content="What this page of the site is about">'
GOOD = f'{HEAD}<h1 id="top">A</h1><a href="b.html#part">b</a><img src="p.png" alt="a picture">'
OTHER = f'{HEAD}<h1>B</h1><h2 id="part">Part</h2><a href="index.html#top">a</a>'


class CheckSite(unittest.TestCase):
    style = "@media (prefers-color-scheme: dark) {}"

    def faults(self, **files):
        with tempfile.TemporaryDirectory() as name:
            site = pathlib.Path(name).resolve()
            (site / "api").mkdir()
            (site / "api/index.html").touch()
            (site / "_static").mkdir()
            (site / "_static/furo.css").write_text(self.style, encoding="utf-8")
            (site / "p.png").touch()
            for file, text in ({"index": GOOD, "b": OTHER} | files).items():
                (site / f"{file.replace('__', '/')}.html").write_text(text, encoding="utf-8")
            with contextlib.redirect_stdout(io.StringIO()):
                return [sentence for _, sentence in check_site.check(site)]

    def test_a_good_site_has_no_faults(self):
        self.assertEqual(self.faults(), [])

    def test_links(self):
        self.assertEqual(self.faults(b=OTHER.replace("index.html", "gone.html")),
                         ["link to gone.html#top: not there"])
        self.assertEqual(self.faults(b=OTHER.replace("#top", "#end")),
                         ["link to index.html#end: no such place"])
        self.assertEqual(self.faults(index=GOOD.replace("p.png", "q.png")),
                         ["link to q.png: not there"])
        self.assertEqual(self.faults(index=GOOD + '<a href="api/class.html">class</a>'),
                         ["link to api/class.html: not there"])
        self.assertEqual(self.faults(b=OTHER + '<a href="../../out.html">out</a>'),
                         ["link to ../../out.html: not there"])
        self.assertEqual(self.faults(b=OTHER + '<a href="https://example.org/x">x</a>'), [])

    def test_dark_colours(self):
        self.style = ""
        self.assertEqual(self.faults(), ["no dark colours where the system asks for them"])

    def test_images(self):
        for text in ('alt=""', ""):
            self.assertEqual(self.faults(index=GOOD.replace('alt="a picture"', text)),
                             ["image p.png has no alternative text"])

    def test_descriptions(self):
        wrong = "descriptions; accepted: one, of 20 letters"
        self.assertEqual(self.faults(b=OTHER.replace(HEAD, "")), [f"0 {wrong}"])
        self.assertEqual(self.faults(b=HEAD + OTHER), [f"2 {wrong}"])
        self.assertEqual(self.faults(b=OTHER.replace("What this page of the site is about", "B")),
                         [f"1 {wrong}"])

    def test_headings(self):
        self.assertEqual(self.faults(b=OTHER.replace("h1", "h2")),
                         ["0 main headings; accepted: 1"])


if __name__ == "__main__":
    unittest.main()
