# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""A file of `cayspin path`: its energy along the path, and pictures of some of its images."""

import numpy as np

from . import style

ATTRIBUTE = "path_format"
MOST_PICTURES = 6


def is_path(file):
    return ATTRIBUTE in file.attrs


def number_of(file, image):
    """The number of an image, counted from 0. Negative numbers count from the end."""
    count = len(file["spins"])
    if not -count <= image < count:
        raise ValueError(f"frame {image}; accepted: {-count} to {count - 1}, the images of the path")
    return image % count


def texture_of(file, image, before, texture):
    """An image of a path as a texture, and the spins of the image `before`."""
    texture.require_rectangular(file.attrs["scene"])
    spacing, boundary, si = texture.lattice_of(file.attrs["scene"])
    number = number_of(file, image)
    title, other = f"image {number}", None
    if before is not None:
        before = number_of(file, before)
        other, title = file["spins"][before], f"{title}, difference from image {before}"
    return texture.Texture(file["spins"][number], spacing, boundary, None, si, title), other


def _smooth(distance, energy):
    """Returns points of a piecewise cubic through the images. The curve is flat at the images that
    are extrema, and has no other extrema."""
    step = np.diff(distance)
    rise = np.diff(energy) / step
    slope = np.zeros(len(energy))
    same = rise[1:] * rise[:-1] > 0
    slope[1:-1][same] = 2 / (1 / rise[1:][same] + 1 / rise[:-1][same])
    s = np.linspace(0, 1, 20, endpoint=False)[None]
    h, a, b = step[:, None], energy[:-1, None], energy[1:, None]
    first, last = slope[:-1, None], slope[1:, None]
    y = (a * (1 + 2 * s) * (1 - s)**2 + b * s**2 * (3 - 2 * s) +
         h * s * (1 - s) * (first * (1 - s) - last * s))
    return (np.append((distance[:-1, None] + h * s).ravel(), distance[-1]),
            np.append(y.ravel(), energy[-1]))


def _has_pictures(file, texture):
    *_, nz, ny, nx, _ = file["spins"].shape
    try:
        texture.require_rectangular(file.attrs["scene"])
    except ValueError:
        return False
    return file["spins"].ndim == 5 and nx * ny * nz > 1


def _pictures(file):
    """The images to draw: both ends, the saddles and some images between."""
    last = len(file["spins"]) - 1
    chosen = [0, last]
    if "saddles" in file:
        chosen += [int(image) for image in file["saddles/image"][:MOST_PICTURES - 2]]
    for image in np.linspace(0, last, MOST_PICTURES).round().astype(int):
        if len(set(chosen)) < min(MOST_PICTURES, last + 1):
            chosen.append(int(image))
    return sorted(set(chosen))


def draw(file, texture, colors):
    si = file.attrs["units"] == "SI"
    distance, energy = file["distance"][:], file["energy"][:]
    pictures = _pictures(file) if _has_pictures(file, texture) else []
    figure = style.plt.figure(figsize=(9, 6.4 if pictures else 4.2), constrained_layout=True)
    rows = figure.add_gridspec(2 if pictures else 1, 1, height_ratios=[2, 1][:2 if pictures else 1])
    axis = figure.add_subplot(rows[0])
    above = energy - energy[0]
    axis.plot(*_smooth(distance, above), color=style.BLUE)
    axis.plot(distance, above, "o", color=style.BLUE, label="images")
    if "saddles" in file:
        images = file["saddles/image"][:]
        axis.plot(distance[images], above[images], "o", color=style.RED, label="saddles")
        barriers = file.attrs["barrier_forward"], file.attrs["barrier_backward"]
        unit = " J" if si else ""
        axis.set_title("barriers {:.6g}{unit} forward, {:.6g}{unit} backward".format(
            *barriers, unit=unit))
    axis.legend()
    axis.set_xlabel("distance, rad")
    axis.set_ylabel("energy above the start" + (" (J)" if si else ""))
    if pictures:
        cells = rows[1].subgridspec(1, len(pictures))
        for cell, image in zip(cells, pictures):
            shown, _ = texture_of(file, image, None, texture)
            below = figure.add_subplot(cell)
            texture.draw(shown, below, colors=colors)
            below.set(xlabel="", ylabel="", xticks=[], yticks=[])
    return figure
