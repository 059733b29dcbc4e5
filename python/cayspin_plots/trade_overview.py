# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Which method to use: scenes as rows, errors as columns."""

import math

import numpy as np

from cayspin_plots import style
from cayspin_plots.trade_costs import ERRORS, gain, scene_name

SLOWEST, FASTEST = 0.5, 8  # where colours end
CHARACTERS = 21  # of full size that fit into a column


def draw(trades, path):
    gains = [[gain(trade, error) for error in ERRORS] for trade in trades]
    shares = np.array([[math.nan if found is None else np.log(np.clip(found[0], SLOWEST, FASTEST))
                        for found in row] for row in gains])
    figure, axis = style.plt.subplots(figsize=(9, 1.2 + 0.42 * len(trades)),
                                      constrained_layout=True)
    colors = style.plt.get_cmap("PuOr_r").copy()
    colors.set_bad("#eeeeee")
    axis.imshow(shares, cmap=colors, aspect="auto", vmin=-math.log(FASTEST),
                vmax=math.log(FASTEST))
    for i, row in enumerate(gains):
        for j, found in enumerate(row):
            text = "-" if found is None else (f"{found[1]}  " + (
                "alone" if math.isinf(found[0]) else f"{found[0]:.2f}"))
            size = min(8.5, 8.5 * CHARACTERS / len(text))
            deep = found is not None and found[0] > 4
            axis.text(j, i, text, ha="center", va="center", fontsize=size,
                      color="white" if deep else style.INK)
    axis.set_xticks(range(len(ERRORS)), [f"{error:.0e}" for error in ERRORS])
    axis.set_yticks(range(len(trades)), [scene_name(trade) for trade in trades])
    axis.tick_params(length=0)
    axis.grid(False)
    axis.set_xlabel("largest error of any spin")
    axis.set_title("The fastest method, and its speed over that of the best baseline\n"
                   "(RK4, RK5, Heun or Dormand-Prince 5; orange: faster, grey: slower)")
    style.save(figure, path)
