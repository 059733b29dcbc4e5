# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""One look for every picture; nothing is shown on a display."""

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


def save(figure, path):
    try:
        figure.savefig(path)
    except (OSError, ValueError) as error:
        raise SystemExit(f"{path}: cannot write the picture: {error}") from None
    print(path)
