"""Stability of laws: known ranges, criteria by other ways, stability that is asked for."""


import numpy as np
import pytest

from morphing_wing.calibration import calibrate
from morphing_wing.calibration.deformation import MODES, principal
from morphing_wing.calibration.fit import fitted
from morphing_wing.calibration.laws import YeohLaw
from morphing_wing.calibration.ogden import OgdenLaw
from morphing_wing.calibration.points import Points
from morphing_wing.calibration.result import PAPER
from morphing_wing.calibration.stability import ENFORCED, margin
from morphing_wing.calibration.study import LAWS
from morphing_wing.materials import DRAGON_SKIN_30
from tests.studies.made_tests import KNOWN, made, squares

pytestmark = pytest.mark.quick


@pytest.fixture(scope="module")
def dragon_skin():
    return calibrate("dragon_skin_30", max_stretch=4)


def test_stability_of_the_papers_pair_is_the_known_one(dragon_skin):
    stability = dragon_skin.stability()
    paper = stability[(stability["law"] == PAPER) & (stability["criterion"] == "force")]
    assert dict(zip(paper["mode"], paper["to"].round(4), strict=True)) == {
        "uniaxial": 5.4557, "planar": 5.4013, "equibiaxial": 3.8371}
    stress = YeohLaw(2).stress(DRAGON_SKIN_30.coefficients, "uniaxial",
                               np.array([1.5, 2.0, 3.0, 4.0, 4.64]))
    assert list(stress.round(4)) == [0.2453, 0.3999, 0.6231, 0.7754, 0.8357]


def test_under_dead_loads_stability_is_what_the_material_tells_of_solutions():
    stretch = np.linspace(0.4, 6.0, 57)
    for mode in MODES:
        found = margin(YeohLaw(2), DRAGON_SKIN_30.coefficients, "dead loads", mode, stretch)
        pair = principal(mode, stretch)
        assert found == pytest.approx(
            4 * 0.117 * DRAGON_SKIN_30.stability(pair[:, 0], pair[:, 1]), abs=1e-12)


@pytest.mark.parametrize("values", [[0.117, -0.0006865], [0.1, 0.006, -0.0001], [0.1, -0.05, 0.01]])
def test_ellipticity_of_laws_in_the_first_invariant_is_the_closed_form(values):
    stretch = np.linspace(0.2, 7.0, 137)
    for mode in MODES:
        stretches = principal(mode, stretch)
        excess = np.sum(stretches**2, axis=1) - 3.0
        slope = sum(i * C * excess ** (i - 1) for i, C in enumerate(values, 1))
        bend = sum(i * (i - 1) * C * excess ** (i - 2) for i, C in enumerate(values, 1) if i > 1)
        known = np.minimum(slope, slope + 2 * bend * np.ptp(stretches, axis=1) ** 2)
        found = margin(YeohLaw(len(values)), values, "ellipticity", mode, stretch)
        clear = np.abs(known) > 1e-6
        assert (np.sign(found) == np.sign(known))[clear].all() and (known < 0).any()


@pytest.mark.parametrize("values", [[0.2, -0.01, 1.5, -2.0], [0.02, 0.25, -2.0, 1.6]])
@pytest.mark.parametrize("mode, stretch", [("uniaxial", 2.0), ("planar", 3.0), ("equibiaxial", 2)])
def test_no_plane_wave_is_slower_than_the_slowest_one_found(values, mode, stretch):
    rng, h = np.random.default_rng(1), 1e-3
    n = rng.standard_normal((40_000, 3))
    n /= np.linalg.norm(n, axis=1)[:, None]
    m = np.cross(n, rng.standard_normal(n.shape))
    m /= np.linalg.norm(m, axis=1)[:, None]
    F = np.diag(principal(mode, np.array(float(stretch))))
    shear = m[:, :, None] * (n @ F)[:, None, :]  # of a volume that stays as it is

    def energy(t):
        stretches = np.linalg.svd(F + t * shear, compute_uv=False)
        return sum(2 * mu / a**2 * (np.sum(stretches**a, axis=1) - 3)
                   for mu, a in zip(values[:2], values[2:], strict=True))

    waves = (energy(h) - 2 * energy(0.0) + energy(-h)) / h**2
    least = float(margin(OgdenLaw(2), values, "ellipticity", mode, float(stretch)))
    assert least <= waves.min() + 1e-5
    assert waves.min() == pytest.approx(least, abs=0.01 * waves.max())


@pytest.mark.parametrize("law, values", KNOWN, ids=lambda part: getattr(part, "name", ""))
def test_drucker_is_the_slope_of_stress_by_logarithmic_strain(law, values):
    h = 1e-5
    for mode in MODES:
        for stretch in (0.6, 1.0, 2.5):
            strain = np.log(principal(mode, np.array(stretch)))[:2]

            def stress(strain, law=law):
                stretches = np.exp([*strain, -sum(strain)])
                forces = stretches * law.gradient(values, stretches)
                return forces[:2] - forces[2]

            slope = np.array([(stress(strain + d) - stress(strain - d)) / (2 * h)
                              for d in h * np.eye(2)])
            assert margin(law, values, "Drucker", mode, stretch) == pytest.approx(
                np.linalg.eigvalsh(slope)[0], rel=1e-6, abs=1e-9)


def test_stability_asked_for_holds_and_no_stable_neighbour_fits_better(dragon_skin):
    free = dragon_skin
    held = calibrate("dragon_skin_30", max_stretch=4, stable=6.0)
    data, rng = Points.of(held.tests), np.random.default_rng(0)
    stretch = np.geomspace(1.0, 6.0, 40)
    changed = []
    for law in LAWS:
        if law.name not in held.fits:
            continue
        fit = held.fits[law.name]
        margins = [margin(law, fit.values, c, mode, stretch) for c in ENFORCED for mode in MODES]
        assert np.min(margins) > 0.0
        if not fit.held:
            assert fit.values == pytest.approx(free.fits[law.name].values)
            continue
        changed.append(law.name)
        assert np.isnan(fit.errors).all()
        best = squares(law, fit.values, data)
        assert best > squares(law, free.fits[law.name].values, data)
        for size in (0.3, 0.03, 0.003):
            near = fit.values * (1 + size * rng.standard_normal((60, len(fit.values))))
            for values in near:
                if squares(law, values, data) < best * (1 - 1e-3):
                    assert np.min([margin(law, values, c, mode, stretch)
                                   for c in ENFORCED for mode in MODES]) < 1e-4
    assert changed == ["Yeoh, 3 terms", "Mooney-Rivlin"]


def test_a_softening_ogden_law_is_held_stable_too():
    test = made(OgdenLaw(1), [0.3, 0.4], stretch=np.linspace(1.1, 5.0, 30))
    [law] = [law for law in LAWS if law == OgdenLaw(1)]
    free, held = fitted(law, Points.of([test])), fitted(law, Points.of([test]), stable=5.0)
    assert free.values == pytest.approx([0.3, 0.4], rel=1e-5)
    assert held.held and held.rms > free.rms
    stretch = np.geomspace(1.0, 5.0, 60)
    assert np.min([margin(law, held.values, c, mode, stretch)
                   for c in ENFORCED for mode in MODES]) > 0.0


def test_instability_within_the_data_is_told():
    test = made(YeohLaw(3), [0.1, 0.006, -0.0001], stretch=np.linspace(1.1, 5.8, 50))
    found = calibrate(test, terms=3, whole=True)
    assert "unstable in uniaxial tension from stretch" in " ".join(found.sentences())
