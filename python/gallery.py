#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Runs the commands of docs/gallery.md and docs/guide/what_a_scene_can_hold.md and draws their
pictures; prints the seconds of each scene."""

import contextlib
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time

from cayspin_plots import command_line

ROOT = pathlib.Path(__file__).resolve().parents[1]
PAGES = ROOT / "docs/gallery.md", ROOT / "docs/guide/what_a_scene_can_hold.md"
SECTION = re.compile(r"^## .*?(?=^## |\Z)", re.DOTALL | re.MULTILINE)
SCENE = re.compile(r"^```toml\n(.*?)^```$", re.DOTALL | re.MULTILINE)
COMMANDS = re.compile(r"^```sh\n(.*?)^```$", re.DOTALL | re.MULTILINE)
PICTURE = re.compile(r"^!\[.+\]\((?:\.\./)?images/gallery_(\w+)\.png\)$", re.MULTILINE)
WIDTH, BYTES = 500, 60_000  # of a picture


def scenes(page):
    """The scene, or none, and the commands of each picture of a page, by the picture's name."""
    found = {}
    for section in SECTION.findall(page.read_text(encoding="utf-8")):
        scene, commands, pictures = (
            part.findall(section) for part in (SCENE, COMMANDS, PICTURE))
        if len(commands) != 1 or len(pictures) != 1 or len(scene) > 1:
            title = section.partition("\n")[0]
            raise SystemExit(f"{page.name}: {title}: accepted: one block of commands, one picture, "
                             "at most one scene")
        found[pictures[0]] = (scene[0] if scene else None), commands[0].splitlines()
    return found


@contextlib.contextmanager
def workspace(program):
    """Yields a folder in which the commands of the pages can run, and the environment for them."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for tree in ("scenes", "python", "examples"):
            (folder / tree).symlink_to(ROOT / tree)
        (folder / "bin").mkdir()
        (folder / "bin/cayspin").symlink_to(program.resolve())
        (folder / "bin/python3").symlink_to(sys.executable)
        path = f"{folder}/bin:{os.environ['PATH']}"
        yield folder, os.environ | {"PATH": path, "MPLCONFIGDIR": f"{folder}/bin"}


def run(command, folder, environment):
    """Returns the output of a command."""
    done = subprocess.run(["bash", "-c", command], cwd=folder, env=environment, text=True,
                          capture_output=True)
    if done.returncode != 0:
        raise SystemExit(f"{command}: exit status {done.returncode}: {done.stdout}{done.stderr}")
    return done.stdout


def shrink(picture, path):
    from PIL import Image

    with Image.open(picture) as image:
        size = WIDTH, round(image.height * WIDTH / image.width)
        small = image.convert("RGB").resize(size, Image.Resampling.LANCZOS)
    small.save(path, optimize=True)
    if path.stat().st_size > BYTES:
        palette = small.quantize(256, Image.Quantize.MAXCOVERAGE)
        small.quantize(palette=palette).save(path, optimize=True)


def draw(name, scene, commands, program, images):
    with workspace(program) as (folder, environment):
        if scene:
            (folder / f"{name}.toml").write_text(scene, encoding="utf-8")
        environment |= {"OMP_NUM_THREADS": "1"}
        begin = time.monotonic()
        for command in commands[:-1]:
            run(command, folder, environment)
        seconds = time.monotonic() - begin
        picture = run(commands[-1], folder, environment).split()[-1]
        shrink(folder / picture, images / f"gallery_{name}.png")
    print(f"{name:24} {seconds:6.1f} s", flush=True)


def main():
    parser = command_line.Parser(description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME",
                        help="of pictures, without gallery_ (default: all)")
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/release/bin/cayspin",
                        help="cayspin (default: build/release/bin/cayspin)")
    parser.add_argument("--images", type=pathlib.Path, default=ROOT / "docs/images",
                        metavar="FOLDER", help="where pictures go (default: docs/images)")
    arguments = parser.parse_args()
    found = {name: both for page in PAGES for name, both in scenes(page).items()}
    unknown = set(arguments.names) - set(found)
    if unknown:
        sys.exit(f"no scene {', '.join(sorted(unknown))}; accepted: {', '.join(found)}")
    if not arguments.program.is_file():
        sys.exit(f"{arguments.program}: there is no such program; accepted: a built cayspin")
    for name in arguments.names or found:
        draw(name, *found[name], arguments.program, arguments.images)


if __name__ == "__main__":
    main()
