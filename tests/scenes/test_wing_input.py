"""Wings and loads that cannot be are refused in one sentence."""

import numpy as np
import pytest
from mpi4py import MPI

from morphing_wing.errors import InputError
from morphing_wing.geometry.rib import RibGeometry
from morphing_wing.geometry.wing import WingGeometry
from morphing_wing.geometry.wing_mesh import WingMeshing
from morphing_wing.wing import Wing
from tests.scenes.small_wing import GEOMETRY, NO_SKIN, SPAR, actuated, small_wing, wing


@pytest.mark.quick
@pytest.mark.parametrize("tension, shown", [(0.2, "0.2"), ([0.0, 0.1, 0.3], "0.3")])
def test_cables_without_ribs_are_refused_in_one_sentence(tension, shown):
    with pytest.raises(InputError, match=rf"^cable = {shown} N: must be 0 N or left out in a wing "
                                         r"without ribs[^\n]*$"):
        wing(**SPAR).actuate(upper=0.01, cable=tension)


@pytest.mark.quick
def test_a_slack_cable_is_no_cable():
    path = actuated(wing(**SPAR), upper=0.001, cable=np.zeros(2))
    assert len(path) == 2


@pytest.mark.quick
@pytest.mark.parametrize("changes", [SPAR, NO_SKIN], ids=["spar alone", "ribs"])
def test_cables_do_not_push(changes):
    with pytest.raises(InputError, match=r"^cable = -0\.1 N: must be 0 N or more: cables only"):
        wing(**changes).actuate(cable=[0.1, -0.1])


@pytest.mark.quick
@pytest.mark.parametrize("load, text", [
    ({"upper": float("nan")}, r"^upper = nan MPa: must be finite"),
    ({"cable": float("inf")}, r"^cable = inf N: must be finite"),
    ({"gravity": float("inf")}, r"^gravity = inf g: must be finite"),
    ({"cable": "0.1 N"}, r"^cable = '0\.1 N': must be a number"),
    ({"upper": [0.01, 0.02], "cable": [0.1] * 3}, "^loads have lengths upper 2, lower 1, cable 3"),
])
def test_loads_that_are_none_are_refused_in_one_sentence(load, text):
    with pytest.raises(InputError, match=text):
        wing(**NO_SKIN).actuate(**load)


@pytest.mark.quick
@pytest.mark.parametrize("changes, text", [
    ({"aerofoil": "12"}, "^aerofoil = '12': must be four digits"),
    ({"aerofoil": "0006"}, "^top_thickness = 2 mm: must be less than .* taller than the aerofoil$"),
    ({"rib": RibGeometry.prototype(n_cells=40)}, r"^rib\.n_cells = 40: must be at most \d+, or "),
    ({"skin_thickness": 2.5}, "^skin_thickness = 2.5 mm: must be .* less than top_thickness = 2"),
    ({"cavity_length": -5.0}, "^cavity_length = -5 mm: must be greater than 0 mm$"),
    ({"middle_thickness": float("nan")}, "^middle_thickness = nan mm: must be greater than 0 mm$"),
])
def test_a_wing_that_cannot_be_built_is_refused_before_it_is_meshed(changes, text, monkeypatch):
    monkeypatch.setattr("morphing_wing.wing.wing_mesh", None)
    with pytest.raises(InputError, match=text):
        small_wing(MPI.COMM_SELF, geometry=WingGeometry.prototype(**changes))


@pytest.mark.quick
def test_a_fidelity_that_no_wing_has_is_refused_in_one_sentence():
    sentence = r"^fidelity = 'best': must be one of draft, standard, reference, or auto$"
    with pytest.raises(InputError, match=sentence):
        Wing(GEOMETRY, fidelity="best", comm=MPI.COMM_SELF, meshing=WingMeshing.coarse())
