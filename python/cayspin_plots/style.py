# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Gives all pictures one look. Nothing is shown on a display."""

import contextlib
import os
import pathlib
import shutil
import subprocess

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt  # noqa: E402  the backend has to be chosen before

INK = "#22262b"
GREY = "#8b9199"
BLUE = "#1b5fa7"
RED = "#cf3f2b"
COMPONENTS = ("#cf3f2b", "#2f8f5b", "#1b5fa7")  # x, y, z

plt.rcParams.update(
    {
        "figure.dpi": 100,
        "savefig.dpi": 160,
        "savefig.facecolor": "white",
        "font.size": 11,
        "text.color": INK,
        "axes.labelcolor": INK,
        "axes.edgecolor": GREY,
        "axes.titlesize": 12,
        "axes.titlelocation": "left",
        "axes.titlepad": 8,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "axes.grid": True,
        "grid.color": "#e4e7ea",
        "grid.linewidth": 0.8,
        "axes.axisbelow": True,
        "xtick.color": INK,
        "ytick.color": INK,
        "legend.frameon": False,
    }
)


def _reason(error):
    if isinstance(error, subprocess.CalledProcessError):  # of ffmpeg
        lines = str(error.stderr or "").strip().splitlines()
        return lines[0] if lines else f"{error.cmd[0]} ended with status {error.returncode}"
    return getattr(error, "strerror", None) or " ".join(str(error).split())


@contextlib.contextmanager
def replacing(path, what):
    """Yields the name of a new file, which replaces `path` at the end of the `with`."""
    target = pathlib.Path(os.path.realpath(path))
    is_device = target.exists() and not target.is_file()
    written = target if is_device else target.with_name(f".cayspin{os.getpid()}{target.suffix}")
    try:
        yield written
        if not is_device:
            if target.exists():
                shutil.copymode(target, written)
            written.replace(target)
    except (OSError, ValueError, subprocess.CalledProcessError) as error:
        raise SystemExit(f"{path}: cannot write the {what}: {_reason(error)}") from None
    finally:
        if not is_device:
            with contextlib.suppress(OSError):
                written.unlink()


def save(figure, path):
    path = pathlib.Path(path)
    if not path.suffix:
        path = path.with_name(f"{path.name.rstrip('.')}.png")
    with replacing(path, "picture") as written:
        figure.savefig(written)
    print(path)
