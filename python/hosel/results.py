"""What a run has written, as NumPy arrays."""

import csv
import json
import tomllib
from pathlib import Path

import numpy as np


class Table(dict):
    """A CSV file: column name (with its unit) -> array. Numbers are floats, an empty cell among them is nan; a column
    with anything else is an array of str. Columns are also attributes: table.time_s."""

    def __getattr__(self, name):
        try:
            return self[name]
        except KeyError:
            raise AttributeError(f"no column {name!r} (there are {', '.join(self)})") from None

    def __repr__(self):
        rows = len(next(iter(self.values()), ()))
        width = max((len(name) for name in self), default=0)
        lines = [f"hosel.Table of {rows} rows"]
        for name, column in self.items():
            cells = [f"{c:.6g}" if column.dtype.kind == "f" else str(c) for c in (column if rows <= 4 else column[[0, 1, 2, -1]])]
            if rows > 4:
                cells.insert(3, "...")
            lines.append(f"  {name:<{width}}  {', '.join(cells)}")
        return "\n".join(lines)

    def where(self, **equal):
        """The rows in which each named column has the given value."""
        keep = np.ones(len(next(iter(self.values()))), dtype=bool)
        for name, value in equal.items():
            keep &= self[name] == value
        return Table((name, column[keep]) for name, column in self.items())

    def grid(self, x, y, value):
        """(xs, ys, Z) with Z[j, i] = `value` at (xs[i], ys[j]), nan where the table has no such row: what
        matplotlib's contourf takes. Raises ValueError where a point stands twice (choose a map with where() first)."""
        xs, i = np.unique(self[x], return_inverse=True)
        ys, j = np.unique(self[y], return_inverse=True)
        if len(np.unique(i + len(xs) * j)) < len(i):
            raise ValueError(f"a point of the grid stands twice: choose rows with where() (columns: {', '.join(self)})")
        Z = np.full((len(ys), len(xs)), np.nan)
        Z[j, i] = self[value]
        return xs, ys, Z

    def plot(self, x, *y, ax=None):
        """Columns `y` over column `x`, drawn with matplotlib into `ax` (default: a new figure). Returns the axes."""
        if ax is None:
            import matplotlib.pyplot as plt

            ax = plt.subplots()[1]
        for name in y:
            ax.plot(self[x], self[name], label=name)
        ax.set_xlabel(x)
        ax.set_ylabel(y[0] if len(y) == 1 else "")
        if len(y) > 1:
            ax.legend(frameon=False)
        return ax


def _column(cells):
    try:
        return np.array([float(c) if c else np.nan for c in cells])
    except ValueError:
        return np.array(cells)


def read_table(file):
    """A CSV file with a header line."""
    with open(file, newline="") as lines:
        rows = list(csv.reader(lines))
    header, rows = rows[0], [r for r in rows[1:] if r]
    return Table((name, _column([r[i] for r in rows])) for i, name in enumerate(header))


class Run:
    """The directory of a finished run.

    summary: summary.json. case: case.resolved.toml as a dict, every default filled in;
    its "defaults" are those, by dotted key. tables: names of the CSV files; run["history.csv"] reads one.
    figures: the drawn figures. series: the ParaView series (.pvd).
    """

    def __init__(self, directory):
        self.directory = Path(directory)
        if not (self.directory / "summary.json").exists():
            raise FileNotFoundError(f"{self.directory}: no finished run (no summary.json)")
        self.summary = json.loads((self.directory / "summary.json").read_text())
        self.case = tomllib.loads((self.directory / "case.resolved.toml").read_text())

    def _files(self, *patterns):
        found = [f for p in patterns for f in self.directory.rglob(p)]
        return sorted(str(f.relative_to(self.directory)) for f in found)

    @property
    def tables(self):
        return [t for t in self._files("*.csv") if not t.startswith("inputs/")]

    @property
    def figures(self):
        return self._files("*.png", "*.svg", "*.pdf")

    @property
    def series(self):
        return self._files("*.pvd")

    def __getitem__(self, table):
        file = self.directory / table
        if not file.exists():
            raise KeyError(f"no table {table!r} (there are {', '.join(self.tables) or 'none'})")
        return read_table(file)

    def launches(self):
        """model -> its launch as a dict, where the run has any."""
        return self.summary.get("models", {})

    def __repr__(self):
        return f"hosel.Run({str(self.directory)!r})"


def read(directory):
    """A finished run; raises FileNotFoundError where there is none."""
    return Run(directory)
