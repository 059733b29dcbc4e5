# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Shows the spins of a trajectory file on a page in the browser, also while a run writes it. For a
scene it first starts the run."""

from __future__ import annotations

import argparse
import asyncio
import os
import pathlib
import shutil
import sys
import webbrowser

from ..command_line import Parser


def _port(text):
    if not text.isdecimal() or int(text) > 65535:
        raise argparse.ArgumentTypeError(f"{text}: no port; accepted: 0 (a free one) to 65535")
    return int(text)


def parse_arguments():
    parser = Parser(prog="cayspin view", description=__doc__)
    parser.add_argument("file", type=pathlib.Path, metavar="FILE.h5|SCENE.toml")
    parser.add_argument("--port", type=_port, default=0, help="default: a free one")
    parser.add_argument("--no-browser", action="store_true", help="only print the address")
    parser.add_argument("--in-notebook", action="store_true", help=argparse.SUPPRESS)
    return parser.parse_args()


def find_program():
    """Returns the program that CAYSPIN_PROGRAM names, the one beside the script that runs, or the
    one on PATH."""
    beside = pathlib.Path(sys.argv[0]).parent / "cayspin"
    found = os.environ.get("CAYSPIN_PROGRAM") or shutil.which(beside) or shutil.which("cayspin")
    if not found:
        raise ValueError("cayspin: there is no such program; accepted: one on the PATH, or its "
                         "file in CAYSPIN_PROGRAM")
    return found


def show(arguments):
    from .reader import Reader
    from .run import Run
    from .server import serve

    def announce(address):
        print(address, flush=True)
        if not arguments.no_browser:
            webbrowser.open(address)

    run = None
    if arguments.file.suffix == ".toml":
        run = Run(find_program(), arguments.file)
    try:
        reader = Reader(run.output if run else arguments.file)
        asyncio.run(serve(reader, run, arguments.port, announce, arguments.in_notebook))
    finally:
        if run:
            run.close()


def main():
    arguments = parse_arguments()
    try:
        show(arguments)
    except ModuleNotFoundError as error:
        message = (f"cayspin: there is no Python package {error.name}; accepted: a Python "
                   "with numpy, h5py and tornado")
    except ImportError as error:
        message = f"cayspin: {error}"
    except ValueError as error:
        message = error
    except OSError as error:
        message = f"cayspin: {error.strerror or error}"
    except KeyboardInterrupt:
        return
    else:
        return
    print(message, file=sys.stderr)
    sys.exit(2)


if __name__ == "__main__":
    main()
