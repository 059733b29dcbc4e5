# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""The data that `cayspin view` sends to its page, and the requests that it refuses."""

import os
import pathlib
import subprocess
import sys
import time
import unittest

import h5py
import numpy as np
from script_test import SCRIPTS, ScriptTest, write
from view_test import LONG_SCENE, Page

import cayspin_plots  # noqa: F401  puts `texture` on the path
from texture import checksum


# Prints the signals that a run gets if it is stopped twice. Like view_texture.py, it needs nothing
# compiled.
STOP_TWICE = """
import pathlib, sys, types
from unittest import mock
package = types.ModuleType("cayspin")
package.__path__ = [sys.argv[1]]
sys.modules["cayspin"] = package
from cayspin.view.run import Run
with mock.patch("subprocess.Popen") as popen, mock.patch("pathlib.Path.exists") as exists:
    exists.side_effect = [False, True, True]
    popen.return_value.poll.return_value = None
    run = Run("cayspin", pathlib.Path(sys.argv[2]))
    run.stop()
    run.stop()
    print(*(call.args[0].name for call in popen.return_value.send_signal.call_args_list))
"""


def state_of(pid):
    return pathlib.Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]


class Refusals(ScriptTest):
    def setUp(self):
        super().setUp()
        self.page = Page(self, write(self.folder / "chain.h5"))

    def assert_refused(self, status, part, path, method="GET", headers=None, **query):
        answer = self.page.ask(path, method, headers, **query)
        self.assertEqual(answer.status, status, answer.text)
        self.assertIn(part, answer.text)
        self.assertEqual(answer.text.count("\n"), 1, answer.text)
        self.assertEqual(answer.headers["Content-Type"], "text/plain; charset=utf-8")
        self.assertNotIn("root:", answer.text)

    def test_who_asks(self):
        for path in ("/", "/news", "/frame", "/positions", "/path"):
            for token in ("", "x", self.page.token[:-1], self.page.token + "x", "\u00e4"):
                self.assert_refused(403, "token: missing or wrong", path, token=token)
            for host in ("evil.example", f"evil.example:{self.page.port}", "127.0.0.1",
                         f"127.0.0.1:{self.page.port + 1}", f"[::1]:{self.page.port}"):
                self.assert_refused(403, f"host {host}", path, headers={"Host": host})
            for origin in ("http://evil.example", "null", f"https://{self.page.host}"):
                self.assert_refused(403, f"origin {origin}", path, headers={"Origin": origin})
        self.assert_refused(403, "token", "/steer", "POST", token="x")
        self.assert_refused(403, "host evil", "/page.js", headers={"Host": "evil.example"})
        ok = f"localhost:{self.page.port}"
        answer = self.page.ask("/", headers={"Host": ok, "Origin": f"http://{ok}"})
        self.assertEqual(answer.status, 200)

    def test_only_its_own_files(self):
        for path in ("/../../etc/passwd", "/..%2f..%2fetc/passwd", "/%2e%2e/%2e%2e/etc/passwd",
                     "/page.js/../../server.py", "/server.py", "/index.html/", "/page/page.js",
                     "/page.js%00", "/pageXjs", "//etc/passwd", "/chain.h5", "/.", "/%zz"):
            self.assert_refused(404, "there is no such page", path)
        self.assert_refused(405, "PUT /", "/", "PUT")
        self.assert_refused(405, "POST /news", "/news", "POST")

    def test_wrong_numbers(self):
        z = "z=0"
        for part, path, query in (
                ("frame 20; accepted: 0 to 19", "/frame", {"number": 20, "plane": z}),
                ("number '-1'", "/frame", {"number": -1, "plane": z}),
                ("number ''", "/frame", {"plane": z}),
                ("number '1e9'", "/frame", {"number": "1e9", "plane": z}),
                ("plane 'z=1'; accepted: z=0 to z=0", "/frame", {"number": 1, "plane": "z=1"}),
                ("plane ''", "/frame", {"number": 1}),
                ("place 5; accepted: 0 to 4", "/path", {"place": 5, "plane": z, "first": 0}),
                ("'positions' doesn't exist", "/positions", {"plane": z}),
                ("frames 'all'", "/news", {"frames": "all", "samples": 0})):
            with self.subTest(part):
                self.assert_refused(400, part, path, **query)

    def test_nothing_to_steer(self):
        self.assert_refused(403, "started no run", "/steer", "POST", action="stop")

    def test_headers(self):
        answer = self.page.ask("/")
        policy = answer.headers["Content-Security-Policy"]
        self.assertIn("default-src 'self'", policy)
        self.assertIn("frame-ancestors 'none'", policy)
        for word in ("<style", "style=", "onclick", "https://"):
            self.assertNotIn(word, answer.text)

    def test_it_listens_on_this_machine_alone(self):
        port = f"{self.page.port:04X}"
        sockets = pathlib.Path("/proc/net/tcp").read_text().splitlines()
        listening = [line.split()[1] for line in sockets if f":{port} 00000000:0000 0A" in line]
        self.assertEqual(listening, [f"0100007F:{port}"])


class Start(ScriptTest):
    def assert_no_page(self, part, *arguments):
        page = Page(self, *arguments)
        page.process.wait(timeout=20)
        code, output, errors = page.close()
        self.assertEqual((code, output), (2, ""), errors)
        self.assertIn(part, errors)
        self.assertEqual(errors.count("\n"), 1, errors)

    def test_wrong_files(self):
        self.assert_no_page("none.h5: there is no such file", "none.h5")
        self.assert_no_page(f"{self.folder}: it is a folder; accepted: a file", self.folder)
        self.assert_no_page("text.h5: cannot be read", self.text_file())
        h5py.File(self.folder / "other.h5", "w").close()
        self.assert_no_page("not a trajectory: it has no spins", "other.h5")
        chain = write(self.folder / "chain.h5")
        port = Page(self, chain).port
        self.assert_no_page(f"cayspin: --port {port}: Address already in use", "--port", port, chain)
        os.truncate(chain, chain.stat().st_size // 2)
        self.assert_no_page("chain.h5: cannot be read", chain)
        # As after a power cut.
        (self.folder / "chain.h5.journal").touch()
        self.assert_no_page(f"; accepted: `cayspin info {chain}` first", chain)

    def test_wrong_scenes(self):
        self.assert_no_page("none.toml: cannot be read", "none.toml")
        scene = self.folder / "scene.toml"
        scene.write_text(LONG_SCENE.replace("rkmk4", "rkmk44"))
        self.assert_no_page("scene.toml:13: integrator.method", scene)
        scene.write_text(LONG_SCENE.replace('file = "long.h5"', ""))
        self.assert_no_page("output.file: no file to write to", scene)
        scene.write_text(LONG_SCENE + "[ensemble]\nreplicas = 4\n")
        self.assert_no_page("scene.toml: a page shows one run", scene)
        self.assertFalse((self.folder / "long.h5").exists())
        scene.write_text(LONG_SCENE)
        (self.folder / "long.h5").write_text("mine\n")
        self.assert_no_page("it exists", scene)
        self.assertEqual((self.folder / "long.h5").read_text(), "mine\n")

    def test_wrong_options(self):
        self.assert_no_page("cayspin: --port x: no port; accepted: 0 (a free one) to 65535\n",
                            "--port", "x", "a.h5")
        self.assert_no_page("cayspin: unrecognized arguments: --none (see cayspin view --help)\n",
                            "--none", "a.h5")

    def test_a_chosen_port_through_a_link(self):
        link = self.folder / "cayspin-view"
        link.symlink_to(SCRIPTS / "view_texture.py")
        result = subprocess.run([sys.executable, "-B", link, "--help"], capture_output=True,
                                text=True)
        self.assertIn("usage: cayspin view", result.stdout)
        port = Page(self, write(self.folder / "chain.h5")).port  # free again once it is closed
        self.doCleanups()
        self.setUp()
        self.assertEqual(Page(self, "--port", port, write(self.folder / "a.h5")).port, port)


class Data(ScriptTest):
    def test_a_film(self):
        file, spins = self.film()
        page = Page(self, file)
        news = page.news()
        self.assertEqual((news["state"], news["frames"], news["run"]), ("complete", 20, None))
        self.assertEqual(news["about"] | {"scene": ""}, {
            "name": "film.h5", "scene": "", "extents": [10, 8, 1], "si": False,
            "spacing": [1, 1, 1], "crystal": False, "normal": 2, "plane": 0})
        np.testing.assert_allclose(news["times"], 0.1 * np.arange(20), atol=1e-12)
        with h5py.File(file) as data:
            scalars = data["scalars"]
            np.testing.assert_array_equal(news["rows"], np.column_stack(
                [scalars["time"], scalars["energy"], scalars["magnetization"]]))
        self.assertEqual(page.news(19, 18)["rows"], news["rows"][18:])
        self.assertEqual(page.news(19, 18)["times"], news["times"][19:])
        for frame in (0, 7):
            body = page.ask("/frame", number=frame, plane="z=0").body
            np.testing.assert_array_equal(np.frombuffer(body, np.int8).reshape(8, 10, 3),
                                          127 * spins[frame, 0])
        body = page.ask("/path", place=34, plane="z=0", first=2).body
        np.testing.assert_array_equal(np.frombuffer(body, "<f4").reshape(18, 3), spins[2:, 0, 3, 4])

    def test_planes_of_a_box_and_lengths(self):
        spins = np.random.default_rng(1).normal(size=(20, 3, 4, 5, 3))
        file = write(self.folder / "box.h5")
        self.replace_spins(file, spins)
        page = Page(self, file)
        self.assertEqual(page.news()["about"]["normal"], 2)
        unit = spins / np.linalg.norm(spins, axis=-1, keepdims=True)
        for plane, those, axes in (("z=1", unit[7, 1], [0, 1, 2]),
                                   ("y=3", unit[7, :, 3], [0, 2, 1]),
                                   ("x=0", unit[7, :, :, 0], [1, 2, 0])):
            body = page.ask("/frame", number=7, plane=plane).body
            shown = np.frombuffer(body, np.int8).reshape(those.shape).astype(float)
            shown /= np.linalg.norm(shown, axis=-1, keepdims=True)
            self.assertLess(abs(shown - those[..., axes]).max(), 0.006, plane)
        body = page.ask("/path", place=7, plane="y=3", first=0).body  # row 1, column 2
        np.testing.assert_allclose(np.frombuffer(body, "<f4").reshape(20, 3), spins[:, 1, 3, 2],
                                   rtol=1e-6)

    def test_a_crystal(self):
        file = write(self.folder / "crystal.h5", cell_sites=2)
        answer = Page(self, file).ask("/news", frames=0, samples=0)
        self.assertEqual(answer.status, 400)
        self.assertIn("have no positions", answer.text)
        positions = np.arange(30.0).reshape(2, 1, 1, 5, 3)
        with h5py.File(file, "r+") as data:
            data["positions"] = positions
            spins = data["spins"][3]
        page = Page(self, file)
        self.assertTrue(page.news()["about"]["crystal"])
        body = page.ask("/positions", plane="z=0").body
        np.testing.assert_array_equal(np.frombuffer(body, "<f4"), positions.ravel())
        shown = np.frombuffer(page.ask("/frame", number=3, plane="z=0").body, np.int8)
        np.testing.assert_allclose(shown, 127 * (spins / abs(spins).max(-1, keepdims=True)).ravel(),
                                   atol=0.51)

    def test_a_damaged_frame(self):
        file = write(self.folder / "chain.h5")
        with h5py.File(file, "r+") as data:
            data["spins"][4, 0, 0, 2, 1] += 1
        page = Page(self, file)
        self.assertEqual(page.ask("/frame", number=3, plane="z=0").status, 200)
        answer = page.ask("/frame", number=4, plane="z=0")
        self.assertEqual(answer.status, 400)
        self.assertIn("chain.h5: frame 4 is damaged", answer.text)

    def test_a_file_that_grows(self):
        file = write(self.folder / "chain.h5")
        with h5py.File(file, "r+") as data:
            data.attrs["complete"] = 0
            data.attrs["wall_seconds"] = 0.0
            data.flush()
            page = Page(self, file)
            self.assertEqual((page.news()["state"], page.news()["frames"]), ("under way", 20))
            for group in (data, data["scalars"]):
                for dataset in group.values():
                    if isinstance(dataset, h5py.Dataset):
                        dataset.resize(21, axis=0)
                        dataset[20] = dataset[19]
                group["time"][20] = 2.5
            numbers = [data[name][20] for name in ("time", "energy", "norm_defect")]
            data["checksum"][20] = checksum.of_frame(
                data["step"][20], [*numbers, *data["magnetization"][20]], data["spins"][20])
            data.flush()
            # At first the new frame may be half written, so it is not sent.
            self.assertEqual(page.news(20, 20)["times"], [])
            news = page.news(20, 20)
            self.assertEqual((news["times"], len(news["rows"])), ([2.5], 1))
            self.assertEqual(page.ask("/frame", number=20, plane="z=0").status, 200)
            data.attrs["complete"] = 1
            data.flush()
            self.assertEqual(page.news(21, 21)["state"], "complete")
        before = file.stat().st_mtime_ns
        page.news()
        self.assertEqual(file.stat().st_mtime_ns, before)
        file.unlink()
        answer = page.ask("/news", frames=0, samples=0)
        self.assertEqual(answer.status, 400)
        self.assertIn("cannot be read", answer.text)

    def test_a_run_that_was_killed(self):
        file = write(self.folder / "chain.h5")
        with h5py.File(file, "r+") as data:
            data.attrs["complete"] = 0
            data.attrs["wall_seconds"] = 0.0
        os.utime(file, (time.time() - 60,) * 2)
        self.assertEqual(Page(self, file).news()["state"], "ended early")


class Steering(ScriptTest):
    def test_a_run(self):
        (self.folder / "scene.toml").write_text(LONG_SCENE)
        page = Page(self, "scene.toml")
        run, = pathlib.Path(f"/proc/{page.process.pid}/task/{page.process.pid}/children"
                            ).read_text().split()

        def wait(what):
            end = time.monotonic() + 20
            while not what():
                self.assertLess(time.monotonic(), end)
                time.sleep(0.05)

        def steer(action, state):
            self.assertEqual(page.ask("/steer", "POST", {"Origin": f"http://{page.host}"},
                                      action=action).status, 200)
            self.assertEqual(page.news()["run"], state)

        self.assertEqual(page.news()["run"], "running")
        wait(lambda: page.news()["frames"] > 2)
        steer("pause", "paused")
        wait(lambda: state_of(run) == "T")
        page.news()
        frames = page.news()["frames"]
        time.sleep(0.5)
        self.assertEqual(page.news()["frames"], frames)
        steer("resume", "running")
        wait(lambda: page.news()["frames"] > frames)
        answer = page.ask("/steer", "POST", action="kill")
        self.assertEqual((answer.status, answer.text), (
            400, "action 'kill': unknown; accepted: pause, resume, stop\n"))
        steer("pause", "paused")
        self.assertEqual(page.ask("/steer", "POST", action="stop").status, 200)
        wait(lambda: page.news()["run"] == "ended")
        self.assertEqual(page.news()["state"], "ended early")
        self.assertIn("interrupted", page.news()["message"])

    def test_a_second_stop_does_not_kill_the_run(self):
        scene = self.folder / "scene.toml"
        scene.write_text(LONG_SCENE)
        result = subprocess.run([sys.executable, "-c", STOP_TWICE, SCRIPTS / "cayspin", scene],
                                capture_output=True, text=True)
        self.assertEqual((result.stdout, result.stderr), ("SIGINT SIGCONT SIGCONT\n", ""))

    def test_the_page_takes_its_run_along(self):
        (self.folder / "scene.toml").write_text(LONG_SCENE)
        page = Page(self, "scene.toml")
        page.ask("/steer", "POST", action="pause")
        self.assertEqual(page.close()[0], 0)
        with h5py.File(self.folder / "long.h5") as data:  # no run writes it any more
            self.assertEqual(data.attrs["complete"], 0)
            self.assertGreater(data.attrs["wall_seconds"], 0)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]])
