#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Draws the spins of a trajectory file: films and planes as colours with arrows, crystals by their
sites, chains as lines; as a picture of one frame or a movie of all."""

import argparse
import pathlib
import sys

MOVIES = {".mp4": ("ffmpeg",), ".gif": ("pillow", "ffmpeg")}


def parse_arguments():
    parser = argparse.ArgumentParser(prog="cayspin plot", description=__doc__)
    parser.add_argument("file", type=pathlib.Path, metavar="FILE.h5")
    parser.add_argument("-o", "--output", type=pathlib.Path, metavar="PICTURE",
                        help="its ending chooses the kind, .png, .svg or .pdf "
                             "(default: FILE_texture.png)")
    parser.add_argument("--frame", type=int, default=-1,
                        help="counted from 0, or from the end: -1 (default: the last)")
    parser.add_argument("--plane", metavar="z=0",
                        help="an axis and the number of a plane (default: the middle one across "
                             "the axis of fewest cells)")
    parser.add_argument("--colors", choices=("hue", "safe"), default="hue",
                        help="hue: the angle in the plane; safe: the component along its normal, "
                             "from blue to red (default: hue)")
    what = parser.add_mutually_exclusive_group()
    what.add_argument("--difference", type=int, metavar="FRAME",
                      help="draw |difference| to this frame")
    what.add_argument("--charge", action="store_true",
                      help="draw the topological charge of each cell of a film")
    parser.add_argument("--movie", type=pathlib.Path, metavar="MOVIE",
                        help="all frames, .mp4 (by ffmpeg) or .gif, in place of a picture")
    parser.add_argument("--fps", type=float, default=20, help="frames in a second (default: 20)")
    return parser.parse_args()


def import_libraries():
    """After --help, which needs none of them."""
    global checksum, h5py, style, texture
    import h5py
    from cayspin_plots import style

    import texture  # of python/cayspin, which cayspin_plots has put on the path
    from texture import checksum


def movie_writer(path, fps):
    from matplotlib import animation

    if path.suffix not in MOVIES:
        raise SystemExit(f"{path}: accepted: a movie that ends in {' or '.join(MOVIES)}")
    found = [name for name in MOVIES[path.suffix] if animation.writers.is_available(name)]
    if not found:
        raise SystemExit(f"{path}: matplotlib finds no {MOVIES[path.suffix][0]}; accepted: one on "
                         "the PATH" + (", or a movie that ends in .gif" * (path.suffix == ".mp4")))
    if not 0 < fps < 1000:
        raise SystemExit(f"--fps {fps:g}; accepted: a number > 0")
    return animation.writers[found[0]](fps=fps)


def read(file, arguments, frame):
    """A frame and the options to draw it with."""
    shown, before = texture.of_file(file, frame, arguments.difference)
    checksum.require_undamaged(file, texture.frame_number(file, frame), shown.spins[None])
    if before is not None:
        checksum.require_undamaged(file, texture.frame_number(file, arguments.difference),
                                   before[None])
    return shown, {"plane": arguments.plane, "before": before,
                   "quantity": "charge" if arguments.charge else "spins"}


def draw_movie(file, arguments):
    path, writer = arguments.movie, movie_writer(arguments.movie, arguments.fps)
    frames = range(texture.frame_number(file, -1) + 1)
    limit = None
    if arguments.charge or arguments.difference is not None:
        limit = max(texture.largest(shown, **options) for shown, options in (
            read(file, arguments, frame) for frame in frames))
    shown, options = read(file, arguments, 0)
    axes = texture.draw(shown, colors=arguments.colors, limit=limit, **options)
    figure, place = axes.figure, axes.get_position(original=True)
    with writer.saving(figure, str(path), dpi=100):
        for frame in frames:
            shown, options = read(file, arguments, frame)
            figure.clear()
            texture.draw(shown, figure.add_axes(place, anchor="NW"), colors=arguments.colors,
                         limit=limit, key=True, **options)
            writer.grab_frame()
    print(path)


def run(arguments):
    if not arguments.file.is_file():
        raise ValueError("there is no such file; accepted: a file that cayspin wrote")
    try:
        file = h5py.File(arguments.file, "r")
    except OSError as error:
        raise ValueError(f"cannot be opened: {' '.join(str(error).split())}; accepted: a "
                         "file that cayspin wrote") from None
    with file:
        if arguments.movie:
            draw_movie(file, arguments)
            return
        shown, options = read(file, arguments, arguments.frame)
        axes = texture.draw(shown, colors=arguments.colors, **options)
    output = arguments.output or arguments.file.with_name(f"{arguments.file.stem}_texture.png")
    style.save(axes.figure, output)


def main():
    arguments = parse_arguments()
    try:
        import_libraries()
        run(arguments)
    except ImportError as error:
        message = (f"cayspin plot: {sys.executable} has no {error.name}; accepted: a Python with "
                   "h5py and matplotlib in CAYSPIN_PYTHON")
    except (OSError, KeyError, TypeError, ValueError) as error:
        message = f"{arguments.file}: {error.args[-1]}"
    except SystemExit as error:
        message = error.code
    else:
        return
    print(message, file=sys.stderr)
    sys.exit(2)


if __name__ == "__main__":
    main()
