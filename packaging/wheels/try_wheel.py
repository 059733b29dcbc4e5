# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""try_wheel.py LEVEL: tries the wheel in the environment of this Python. Fails unless the loader
has taken the libraries for the x86-64 level LEVEL."""

import pathlib
import subprocess
import sys
import tempfile

import cayspin

LEVEL = sys.argv[1]
SCENE = {
    "system": {"kind": "llg", "damping": 0.05},
    "lattice": {"shape": [32, 8]},
    "field": {"exchange": 1.0, "applied": [0.5, 0.0, 0.1]},
    "initial": {"random": {"seed": 7}},
    "integrator": {"method": "rkmk4", "dt": 0.05, "steps": 100},
}
COMMAND = pathlib.Path(sys.executable).parent / "cayspin"


def loaded_libraries():
    maps = pathlib.Path("/proc/self/maps").read_text(encoding="utf-8")
    return {line.split()[-1] for line in maps.splitlines() if "libcayspin_" in line}


def level_of(library):
    folder = pathlib.Path(library).parent
    return folder.name if folder.parent.name == "glibc-hwcaps" else "x86-64"


def command(*arguments):
    return subprocess.run([COMMAND, *arguments], check=True, capture_output=True, text=True).stdout


def main():
    scene = cayspin.Scene(**SCENE)
    simulation = cayspin.Simulation(scene)
    simulation.run()
    levels = {level_of(library) for library in loaded_libraries()}
    assert levels == {LEVEL}, f"libraries of {levels} are loaded, not of {LEVEL}"
    with tempfile.TemporaryDirectory() as folder:
        text = pathlib.Path(folder, "scene.toml")
        text.write_text(scene.text, encoding="utf-8")
        file = pathlib.Path(folder, "run.h5")
        command("run", str(text), "--output", str(file))
        read = cayspin.open(file)
        assert abs(read.magnetization[-1] - simulation.magnetization()).max() == 0
        picture = pathlib.Path(folder, "spins.png")
        command("plot", str(file), "--output", str(picture))
        assert picture.stat().st_size > 10_000
    print(f"{LEVEL}: Python {sys.version.split()[0]}, cayspin {cayspin.__version__}, "
          f"energy {simulation.energy():.15g}")


if __name__ == "__main__":
    main()
