# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Scenes: descriptions of what to simulate."""

from __future__ import annotations

import os
import re
from typing import Any

import numpy as np

from cayspin import _cayspin, arguments, sites, toml_text
from cayspin.texture import toml

_OWN = ("applied", "nonlocal")
_VECTORS = re.compile(r".*(sources\[\d+\]\.profile|axis|axes\[\d+\]|in_plane|normal|polarization)")


def _numbers(array, key):
    """Returns arguments.numbers(), but raises SceneError."""
    try:
        return arguments.numbers(array, key)
    except _cayspin.CayspinError as error:
        raise _cayspin.SceneError(str(error)) from None


def _without_arrays(thing, key, arrays):
    """Returns a value of a scene without its arrays of values per site, which are moved into
    `arrays` by their keys and replaced by toml_text.ARRAY."""
    if key == "field.applied" and isinstance(thing, np.ndarray) and thing.ndim > 2:
        raise _cayspin.SceneError(f"{key}: an array of vectors, which only Scene(field=..) takes; "
                                  "accepted: three numbers or expressions, or field.sources")
    if _is_array_of_vectors(thing) and _VECTORS.fullmatch(key):
        thing = [thing[..., component] for component in range(3)]
    if isinstance(thing, np.ndarray) and thing.ndim in (3, 4):
        arrays[key] = _numbers(thing, key)
        return toml_text.ARRAY
    if isinstance(thing, dict):
        return {name: _without_arrays(one, f"{key}.{name}", arrays) for name, one in thing.items()}
    if isinstance(thing, (list, tuple)):
        return [_without_arrays(one, f"{key}[{n}]", arrays) for n, one in enumerate(thing)]
    return thing


def _is_array_of_vectors(value):
    return isinstance(value, np.ndarray) and value.ndim in (4, 5) and value.shape[-1] == 3


def _with_applied_as_source(field):
    """Returns the table [field] with an array for `applied` as a further entry of `sources`, and
    this array, or None."""
    applied = field.get("applied") if isinstance(field, dict) else None
    if not isinstance(applied, np.ndarray) or applied.ndim <= 2:
        return field, None
    if not _is_array_of_vectors(applied):
        raise _cayspin.SceneError(f"field.applied: an array of shape {applied.shape}; accepted: "
                                  "(nz, ny, nx, 3), of a crystal (site, nz, ny, nx, 3), or three "
                                  "numbers or expressions")
    if not np.isfinite(_numbers(applied, "field.applied")).all():
        raise _cayspin.SceneError("field.applied: a number of the array is not finite; accepted: "
                                  "finite numbers")
    others = {key: value for key, value in field.items() if key != "applied"}
    sources = others.get("sources", [])
    if isinstance(sources, (list, tuple)):  # the scene refuses other types
        others["sources"] = [*sources, {"profile": applied}]
    return others, applied


def _split(tables):
    """Splits the tables of a scene. Returns the tables that TOML text can hold, the initial spins
    (or None), the functions of [field] by key, and the arrays of values per site by key."""
    tables = {name: table for name, table in tables.items() if table is not None}
    spins, own = None, {}
    initial = tables.get("initial")
    if initial is not None and not isinstance(initial, dict):
        spins = _numbers(initial, "initial")
        if spins.ndim not in (4, 5) or spins.shape[-1] != 3:
            raise _cayspin.SceneError(f"initial: an array of shape {spins.shape}; accepted: "
                                      "(nz, ny, nx, 3), of a crystal (site, nz, ny, nx, 3)")
        tables["initial"] = toml_text.ARRAY
    if isinstance(tables.get("field"), dict):
        own = {key: f for key, f in tables["field"].items() if key in _OWN and callable(f)}
        tables["field"] = {key: f for key, f in tables["field"].items() if key not in own}
    own |= {key: tables.pop(f"field.{key}") for key in _OWN if callable(tables.get(f"field.{key}"))}
    arrays = {}
    tables = {name: _without_arrays(table, name, arrays) for name, table in tables.items()}
    return tables, spins, own, arrays


def _text_without_applied(scene, path):
    """Returns the text of a scene without its field.applied, which a function replaces. Returns
    None if the scene has no field.applied."""
    try:
        tables = toml.loads(scene.text)
    except ImportError as error:
        raise _cayspin.CayspinError(f"{path}: replacing its field.applied requires {error}"
                                    ) from None
    applied = tables.get("field", {}).pop("applied", None)
    return None if applied is None else toml_text.document(tables)


def _as_planes(spins):
    """Returns an array of initial spins, or None, in the library's order of sites (sites.py)."""
    if spins is None or spins.ndim == 4:
        return spins
    return spins[0] if len(spins) == 1 else sites.by_plane(spins, len(spins))


def _flat(arrays):
    """Returns flat arrays of values per site in the library's order of sites."""
    return {key: np.ascontiguousarray(_as_planes(array[..., None]), np.float64).ravel()
            for key, array in arrays.items()}


def _nonlocal_by_planes(function, shape, cell_sites):
    """Wraps a function of a crystal's field, so that it can be called with arrays in the library's
    order."""
    def called(spins, t):
        field = np.asarray(function(sites.by_site(spins, cell_sites), t))
        if field.shape != (*shape, 3):
            raise _cayspin.CayspinError(
                f"field.nonlocal: the function returned an array of shape {field.shape}; "
                f"accepted: {(*shape, 3)}")
        return np.ascontiguousarray(sites.by_plane(field, cell_sites))
    return called


def moments_over_g(scene):
    """Returns mu / g of each site of a compiled scene, as linear_structure_factor() takes them."""
    _, time_unit, energy_unit = scene.units
    return sites.by_site(scene.moments_over_g(), scene.cell_sites) * (time_unit * energy_unit)


class Scene:
    """A description of what to simulate: the tables of a scene file, with the same keys, units and
    checks (docs/reference/scene.md).

        Scene(system={"kind": "llg", "damping": 0.1}, lattice={"shape": [100]},
              field={"exchange": 1.0, "applied": [0.5, 0, 0]}, initial={"uniform": [0, 0, 1]},
              integrator={"method": "rkmk4", "dt": 0.05, "end": 60})

    `system`, `lattice`, `field`, `integrator` and `output` are dicts of the keys of these tables,
    `tables` are further ones: material, torque, thermal, ensemble, and units="SI". A list of
    numbers may also be a tuple, a range or an array: ensemble={"replicas": 3, "vary":
    {"thermal.temperature": range(3)}}. Without `end` and `steps` in `integrator` the scene has no
    end. Without `integrator` it can be used only for Simulation.relax() and other calls that need
    no steps.

    `initial` is a dict, or an array (nz, ny, nx, 3) of vectors, which are copied and normalised.
    Arrays of a crystal with several sites in a cell are (site, nz, ny, nx, 3). Values per site may
    be arrays (nz, ny, nx), for a crystal (site, nz, ny, nx): lattice={"shape": [20, 20],
    "occupied": mask}. Vectors per site may be arrays with a last axis of 3:
    field={"sources": [{"profile": array}]}.

    `field["applied"]` may be a function of t that returns three numbers: the uniform field, in T in
    SI. It may also be an array (nz, ny, nx, 3) of a field that differs from site to site and does
    not depend on t or the spins; its energy is -sum mu m.H. The array becomes an entry of
    `sources`: field.applied of set() and `applied` of relax() are added to it.

    `field["nonlocal"]` may be a function of (spins, t) that returns H of all sites in the shape of
    the spins, in SI also in T. It is called with a copy of the spins whenever a step or an energy
    needs the field. H has to be linear in the spins, and with the moments mu the matrix of mu H has
    to be symmetric, so that the energy of this field is -sum mu m.H / 2. A field that does not
    depend on the spins would thus have half its energy: pass it as `applied` or `sources`. H may
    depend on t, so the energy guard is off, and the steps of adaptive methods are at most dt.

    Raises SceneError with one line that names the key, what is wrong and what is accepted.
    """

    def __init__(self, *, system: dict, lattice: dict, initial: Any,
                 integrator: dict | None = None, field: dict | None = None,
                 output: dict | None = None, **tables: Any):
        if isinstance(integrator, dict) and not {"end", "steps"} & set(integrator):
            integrator = {**integrator, "steps": 0}
        field, applied = _with_applied_as_source(field)
        typed, spins, own, arrays = _split({**tables, "system": system, "lattice": lattice, "field": field,
                                    "initial": initial, "integrator": integrator, "output": output})
        scene = _cayspin.Scene.parse(toml_text.document(typed), "Scene", [], _as_planes(spins),
                                     _flat(arrays))
        self._finish(scene, own, None, spins, arrays, applied)

    @classmethod
    def from_file(cls, path: str | os.PathLike, **overrides: Any) -> Scene:
        """Reads a scene from the TOML file `path`, with keys changed by `overrides`, as in
        from_file("film.toml", integrator={"dt": 0.1}). Overrides are tables as in Scene(). An
        override of `initial` replaces the whole table, and may be an array. A function for
        field.applied replaces the file's field.applied.

        Raises SceneError, with file and line, for errors in the file, and for wrong overrides.
        """
        typed, spins, own, arrays = _split(overrides)
        self = cls.__new__(cls)
        changed = toml_text.overrides(typed)
        with toml_text.errors_of_overrides():
            scene = _cayspin.Scene.read(arguments.file_name(path, "from_file"), changed,
                                        _as_planes(spins), _flat(arrays))
        text = _text_without_applied(scene, path) if "applied" in own else None
        if text is not None:
            scene = _cayspin.Scene.parse(text, scene.path, [], _as_planes(spins), _flat(arrays))
        self._finish(scene, own, changed, spins, arrays)
        return self

    def _finish(self, scene, own, overrides, spins, arrays, applied=None):
        shape = sites.shape_by_site(scene.shape, scene.cell_sites)
        if spins is not None and spins.shape[:-1] != shape:
            raise _cayspin.SceneError(f"initial: an array of shape {spins.shape}; accepted: "
                                      f"{(*shape, 3)}")
        if applied is not None and applied.shape != (*shape, 3):
            raise _cayspin.SceneError(f"field.applied: an array of shape {applied.shape}; accepted: "
                                      f"{(*shape, 3)}, or three numbers or expressions")
        for key, array in arrays.items():
            if array.shape != shape:
                raise _cayspin.SceneError(f"{key}: an array of shape {array.shape}; accepted: "
                                          f"{shape}")
        if own:
            nonlocal_ = own.get("nonlocal")
            if nonlocal_ is not None and scene.cell_sites > 1:
                nonlocal_ = _nonlocal_by_planes(nonlocal_, shape, scene.cell_sites)
            scene.set_own_field(own.get("applied"), nonlocal_)
        self._scene, self._overrides = scene, overrides
        self._only_here = {f"field.{key}": "a function" for key in own}
        if scene.given_start:
            self._only_here["initial"] = "an array"
        self._only_here |= dict.fromkeys(arrays, "an array")

    def at_sites(self, expression: str) -> np.ndarray:
        """The values of an `expression` at the sites, (nz, ny, nx), for a crystal with several
        sites in a cell (site, nz, ny, nx): at_sites("grain(20, 1)") gives the number of each site's
        grain.

        Raises CayspinError for an invalid expression.
        """
        values = self._scene.at_sites(arguments.word(expression, "at_sites"))
        return sites.by_site(values, self._scene.cell_sites)

    def _with(self, overrides):
        changed = Scene.__new__(Scene)
        changed._scene = self._scene.with_overrides(overrides)
        changed._overrides = None if self._overrides is None else self._overrides + overrides
        changed._only_here = self._only_here
        return changed

    def _changes(self, tables):
        """Returns tables and dotted keys without their arrays of values per site, and these
        arrays."""
        def refuse_functions(thing, key):
            if callable(thing):
                raise _cayspin.SceneError(f"{key}: a function; accepted: numbers and expressions")
            for name, one in thing.items() if isinstance(thing, dict) else ():
                refuse_functions(one, f"{key}.{name}")

        arrays = {}
        for name, table in tables.items():
            refuse_functions(table, name)
        tables = {name: _without_arrays(table, name, arrays) for name, table in tables.items()}
        for key, array in arrays.items():
            if array.shape != self.shape:
                raise _cayspin.SceneError(f"{key}: an array of shape {array.shape}; accepted: "
                                          f"{self.shape}")
        return tables, _flat(arrays)

    def _changed(self, scene, overrides, arrays):
        changed = Scene.__new__(Scene)
        changed._scene, changed._overrides = scene, None
        replaced = [one.partition("=")[0] for one in overrides]
        kept = {key: kind for key, kind in self._only_here.items() if not any(
            key == other or key.startswith((f"{other}.", f"{other}[")) for other in replaced)}
        changed._only_here = kept | dict.fromkeys(arrays, "an array")
        return changed

    @property
    def text(self) -> str:
        """The TOML text. It is a scene file for the program `cayspin`, unless the scene has
        functions or arrays."""
        return self._scene.text

    @property
    def shape(self) -> tuple[int, ...]:
        """(nz, ny, nx), for a crystal with several sites in a cell (site, nz, ny, nx)."""
        return sites.shape_by_site(self._scene.shape, self._scene.cell_sites)

    @property
    def cell(self) -> np.ndarray:
        """The three vectors of the cell, (3, 3), in the scene's unit of length, m in SI."""
        return np.array(self._scene.cell)

    @property
    def basis(self) -> np.ndarray:
        """The sites of the cell, (site, 3), in fractions of its vectors."""
        return np.array(self._scene.basis)

    @property
    def method(self) -> str | None:
        """The integrator's method; None without an integrator."""
        return self._scene.method if self._scene.has_integrator else None

    @property
    def dt(self) -> float | None:
        """The time step, in s in SI; for adaptive methods the shortest time between checks, samples
        and frames. None without an integrator."""
        return self._scene.dt if self._scene.has_integrator else None

    @property
    def steps(self) -> int:
        """Steps of dt to the end; 0 for a scene without end."""
        return self._scene.steps

    def __repr__(self):
        *of_cell, nz, ny, nx = self.shape
        crystal = f" cells of {of_cell[0]} sites" if of_cell else ""
        steps = "to relax" if self.method is None else f"{self.method}, dt {self.dt:g}"
        return f"<cayspin.Scene {nx} x {ny} x {nz}{crystal}, {steps}>"
