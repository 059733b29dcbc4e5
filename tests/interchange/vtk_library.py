# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""The XDMF file of a run, as VTK reads it, agrees with the HDF5 file, as h5py reads it."""

import xml.etree.ElementTree

import numpy as np
from interchange_test import SHAPE, SPACING, InterchangeTest, main
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline
from vtkmodules.vtkIOXdmf2 import vtkXdmfReader


class VtkLibrary(InterchangeTest):
    def frames(self, name, *options):
        """Yields (HDF5 file, spins, grid that VTK reads) for each frame, in both precisions."""
        for precision in ("double", "single"):
            file = self.run_scene(f"{name}_{precision}.h5", "--precision", precision, "--set",
                                  "output.xdmf=true", *options)
            xdmf = file.with_suffix(".xdmf")
            xml.etree.ElementTree.parse(xdmf)
            reader = vtkXdmfReader()
            reader.SetFileName(str(xdmf))
            reader.UpdateInformation()
            times = reader.GetOutputInformation(0).Get(
                vtkStreamingDemandDrivenPipeline.TIME_STEPS())
            self.assertEqual(times, tuple(self.dataset(file, "time")))
            for time, spins in zip(times, self.dataset(file, "spins")):
                reader.UpdateTimeStep(time)
                yield file, spins, reader.GetOutputDataObject(0)

    def test_times_grid_and_vectors_are_those_of_the_trajectory(self):
        for _, expected, grid in self.frames("film"):
            self.assertEqual(grid.GetDimensions(), SHAPE)
            self.assertEqual(grid.GetSpacing(), SPACING)
            self.assertEqual(grid.GetOrigin(), tuple(np.divide(SPACING, 2)))
            vectors = grid.GetPointData().GetArray("m")
            site = grid.FindPoint(0.25 + 0.5 * 4, 0.5 + 1.0 * 2, 1.0 + 2.0 * 1)
            self.assertEqual(vectors.GetTuple(site), tuple(expected[1, 2, 4]))
            np.testing.assert_array_equal(vtk_to_numpy(vectors), expected.reshape(-1, 3))

    def test_points_and_vectors_of_a_crystal_are_those_of_the_trajectory(self):
        count = 0
        for file, expected, grid in self.frames("crystal", "--set", "lattice.crystal='honeycomb'",
                                                "--set", "field={couplings={shells=[1.0]}}"):
            self.assertEqual(expected.shape, (2, *SHAPE[::-1], 3))
            points = vtk_to_numpy(grid.GetPoints().GetData())
            positions = self.dataset(file, "positions")
            np.testing.assert_allclose(points, positions.reshape(-1, 3), rtol=1e-7)
            vectors = grid.GetPointData().GetArray("m")
            np.testing.assert_array_equal(vtk_to_numpy(vectors), expected.reshape(-1, 3))
            # Site 1 of cell (4, 2, 1), which is at (1/3, 1/3) in the cell. The lattice's spacing is
            # 0.5 along x, 1 along y and 2 along z.
            place = (0.5 * (4 + 1 / 3 + (2 + 1 / 3) / 2), np.sqrt(0.75) * (2 + 1 / 3), 2.0)
            site = grid.FindPoint(place)
            np.testing.assert_allclose(grid.GetPoint(site), place, rtol=1e-6)
            self.assertEqual(vectors.GetTuple(site), tuple(expected[1, 1, 2, 4]))
            self.assertEqual(grid.GetNumberOfCells(), 2 * np.prod(SHAPE))
            count += 1
        self.assertEqual(count, 2 * 4)


main()
