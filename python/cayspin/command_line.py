# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Command lines of scripts. A wrong one ends the script like the program cayspin, with a one-line
message and status 2."""

from __future__ import annotations

import argparse
import os
from typing import Callable


class Parser(argparse.ArgumentParser):
    """An ArgumentParser that prints no usage before its errors."""

    def error(self, message: str):
        message = " ".join(message.split())
        if message.startswith("argument "):
            message = message.removeprefix("argument ").replace(": ", " ", 1)
        hint = "" if "accepted: " in message else f" (see {self.prog} --help)"
        self.exit(2, f"{self.prog.split()[0]}: {message}{hint}\n")


def whole(text: str) -> int:
    """A whole number."""
    try:
        return int(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text}: accepted: a whole number") from None


def real(text: str) -> float:
    """A number."""
    try:
        return float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text}: accepted: a number") from None


def frame(text: str) -> int:
    """Returns the number of a frame, which is -1 for "last"."""
    try:
        return -1 if text == "last" else int(text)
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"{text}: accepted: last or a whole number; from the end: -1") from None


def one_of(*words: str) -> Callable[[str], str]:
    """Returns a type for an argument that must be one of these words."""
    def chosen(text):
        if text not in words:
            raise argparse.ArgumentTypeError(f"{text}: accepted: {', '.join(words)}")
        return text
    return chosen


def require_file(path: str | os.PathLike) -> None:
    """Raises ValueError unless there is a file of this name."""
    if not os.path.isfile(path):
        there = ("it is a folder" if os.path.isdir(path) else
                 "it is not a regular file" if os.path.exists(path) else "there is no such file")
        raise ValueError(f"{there}; accepted: a file that cayspin wrote")


def what_can_be_read(path: str | os.PathLike) -> str:
    """Returns the end of a message about a file that cannot be read. After a power cut, `cayspin
    info` completes a file from its journal."""
    if os.path.exists(f"{path}.journal"):
        return f"; accepted: `cayspin info {path}` first, which completes the file from its journal"
    return "; accepted: a file that cayspin wrote"
