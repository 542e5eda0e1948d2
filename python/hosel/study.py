"""A case at many points: designs from arrays, results as labelled arrays."""

import csv
import io
import json
import tempfile
from pathlib import Path

import numpy as np

from . import _hosel
from .results import Run
from .running import texts


def _toml(value):
    """A TOML value: text, number, truth, or a list of them."""
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    if isinstance(value, (float, np.floating)):
        return repr(float(value))
    return "[" + ", ".join(_toml(v) for v in value) + "]"


class Study:
    """A case whose keys are varied: the kind `study` of the command, with its design from arrays.

    case: a case directory, or the name of a shipped case, of any kind. set: overrides in every point,
    "table.key=value". outputs: entries of the points' summaries, such as "models.volumetric.carry_yd"; empty: all.

        study = hosel.Study("driver-toe", set=['models=["volumetric"]'])
        found = study.grid("out/toe", {"delivery.impact_toe_mm": [-20, 0, 20], "delivery.club_speed_mph": [95, 105]})
        found["models.volumetric.ball_speed_mps"]        # 3 x 2, with its axes

    A killed run continues when the same call is repeated; a finished one is kept unless `force`.
    A point without an answer is nan in the result, with its reason in `errors`. Errors are those of `hosel.run`, and
    FileNotFoundError where measured data of the case are missing.
    """

    def __init__(self, case, set=(), outputs=()):
        path = Path(case)
        self.case = str(path.resolve()) if (path / "case.toml").exists() else str(case)
        self.set, self.outputs = texts("set", set), texts("outputs", outputs)

    def grid(self, out, axes, force=False, quiet=True):
        """Every combination of the axes' values. axes: key of the case, with its unit -> its values."""
        axes = {key: np.atleast_1d(values) for key, values in axes.items()}
        text = "".join(f"[[axis]]\nkey = {_toml(k)}\nvalues = {_toml(v)}\n" for k, v in axes.items())
        return Labelled(self._run(text, {}, out, force, quiet), axes)

    def sample(self, out, ranges, points, seed=0, force=False, quiet=True):
        """A Latin hypercube. ranges: key -> (lowest, highest). One dimension, `point`."""
        text = f"[sample]\npoints = {int(points)}\nseed = {int(seed)}\n"
        text += "".join(f"[[axis]]\nkey = {_toml(k)}\nrange = {_toml([float(x) for x in r])}\n" for k, r in ranges.items())
        return Labelled(self._run(text, {}, out, force, quiet), given={n: n for n in ranges})

    def rows(self, out, columns, force=False, quiet=True):
        """The given points. columns: key -> its value in every point, and `name` -> names of the points. One dimension,
        `point`."""
        columns = {key: np.ma.atleast_1d(values) for key, values in columns.items()}
        for key, values in columns.items():
            if any(v is None or v is np.ma.masked or v != v for v in values):
                raise ValueError(f"{key}: a point has no value")
        if len({len(v) for v in columns.values()}) != 1:
            raise ValueError("columns of one length each: " + ", ".join(f"{k} has {len(v)}" for k, v in columns.items()))
        table = io.StringIO()
        csv.writer(table, lineterminator="\n").writerows([list(columns), *zip(*(v.tolist() for v in columns.values()))])
        found = self._run('[rows]\nfile = "rows.csv"\n', {"rows.csv": table.getvalue()}, out, force, quiet)
        # Any other head is of a measured quantity, which is no input.
        return Labelled(found, given={n: "row" if n == "name" else n for n in columns if n == "name" or "." in n})

    def _run(self, design, files, out, force, quiet):
        top = f'kind = "study"\ncase = {_toml(self.case)}\nset = {_toml(self.set)}\noutputs = {_toml(self.outputs)}\n'
        with tempfile.TemporaryDirectory() as folder:
            for name, text in {"case.toml": top + design, **files}.items():
                (Path(folder) / name).write_text(text, encoding="utf-8")
            try:
                _hosel.run(folder, str(out), [], force, quiet)
            except _hosel.NonConvergence:  # of points: the others have their answers
                if not (Path(out) / "summary.json").exists():
                    raise
        found = Run(out)
        if found.skipped:
            raise FileNotFoundError(f"{found.skipped}: not there, so no point was computed; HOSEL_DATA names the folder of "
                                    "measured files")
        return found


class Labelled:
    """What a study has found, with its axes.

    dims: names of the dimensions. coords: name -> values along a dimension, or at every point. outputs: what was computed.
    array: a structured NumPy array of the dimensions' shape with a field for each output, nan where a point has no answer.
    errors: of the same shape, the reason where there is none. run: the finished hosel.Run.
    found["models.volumetric.carry_yd"] is an xarray.DataArray where xarray is installed, else a NumPy array.
    """

    def __init__(self, run, axes=None, given=()):
        """given: name -> column of points.csv, of what stands beside the points."""
        self.run, given = run, dict(given)
        table = run["points.csv"]
        self.outputs = [n for n in table if n not in ("point", "error", *(axes or given.values()))]
        if axes is not None:
            self.dims, self.coords = tuple(axes), dict(axes)
        else:
            beside = {n: table[column] for n, column in given.items()}
            self.dims, self.coords = ("point",), {"point": table["point"].astype(int), **beside}
        shape = tuple(len(self.coords[d]) for d in self.dims)
        self.errors = np.array([str(e) if e == e else "" for e in table["error"]]).reshape(shape)
        self.array = np.empty(shape, dtype=[(n, table[n].dtype) for n in self.outputs])
        for name in self.outputs:
            self.array[name] = table[name].reshape(shape)

    def to_xarray(self):
        """An xarray.Dataset of all outputs; ImportError where xarray is not installed."""
        import xarray

        coords = {n: ((n,) if n in self.dims else ("point",), v) for n, v in self.coords.items()}
        return xarray.Dataset({n: (self.dims, self.array[n]) for n in self.outputs}, coords)

    def __getitem__(self, output):
        if output not in self.outputs:
            raise KeyError(f"no output {output!r} (there are {', '.join(self.outputs)})")
        try:
            return self.to_xarray()[output]
        except ImportError:
            return self.array[output]

    def __repr__(self):
        axes = ", ".join(f"{d}: {len(self.coords[d])}" for d in self.dims)
        return f"hosel.Labelled({axes}; {len(self.outputs)} outputs)"
