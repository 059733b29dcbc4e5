# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Images of the components of the spins, over time and position along x."""

import numpy as np


def draw_components(axes, trajectory):
    """Fills three axes with m_x, m_y, m_z of the first row (y = z = 0) over time and position."""
    row = trajectory.spins[:, 0, 0]
    sites = row.shape[1]
    time = trajectory.in_time_unit(trajectory.time)
    time = np.append(time, time[-1])
    if len(time) > 2:
        time[-1] += time[-2] - time[-3]
    else:
        time[-1] += 1
    for component, (axis, name) in enumerate(zip(axes, "xyz")):
        limit = _limit(row[:, :, component])
        image = axis.pcolormesh(
            time,
            np.arange(sites + 1) - 0.5,
            row[:, :, component].T,
            cmap="RdBu_r",
            vmin=-limit,
            vmax=limit,
            rasterized=True,
        )
        axis.grid(False)
        axis.set_title(f"$m_{name}$ along x")
        axis.set_ylabel("site")
        axis.set_xlabel(trajectory.time_label())
        axis.figure.colorbar(image, ax=axis, pad=0.02, ticks=[-limit, 0, limit], format="%.2g")


def _limit(component):
    """Returns the largest magnitude, or 1 if that is only round-off, which needs no scale of its
    own."""
    largest = float(np.abs(component).max())
    return largest if largest > 1e-9 else 1.0
