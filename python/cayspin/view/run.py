# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""A run of a scene that a page starts, pauses and stops."""

from __future__ import annotations

import pathlib
import signal
import subprocess
import tempfile
import time

from ..processes import environment
from ..texture import toml


def _output_of(scene):
    """Returns the scene's output.file, or None if the scene cannot be read or has no such key.
    `cayspin run` then refuses the scene with its own message."""
    try:
        tables = toml.loads(scene.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    if "ensemble" in tables:
        raise ValueError(f"{scene}: a page shows one run; accepted: a scene without [ensemble], or "
                         "cayspin run, then cayspin plot")
    output = tables.get("output")
    name = output.get("file") if isinstance(output, dict) else None
    return pathlib.Path(name) if name and isinstance(name, str) else None


LONGEST_END = 60  # seconds that a step under way may take after a stop


class Run:
    """Starts `cayspin run SCENE` and waits for the file of the run. Raises ValueError if the run is
    refused."""

    def __init__(self, program: str, scene: pathlib.Path):
        self.output, self._paused, self._stopped = _output_of(scene), False, False
        was_there = self.output is None or self.output.exists()
        self._messages = tempfile.TemporaryFile()
        try:
            # The program has its own session, so that an interrupt from the terminal reaches it
            # only through stop().
            self._process = subprocess.Popen(
                [program, "run", scene, "--quiet"], stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL, stderr=self._messages, start_new_session=True,
                env=environment())
        except OSError as error:
            raise ValueError(f"{program}: cannot be started: {error.strerror}; accepted: the "
                             "program cayspin") from None
        try:
            while self._process.poll() is None and (was_there or not self.output.exists()):
                time.sleep(0.02)
        except BaseException:
            self.close()
            raise
        if was_there or not self.output.exists():
            raise ValueError(self.message() or f"{scene}: the run wrote no new file; accepted: a "
                                               "scene with a new output.file")

    def state(self) -> str:
        if self._process.poll() is not None:
            return "ended"
        return "paused" if self._paused else "running"

    def message(self) -> str:
        """The last line that the run wrote on standard error."""
        self._messages.seek(0)
        return self._messages.read().decode(errors="replace").strip().rpartition("\n")[2]

    def pause(self) -> None:
        self._send(signal.SIGSTOP, paused=True)

    def resume(self) -> None:
        self._send(signal.SIGCONT, paused=False)

    def stop(self) -> None:
        """Ends the run after the step under way; its file keeps what was written."""
        # A second interrupt would kill the run.
        interrupts = () if self._stopped else (signal.SIGINT,)
        self._stopped = True
        self._send(*interrupts, signal.SIGCONT, paused=False)

    def close(self) -> None:
        """Stops the run by stop() and waits for its end, or kills it after a minute. Its file keeps
        the frames."""
        if self._process.poll() is None:
            self.stop()
            try:
                self._process.wait(LONGEST_END)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait(LONGEST_END)
        self._messages.close()

    def _send(self, *signals, paused):
        for number in signals:
            self._process.send_signal(number)  # does nothing once the run has ended
        self._paused = paused
