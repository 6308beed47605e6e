"""A skin that is built in stretched."""

import numpy as np
import pytest

from morphing_wing import compat
from morphing_wing.materials import DRAGON_SKIN_30
from tests.geometry import hexahedra
from tests.scenes.small_wing import NO_RIBS, actuated, wing

STRETCHED = {"skin_prestretch": (1.1, 1.2)}


@pytest.mark.quick
def test_held_as_built_the_skin_stores_the_energy_of_its_stretches():
    scene = wing(**NO_RIBS, **STRETCHED)
    form = compat.form(scene.body.energy)
    assert compat.assemble_scalar(scene.comm, form) == pytest.approx(0.0, abs=1e-12)
    scene.body.prestretch.part.value = 1.0
    surplus = 1.1**2 + 1.2**2 + (1.1 * 1.2) ** -2 - 3.0
    C10, C20 = DRAGON_SKIN_30.coefficients
    density = C10 * surplus + C20 * surplus**2
    volume = hexahedra.volume(scene.body.grid, "skin")
    assert compat.assemble_scalar(scene.comm, form) == pytest.approx(density * volume, rel=1e-9)


def test_loads_work_from_the_state_as_built_on():
    path = actuated(wing(**NO_RIBS, **STRETCHED), upper=np.linspace(0.0, 0.02, 5))
    first, last = path[0], path[-1]
    assert first.load["upper_MPa"] == 0.0 and first.energy_Nmm > 1.0
    assert first.external_work_Nmm == 0.0 and first.negative_pivots == 0
    assert last.energy_Nmm - first.energy_Nmm == pytest.approx(last.external_work_Nmm, rel=1e-3)


def test_a_path_of_a_stretched_wing_resumes_as_it_would_have_gone_on(tmp_path):
    changes = NO_RIBS | STRETCHED
    whole = actuated(wing(**changes), upper=[0.005, 0.01])
    actuated(wing(**changes), upper=[0.005], restart=tmp_path)
    resumed = wing(**changes).actuate(upper=[0.005, 0.01], resume=tmp_path)
    assert resumed.converged
    for name, value in whole[-1].measures.items():
        assert resumed[-1].measures[name] == pytest.approx(value, rel=1e-6, abs=1e-9), name
    assert resumed[-1].external_work_Nmm == pytest.approx(whole[-1].external_work_Nmm, rel=1e-6)


@pytest.mark.quick
def test_a_skin_without_prestretch_knows_none():
    scene = wing(**NO_RIBS)
    assert scene.body.prestretch is None and "prestretch_part" not in scene.load_names
