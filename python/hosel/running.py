"""Cases checked and run, by the same code as the command."""

import tomllib

from . import _hosel
from .results import Run


def check(case, set=()):
    """The case with every default filled in, as a dict; its "defaults" are those, by dotted key.

    Raises InputError with file, line and what is allowed.
    """
    return tomllib.loads(_hosel.check(str(case), list(set)))


def run(case, out, set=(), force=False, quiet=True):
    """Runs a case into the directory `out` and reads what it wrote.

    case: a case directory, or the name of a shipped case. set: overrides, "table.key=value".
    force: overwrite a finished run. Raises InputError and NonConvergence as the command's exit statuses 2 and 3.
    """
    _hosel.run(str(case), str(out), list(set), force, quiet)
    return Run(out)
