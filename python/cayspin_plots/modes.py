# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""The modes in a file of `cayspin modes`: their spectrum, amplitudes and phases, frames of one
moving mode, or bands along a path."""

import math

import matplotlib
import numpy as np

from . import style

MOST_MODES = 16
FRAMES = 40  # in a period
TURN = 0.5  # radians: the largest angle by which a moving mode turns a spin
ATTRIBUTE = "cayspin_modes_format"


def is_modes(file):
    return ATTRIBUTE in file.attrs


def draw(file):
    return _draw_bands(file) if "wave_vector" in file else _draw_modes(file)


def _title(file, mode):
    frequency, decay = file["frequency"][mode], file["decay"][mode]
    if file.attrs["units"] == "SI":
        return f"{mode}: {1e-9 * frequency:.5g} GHz, {1e-9 * decay:.3g} /ns"
    return f"{mode}: {frequency:.5g}, decay {decay:.3g}"


def _component(shape):
    """Returns the component of vectors (ny, nx, 3) with the largest amplitude, scaled to a maximum
    of 1, and its name."""
    largest = int((np.abs(shape)**2).sum(axis=(0, 1)).argmax())
    component = shape[..., largest]
    return component / max(np.abs(component).max(), 1e-300), "xyz"[largest]


def _plane(file, mode):
    """The middle plane of a mode, (ny, nx, 3); for crystals, of the first site of the cells."""
    parts = file["mode"][mode]
    if parts.ndim == 6:
        parts = parts[0]
    plane = parts[parts.shape[0] // 2]
    return plane[..., 0] + 1j * plane[..., 1]


def moving(file, mode, frame, texture):
    """One frame of a moving mode, as a texture."""
    if "mode" not in file:
        raise ValueError("waves have no shapes; accepted: a file of modes, for --movie")
    count = len(file["mode"])
    if not -count <= mode < count:
        raise ValueError(f"frame {mode}; accepted: {-count} to {count - 1}, the modes")
    mode %= count
    texture.require_rectangular(file.attrs["scene"])
    spacing, boundary, si = texture.lattice_of(file.attrs["scene"])
    phase = 2 * np.pi * frame / FRAMES
    parts = file["mode"][mode]
    turn = TURN * (np.cos(phase) * parts[..., 0] - np.sin(phase) * parts[..., 1])
    angle = np.linalg.norm(turn, axis=-1, keepdims=True)
    spins = np.cos(angle) * file["spins"][:] + np.sinc(angle / np.pi) * turn
    return texture.Texture(spins, spacing, boundary, None, si, f"mode {_title(file, mode)}")


def together(places, extent):
    """Groups points (n, 2) whose labels would overlap, as lists of their numbers. `extent`: the
    lengths that the picture shows along x and y."""
    groups = []
    for number, place in enumerate(places / extent):
        for group in groups:
            if (np.abs(place - places[group[0]] / extent) < (0.03, 0.06)).all():
                group.append(number)
                break
        else:
            groups.append([number])
    return groups


def _draw_spectrum(file, axis):
    """Draws each mode as a point at its frequency and decay, with its number."""
    si = file.attrs["units"] == "SI"
    scale = 1e-9 if si else 1
    frequency, decay = scale * file["frequency"][:], scale * file["decay"][:]
    axis.plot(frequency, decay, "o", color=style.BLUE)
    axis.margins(y=0.25)
    if np.ptp(decay) < 1e-6 * np.abs(frequency).max():  # round-off
        axis.set_ylim(decay.mean() + np.array([-1, 1]) * max(np.abs(decay).max(), 1e-3))
    places = np.column_stack([frequency, decay])
    extent = np.abs(np.diff([axis.get_xlim(), axis.get_ylim()], axis=1)).ravel()
    for group in together(places, extent):
        axis.annotate(", ".join(map(str, group)), places[group].mean(axis=0), xytext=(0, 5),
                      textcoords="offset points", ha="center")
    axis.set_xlabel("frequency (GHz)" if si else "angular frequency")
    axis.set_ylabel("decay (1/ns)" if si else "decay")


def _draw_modes(file):
    count = min(file["mode"].shape[0], MOST_MODES)
    if count == 0:
        raise ValueError("it has no mode")
    columns = min(3, count)
    rows = math.ceil(count / columns)
    figure = style.plt.figure(figsize=(0.5 + 3.6 * columns, 3.2 + 3.4 * rows),
                              constrained_layout=True)
    above, below = figure.subfigures(2, 1, height_ratios=[2.6, 0.6 + 3.4 * rows])
    _draw_spectrum(file, above.subplots())
    axes = below.subplots(rows, columns, squeeze=False)
    for mode, axis in enumerate(axes.flat):
        if mode >= count:
            axis.set_axis_off()
            continue
        wave, name = _component(_plane(file, mode))
        axis.set_title(f"{_title(file, mode)}, $m_{name}$")
        if 1 in wave.shape:
            line = wave.ravel()
            axis.plot(line.real, color=style.BLUE, label="real")
            axis.plot(line.imag, color=style.RED, label="imaginary")
            continue
        hue = np.angle(wave) / (2 * np.pi) % 1
        colors = matplotlib.colors.hsv_to_rgb(
            np.stack([hue, np.full(hue.shape, 0.85), np.abs(wave)], axis=-1)).clip(0, 1)
        axis.imshow(colors, origin="lower", interpolation="nearest")
        axis.grid(False)
        axis.set_xticks([])
        axis.set_yticks([])
    below.suptitle("modes: brightness is the amplitude, colour the phase", x=0.01, ha="left")
    return figure


def _draw_bands(file):
    si = file.attrs["units"] == "SI"
    waves, frequency = file["wave_vector"][:], (1e-9 if si else 1) * file["frequency"][:]
    steps = np.linalg.norm(np.diff(waves, axis=0), axis=1)
    along = np.concatenate([[0], np.cumsum(steps)])
    figure, axis = style.plt.subplots(figsize=(7, 4.5), constrained_layout=True)
    axis.plot(along, frequency, color=style.BLUE, marker="" if len(along) > 1 else "o")
    turns = [0, len(waves) - 1]
    if len(waves) > 2:
        bends = np.linalg.norm(np.diff(waves, 2, axis=0), axis=1)
        turns += [i + 1 for i in np.nonzero(bends > 1e-6 * steps.max())[0]]
    turns = sorted(set(turns))
    axis.set_xticks(along[turns], ["(" + ", ".join(f"{k:.3g}" for k in waves[i]) + ")"
                                   for i in turns])
    axis.set_xlabel("wave vector, cycles per cell")
    axis.set_ylabel("frequency (GHz)" if si else "angular frequency")
    axis.set_ylim(bottom=min(0, frequency.min()))
    return figure
