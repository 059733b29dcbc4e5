# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Shared code of the tests of `cayspin view`: TEST.py FOLDER_OF_SCRIPTS WRITER PROGRAM."""

import http.client
import json
import os
import subprocess
import sys
import urllib.parse

from script_test import SCRIPTS

PROGRAM = sys.argv[3]

LONG_SCENE = """
[system]
kind = "llg"
damping = 0.1
[lattice]
shape = [24, 16]
[field]
exchange = 1.0
applied = [0, 0, 1]
[initial]
random = { seed = 1 }
[integrator]
method = "rkmk4"
dt = 0.01
steps = 100000000
[output]
file = "long.h5"
every = 20000
"""


class Answer:
    def __init__(self, response):
        self.status, self.headers, self.body = response.status, response.headers, response.read()

    @property
    def text(self):
        return self.body.decode()


class Page:
    """A page that the script serves."""

    def __init__(self, test, *arguments, cwd=None):
        self.process = subprocess.Popen(
            [sys.executable, "-B", SCRIPTS / "view_texture.py", "--no-browser",
             *map(str, arguments)], cwd=cwd or test.folder, env={**os.environ,
                                                                "CAYSPIN_PROGRAM": PROGRAM},
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        test.addCleanup(self.close)
        self.address = self.process.stdout.readline().strip()
        parts = urllib.parse.urlsplit(self.address)
        self.host, self.port = parts.netloc, parts.port
        self.token = urllib.parse.parse_qs(parts.query).get("token", [""])[0]

    def ask(self, path, method="GET", headers=None, **query):
        """Returns the answer to a request for a path, which is not quoted. Adds the token unless
        `query` has one."""
        query = urllib.parse.urlencode({"token": self.token, **query})
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=20)
        try:
            connection.request(method, f"{path}?{query}", headers=headers or {})
            return Answer(connection.getresponse())
        finally:
            connection.close()

    def news(self, frames=0, samples=0):
        return json.loads(self.ask("/news", frames=frames, samples=samples).text)

    def close(self):
        self.process.terminate()
        output, errors = self.process.communicate(timeout=20)
        return self.process.returncode, output, errors
