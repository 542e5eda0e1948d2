"""One model evaluated for many blows."""

import numpy as np

from . import _hosel
from .running import texts


def _numbers(x):
    """As an array; what is masked is nan, which no blow has."""
    return np.ma.filled(np.ma.asarray(x, dtype=float), np.nan)


class Model:
    """A model of `hosel list` and the blow of a case: club, ball, contact, and a delivery that the inputs below replace.
    Each blow is computed as `hosel.run` computes the case with these inputs: with the set of parameters that the case's
    ball has for its loft.

    case: a case directory, or the name of a shipped case, of a kind that has one blow (impact, study of
        blows). A case with a [motion] is an InputError: its delivery follows from the swing.
    name: the model; default: the first that the case names.
    set: overrides, "table.key=value".
    """

    def __init__(self, case, name="", set=()):
        self._model = _hosel.Model(str(case), name, texts("set", set))

    @property
    def name(self):
        return self._model.name

    def launch(self, **inputs):
        """The launches of blows with these inputs, computed on all cores.

        inputs: numbers or arrays that broadcast together, named as in a case with their unit: club_speed, attack_angle,
            club_path, face_angle, dynamic_loft, impact_toe, impact_high, head_mass. Inputs that are not given are the case's.
        Returns a dict of arrays of the broadcast shape: ball_speed_mps, launch_angle_deg, azimuth_deg, backspin_rpm, ...
        Raises InputError (a ValueError) or NonConvergence naming the first blow that has no answer. All blows are checked
        first: if the case would be refused with one (outside the range of its ball's data), nothing is computed. Warns
        where blows strike the ball off the face.
        """
        arrays = np.broadcast_arrays(*(_numbers(x) for x in inputs.values())) if inputs else [np.zeros(())]
        shape = arrays[0].shape
        rows = np.stack([a.ravel() for a in arrays], axis=1) if inputs else np.zeros((1, 0))
        answers = self._model.launch(list(inputs), np.ascontiguousarray(rows))
        return {name: answers[:, i].reshape(shape) for i, name in enumerate(self._model.channels())}

    def __repr__(self):
        return f"hosel.Model({self.name!r})"
