"""What tells of the end of use: stretches, a material's law that gives way, yielding resin."""

import numpy as np
import pytest
from mpi4py import MPI

from morphing_wing.geometry.rib import RibGeometry
from morphing_wing.geometry.spar import SparGeometry, SparMeshing
from morphing_wing.limits import Limits
from morphing_wing.materials import DRAGON_SKIN_30, Yeoh
from morphing_wing.passed import passed
from morphing_wing.path import State
from morphing_wing.rib import Rib
from morphing_wing.spar import Spar

pytestmark = pytest.mark.quick


def test_at_rest_every_law_has_the_stability_of_its_first_modulus():
    for coefficients in ((0.117,), (0.117, -0.0006865), (0.2, 0.01, -0.001)):
        assert Yeoh(coefficients).stability(1.0, 1.0) == pytest.approx(1.0)


@pytest.mark.parametrize("peak, second", [(5.4557, lambda s: s**-0.5), (3.8371, lambda s: s)],
                         ids=["uniaxial", "equibiaxial"])
def test_the_papers_law_gives_way_at_its_largest_force(peak, second):
    below, above = (DRAGON_SKIN_30.stability(s, second(s)) for s in (peak - 1e-4, peak + 1e-4))
    assert above < 0.0 < below


def test_a_law_of_positive_coefficients_never_gives_way():
    a, b = np.meshgrid(np.linspace(1.0, 6.0, 26), np.linspace(0.4, 6.0, 29))
    assert (Yeoh((0.1, 0.001)).stability(a, b) > 0.0).all()


def test_stability_is_the_smaller_eigenvalue_of_the_energys_hessian():
    material, h = Yeoh((0.117, -0.004, 0.0003)), 1e-4

    def energy(a, b):
        x = a**2 + b**2 + (a * b) ** -2 - 3.0
        return sum(C * x**i for i, C in enumerate(material.coefficients, start=1))

    for a, b in ((1.3, 0.9), (2.1, 1.7), (1.2, 1.2)):
        aa = (energy(a + h, b) - 2 * energy(a, b) + energy(a - h, b)) / h**2
        bb = (energy(a, b + h) - 2 * energy(a, b) + energy(a, b - h)) / h**2
        ab = (energy(a + h, b + h) - energy(a + h, b - h) - energy(a - h, b + h)
              + energy(a - h, b - h)) / (4 * h**2)
        smaller = np.linalg.eigvalsh([[aa, ab], [ab, bb]])[0]
        assert material.stability(a, b) == pytest.approx(smaller / (4 * 0.117), rel=1e-5)


def test_a_solution_past_a_laws_largest_force_is_named_with_its_place_and_first_load():
    scene = Spar(SparGeometry.validation(2), Yeoh((0.117, -0.005)), element="Q1/P0",
                 meshing=SparMeshing.plain(), comm=MPI.COMM_SELF, filled="shared")
    scene.watch.append(Limits(scene))
    path = scene.fill(upper=[1300.0, 1800.0])
    assert path.converged
    below, beyond = (state.measures["material_stability"] for state in path)
    assert beyond < 0.0 < below
    [sentence] = passed(path)
    assert sentence.startswith("from upper = 1800 mm^3, lower = 0 mm^3 on the material's law gives")
    assert path.summary()["passed"] == [sentence]
    place = np.array([path[-1].measures[f"largest_stretch_{axis}_mm"] for axis in "xyz"])
    geometry = scene.geometry  # in the top wall over a chamber
    assert -1e-9 <= place[1] - (geometry.height / 2 - geometry.top_thickness) <= 1.0 + 1e-9


def test_a_rib_tells_of_its_stress_alone():
    rib = Rib(RibGeometry.prototype(), comm=MPI.COMM_SELF)
    rib.watch.append(Limits(rib))
    path = rib.pull(cable=[0.05, 0.9])
    low, high = (state.measures["rib_stress_MPa"] for state in path if state.requested)
    assert low < 35.0 < high and "largest_stretch" not in path[0].measures
    [sentence] = passed(path)
    assert "the resin yields (35 MPa)" in sentence


def test_torn_silicone_is_named_at_the_first_load_beyond():
    def state(pressure, stretch):
        place = {f"largest_stretch_{axis}_mm": x for axis, x in zip("xyz", (-1e-16, 7.4, 8.6),
                                                                     strict=True)}
        measures = {"largest_stretch": stretch, "material_stability": 0.5, **place}
        return State({"upper_MPa": pressure}, measures, 4, 1.0, 1.0, 0, 0.1, True)

    assert passed([state(0.01, 2.0), state(0.02, 4.6)]) == []
    assert passed([state(0.01, 2.0), state(0.02, 4.7), state(0.03, 5.0)]) == [
        "from upper = 0.02 MPa on the paper's silicone would tear (stretch 4.64): the stretch is "
        "4.7 at (0, 7.4, 8.6) mm"]


def test_shafts_of_an_undeformed_rib_are_their_axes_distance_less_their_widths_apart():
    geometry = RibGeometry(4.0, 1.0, 1.5, 6.0, 50.0, 6)
    rib = Rib(geometry, comm=MPI.COMM_SELF)
    rib.watch.append(Limits(rib))
    gap = 0.5 * 4.0 * np.sin(np.radians(50.0)) - 0.75 - 0.75
    assert rib.bend(torque=0.0)[-1].measures["shaft_gap_mm"] == pytest.approx(gap)
    path = rib.bend(torque=[10.0, 20.0, 30.0])
    gaps = [state.measures["shaft_gap_mm"] for state in path]
    assert (np.diff(gaps) < 0.0).all()
    assert gaps[-1] < 0.0
    assert any("neighbouring shafts" in sentence for sentence in passed(path))
