"""hosel in Python: runs cases, reads results into NumPy, evaluates models for arrays of blows.

    import hosel
    run = hosel.run("driver-toe", "out/toe", set=["accuracy=look"])
    run.summary["models"]["fe-free-body"]["ball_speed_mps"]

    model = hosel.Model("driver-toe", "rigid-eccentric")
    launch = model.launch(club_speed_mph=[95, 105, 115], impact_toe_mm=10)
    launch["ball_speed_mps"]

    study = hosel.Study("driver-toe", set=['models=["volumetric"]'])
    found = study.grid("out/toe", {"delivery.impact_toe_mm": [-20, 0, 20], "delivery.club_speed_mph": [95, 105]})
    found["models.volumetric.ball_speed_mps"]

Keys carry their unit as in a case: `club_speed_mph`, `impact_toe_mm`. Bad input is a ValueError with the sentence that
the command would print; a solver that does not converge is a hosel.NonConvergence.
"""

from ._hosel import InputError, NonConvergence, __version__
from .model import Model
from .results import Run, Table, read, read_table
from .running import check, run
from .study import Labelled, Study

__all__ = ["InputError", "Labelled", "Model", "NonConvergence", "Run", "Study", "Table", "check", "read", "read_table", "run", "__version__"]
