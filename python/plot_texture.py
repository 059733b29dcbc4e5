#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Draws the spins of a trajectory file: films and planes as colours with arrows, crystals by their
sites, chains as lines; as a picture of one frame or a movie of all. For a path, draws its energy
and some of its images; for modes, their spectrum and shapes; for waves, their bands; for an
ensemble, one replica."""

import contextlib
import pathlib
import sys

from cayspin_plots import command_line

MOVIES = {".mp4": ("ffmpeg",), ".gif": ("pillow", "ffmpeg")}


def parse_arguments():
    parser = command_line.Parser(prog="cayspin plot", description=__doc__)
    parser.add_argument("file", type=pathlib.Path, metavar="FILE.h5")
    parser.add_argument("-o", "--output", type=pathlib.Path, metavar="PICTURE",
                        help="its ending chooses the kind, .png, .svg or .pdf "
                             "(default: FILE_texture.png, FILE_path.png or FILE_modes.png)")
    parser.add_argument("--frame", type=command_line.frame,
                        help="the frame, image of a path or (with --movie) mode: a number from 0, "
                             "from the end as -1, or last (default: last; for modes 0)")
    parser.add_argument("--replica", type=command_line.whole, metavar="N",
                        help="the replica of an ensemble, counted from 0, or from the end: -1 "
                             "(default: 0)")
    parser.add_argument("--plane", metavar="z=0",
                        help="an axis and the number of a plane (default: the middle one across "
                             "the axis of fewest cells)")
    parser.add_argument("--colors", type=command_line.one_of("hue", "safe"), default="hue",
                        metavar="hue|safe",
                        help="hue: the angle in the plane; safe: the component along its normal, "
                             "from blue to red (default: hue)")
    what = parser.add_mutually_exclusive_group()
    what.add_argument("--difference", type=command_line.frame, metavar="FRAME",
                      help="draw |difference| from this frame")
    what.add_argument("--charge", action="store_true",
                      help="draw the topological charge of each cell of a film")
    parser.add_argument("--movie", type=pathlib.Path, metavar="MOVIE",
                        help="all frames, images of a path, or a mode that moves, .mp4 (by ffmpeg) "
                             "or .gif, in place of a picture")
    parser.add_argument("--fps", type=command_line.real,
                        help="frames per second of a movie (default: 20)")
    arguments = parser.parse_args()
    if arguments.movie is None and arguments.fps is not None:
        parser.error("--fps without --movie; accepted: both, or no --fps")
    return arguments


def import_libraries():
    """Imports the libraries only now, because --help needs none of them."""
    global checksum, h5py, modes, path, replica_of_file, style, texture
    import h5py
    from cayspin_plots import modes, path, style

    import texture  # of python/cayspin, which cayspin_plots has put on the path
    from texture import checksum
    from texture import replica as replica_of_file


def movie_writer(path, fps):
    from matplotlib import animation

    if path.suffix not in MOVIES:
        raise SystemExit(f"{path}: accepted: a movie that ends in {' or '.join(MOVIES)}")
    found = [name for name in MOVIES[path.suffix] if animation.writers.is_available(name)]
    if not found:
        raise SystemExit(f"{path}: matplotlib finds no {MOVIES[path.suffix][0]}; accepted: one on "
                         "the PATH" + (", or a movie that ends in .gif" * (path.suffix == ".mp4")))
    if not 0 < fps < 1000:
        raise SystemExit(f"cayspin: --fps {fps:g}: accepted: a number > 0 and < 1000")
    return animation.writers[found[0]](fps=fps)


def read(file, arguments, frame):
    """A frame and the options to draw it with."""
    options = {"plane": arguments.plane, "before": None,
               "quantity": "charge" if arguments.charge else "spins"}
    if modes.is_modes(file):
        mode = 0 if arguments.frame is None else arguments.frame
        return modes.moving(file, mode, frame, texture), options
    if path.is_path(file):
        shown, options["before"] = path.texture_of(file, frame, arguments.difference, texture)
        return shown, options
    shown, before = texture.of_file(file, frame, arguments.difference)
    checksum.require_undamaged(file, texture.frame_number(file, frame), shown.spins[None])
    if before is not None:
        checksum.require_undamaged(file, texture.frame_number(file, arguments.difference),
                                   before[None])
    return shown, {**options, "before": before}


def frames_of(file, arguments):
    if modes.is_modes(file):
        if arguments.difference is not None:
            raise ValueError("--difference of a mode; accepted: a file of frames or of a path")
        return range(modes.FRAMES)
    count = path.number_of if path.is_path(file) else texture.frame_number
    return range(count(file, -1) + 1)


def draw_movie(file, arguments):
    name = arguments.movie
    writer = movie_writer(name, 20 if arguments.fps is None else arguments.fps)
    frames = frames_of(file, arguments)
    limit = None
    if arguments.charge or arguments.difference is not None:
        limit = max(texture.largest(shown, **options) for shown, options in (
            read(file, arguments, frame) for frame in frames))
    shown, options = read(file, arguments, 0)
    axes = texture.draw(shown, colors=arguments.colors, limit=limit, **options)
    figure, place = axes.figure, axes.get_position(original=True)
    with style.replacing(name, "movie") as written, writer.saving(figure, str(written), dpi=100):
        for frame in frames:
            with errors_of(arguments.file):
                shown, options = read(file, arguments, frame)
                figure.clear()
                texture.draw(shown, figure.add_axes(place, anchor="NW"), colors=arguments.colors,
                             limit=limit, key=True, **options)
            writer.grab_frame()
    print(name)


def figure_of(file, arguments):
    """The figure of a file, and what the name of its picture ends with."""
    if modes.is_modes(file):
        for option in ("frame", "plane", "difference", "charge"):
            given = getattr(arguments, option)
            if given is not None and given is not False:
                raise ValueError(f"--{option} of a picture of modes; accepted: no --{option}" +
                                 ", or --movie" * (option != "difference"))
        return modes.draw(file), "modes"
    of_frames = arguments.charge or arguments.difference is not None
    if path.is_path(file) and arguments.frame is None and not of_frames:
        return path.draw(file, texture, arguments.colors), "path"
    frame = -1 if arguments.frame is None else arguments.frame
    shown, options = read(file, arguments, frame)
    return texture.draw(shown, colors=arguments.colors, **options).figure, "texture"


def of_replica(file, replica):
    """Returns a replica of the file of an ensemble, and any other file unchanged."""
    if replica_of_file.is_ensemble(file):
        return replica_of_file.Replica(file, 0 if replica is None else replica)
    if replica is not None:
        raise ValueError("--replica of a file that is no ensemble; accepted: no --replica")
    return file


def run(arguments):
    command_line.require_file(arguments.file)
    try:
        file = h5py.File(arguments.file, "r")
    except BlockingIOError:
        raise ValueError("another program is writing it; accepted: the file of a run that has "
                         "ended, or `cayspin view`") from None
    except OSError as error:
        raise ValueError(f"cannot be opened: {' '.join(str(error).split())}"
                         f"{command_line.what_can_be_read(arguments.file)}") from None
    with file:
        shown = of_replica(file, arguments.replica)
        if arguments.movie:
            draw_movie(shown, arguments)
            return
        figure, ending = figure_of(shown, arguments)
    style.save(figure, arguments.output or
               arguments.file.with_name(f"{arguments.file.stem}_{ending}.png"))


@contextlib.contextmanager
def errors_of(file):
    try:
        yield
    except (OSError, KeyError, TypeError, ValueError) as error:
        reason = " ".join(str(error.args[-1] if error.args else error).split())
        raise SystemExit(f"{file}: {reason}") from None


def main():
    arguments = parse_arguments()
    try:
        with errors_of(arguments.file):
            import_libraries()
            run(arguments)
    except ImportError as error:
        message = (f"cayspin: {sys.executable} has no {error.name}; accepted: a Python with "
                   "h5py and matplotlib in CAYSPIN_PYTHON")
    except SystemExit as error:
        message = error.code
    else:
        return
    print(message, file=sys.stderr)
    sys.exit(2)


if __name__ == "__main__":
    main()
