"""What a run has written, as NumPy arrays."""

import csv
import json
import re
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

    def __missing__(self, name):
        raise KeyError(f"no column {name!r} (there are {', '.join(self)})")

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
        """The rows in which each named column has the given value. Raises ValueError where a text is compared with a column
        of numbers, or a number with a column of texts (names 1, 2, 3 are numbers), and where several values are given."""
        keep = np.ones(len(next(iter(self.values()))), dtype=bool)
        for name, value in equal.items():
            column = self[name]
            if np.ndim(value):
                raise ValueError(f"where({name}=...) takes one value, not {len(value)}: rows with one of several are chosen one by one")
            if column.dtype.kind == "f" and np.isnan(column).all():  # empty cells are of either kind
                keep &= False
                continue
            if _kind(column) and _kind(column) != _kind(value):
                raise ValueError(f"column {name!r} holds {_kind(column)}, such as {column[0]}; {value!r} is none of them")
            keep &= column == value
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


def _kind(values):
    return {"U": "texts", **dict.fromkeys("biuf", "numbers")}.get(np.asarray(values).dtype.kind)


# A number as hosel's tables have it: 1_000 is a word.
_NUMBER = re.compile(r"\s*(\+|-)?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?\s*|\s*(\+|-)?(inf|infinity|nan)\s*", re.ASCII | re.IGNORECASE)
# A text that a spreadsheet would compute is written with an apostrophe in front.
_GUARDED = re.compile(r"' *[=@+\-\t\r\n]")


def _column(cells):
    if all(not c or _NUMBER.fullmatch(c) for c in cells):
        return np.array([float(c) if c else np.nan for c in cells])
    return np.array([c[1:] if _GUARDED.match(c) and not _NUMBER.fullmatch(c[1:]) else c for c in cells])


def read_table(file):
    """A CSV file in UTF-8 with a header line. Raises ValueError, with the line, where it is no table: a row of another length
    than the header, a name that stands twice."""
    with open(file, newline="", encoding="utf-8-sig") as lines:
        reader = csv.reader(lines)
        header, rows = next(reader, None), []
        if not header:
            raise ValueError(f"{file}:1: no header line")
        for name in header:
            if header.count(name) > 1:
                raise ValueError(f"{file}:1: column {name!r} stands twice")
        for row in reader:
            if row and len(row) != len(header):
                raise ValueError(f"{file}:{reader.line_num}: {len(row)} cells where the header has {len(header)}")
            if row:
                rows.append(row)
    return Table((name, _column([r[i] for r in rows])) for i, name in enumerate(header))


class Run:
    """The directory of a finished run.

    summary: summary.json. case: case.resolved.toml as a dict, every default filled in;
    its "defaults" are those, by dotted key. tables: names of the CSV files; run["history.csv"] reads one.
    figures: the drawn figures. series: the ParaView series (.pvd). directory: its absolute path.
    skipped: the measured file without which nothing was computed (HOSEL_DATA names their folder), else None.
    """

    def __init__(self, directory):
        self.directory = Path(directory).resolve()
        if not (self.directory / "summary.json").exists():
            raise FileNotFoundError(f"{self.directory}: no finished run (no summary.json)")
        self.summary = json.loads((self.directory / "summary.json").read_text(encoding="utf-8"))
        self.case = tomllib.loads((self.directory / "case.resolved.toml").read_text(encoding="utf-8"))

    def _files(self, *patterns):
        found = [f for p in patterns for f in self.directory.rglob(p)]
        return sorted(str(f.relative_to(self.directory)) for f in found)

    @property
    def skipped(self):
        return self.summary.get("skipped")

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
