"""Cases checked and run, by the same code as the command."""

import tomllib
import warnings

from . import _hosel
from .results import Run


def texts(what, several):
    """A list of texts, as the compiled half takes it. A bare text is refused: it would be taken letter by letter."""
    if isinstance(several, (str, bytes)):
        raise TypeError(f"{what}: a list of texts is wanted, such as [{several!r}]")
    return list(several)


def check(case, set=()):
    """The case with every default filled in, as a dict; its "defaults" are those, by dotted key.

    Raises InputError with file, line and what is allowed.
    """
    return tomllib.loads(_hosel.check(str(case), texts("set", set)))


def run(case, out, set=(), force=False, quiet=True):
    """Runs a case into the directory `out` and reads what it wrote.

    case: a case directory, or the name of a shipped case. set: overrides, "table.key=value".
    force: overwrite a finished run. Raises InputError and NonConvergence as the command's exit statuses 2 and 3, and
    KeyboardInterrupt where Ctrl-C stops it: the same call goes on from there. Without its measured data nothing is computed:
    a warning, and Run.skipped.
    """
    _hosel.run(str(case), str(out), texts("set", set), force, quiet)
    found = Run(out)
    if found.skipped:
        warnings.warn(f"{case}: skipped, {found.skipped} is not there; HOSEL_DATA names the folder of measured files", stacklevel=2)
    return found
