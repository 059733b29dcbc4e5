# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Lie-group time integration of spin fields.

    import cayspin
    sim = cayspin.Simulation(cayspin.Scene.from_file("film.toml"))
    sim.run()
    sim.spins  # (nz, ny, nx, 3)

Arrays of vectors have the shape (nz, ny, nx, 3), or (site, nz, ny, nx, 3) for crystals with several
sites in a cell. All numbers are in the units of the scene.
"""

from cayspin._cayspin import CayspinError, NumbersFailed, SceneError
from cayspin._cayspin import version as __version__
from cayspin.averages import Averages
from cayspin.ensemble import Ensemble
from cayspin.ensemble_simulation import EnsembleSimulation
from cayspin.equilibrium import Bands, Minimum, Modes
from cayspin.mesh import occupied_of_mesh
from cayspin.modes_file import read_modes
from cayspin.observables import Average, Dispersion, average, dispersion, topological_charge
from cayspin.path import MinimumEnergyPath, path
from cayspin.scene import Scene
from cayspin.simulation import Simulation
from cayspin.spectra import StructureFactor, linear_structure_factor, structure_factor
from cayspin.spirit import read_spirit_pairs
from cayspin.sweep import sweep
from cayspin.trade import Advice, Trade, advise, trade
from cayspin.trajectory import Trajectory, open
from cayspin.uppasd import read_uppasd
from cayspin.view import View, view

__all__ = ["Advice", "Average", "Averages", "Bands", "CayspinError", "Dispersion", "Ensemble",
           "EnsembleSimulation", "Minimum", "MinimumEnergyPath", "Modes", "NumbersFailed", "Scene",
           "SceneError", "Simulation", "StructureFactor", "Trade", "Trajectory", "View",
           "__version__", "advise", "average", "dispersion", "linear_structure_factor",
           "occupied_of_mesh", "open", "path", "read_modes", "read_spirit_pairs", "read_uppasd",
           "structure_factor", "sweep", "topological_charge", "trade", "view"]
