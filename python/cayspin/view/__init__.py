# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""A page in the browser that shows the spins of a trajectory file, also while a run writes it."""

from __future__ import annotations

import atexit
import os
import select
import signal
import subprocess
import sys
import tempfile

from cayspin.processes import environment


LONGEST_START = 600  # seconds: for a scene the run starts first, which may take minutes
LONGEST_END = 90  # seconds: longer than the server waits for its run


class View:
    """Result of view(): a page, which a notebook shows in its output. A separate process serves it,
    because HDF5 does not support several threads."""

    def __init__(self, path: str | os.PathLike):
        from cayspin import arguments
        from cayspin._cayspin import CayspinError
        from cayspin.trade import program

        command = [sys.executable, "-m", "cayspin.view", "--no-browser", "--in-notebook", "--",
                   arguments.file_name(path, "view")]
        with tempfile.TemporaryFile("w+") as messages:
            self._server = subprocess.Popen(
                command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=messages, text=True,
                env=environment(CAYSPIN_PROGRAM=program()), start_new_session=True)
            self.address: str = ""  #: for any browser on this machine
            try:
                if not select.select([self._server.stdout], [], [], LONGEST_START)[0]:
                    raise CayspinError(f"view: the page did not start within {LONGEST_START} s")
                self.address = self._server.stdout.readline().strip()
            except BaseException:  # also that of Ctrl-C
                # While the server waits for its run, it does not look whether its input is closed.
                self._server.send_signal(signal.SIGINT)
                self.close()
                raise
            if not self.address:
                self.close()
                messages.seek(0)
                raise CayspinError(messages.read().strip().rpartition("\n")[2])
        atexit.register(self.close)

    def close(self) -> None:
        """Ends the page, and the run that it started."""
        self._server.stdin.close()
        try:
            self._server.wait(LONGEST_END)
        except subprocess.TimeoutExpired:
            self._server.kill()
            self._server.wait(LONGEST_END)
        self._server.stdout.close()
        atexit.unregister(self.close)

    def _repr_html_(self) -> str:
        return (f'<iframe src="{self.address}" title="Spins" width="100%" height="720" '
                'style="border: 0"></iframe>')


def view(path: str | os.PathLike) -> View:
    """Shows the spins of the trajectory file `path` on a page in the browser. If `path` is a scene
    file, starts its run and shows the trajectory. Needs h5py and tornado.

    Raises CayspinError for other files, and if the page does not start.
    """
    return View(path)
