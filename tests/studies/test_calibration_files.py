"""Files of tests as machines write them: what is found in them, and what is refused."""

import codecs

import numpy as np
import pytest

from morphing_wing.calibration import BUILT_IN, calibrate, read_test
from morphing_wing.calibration.laws import YeohLaw
from morphing_wing.errors import InputError

pytestmark = pytest.mark.quick

STRETCH = np.linspace(1.0, 3.0, 21)
C = (0.12, 0.004)


@pytest.fixture
def written(tmp_path):
    """Return a function that writes a file and returns its name."""

    def write(text, name="curve.csv", encoding="utf-8"):
        file = tmp_path / name
        file.write_bytes(text if isinstance(text, bytes) else text.encode(encoding))
        return file

    return write


def columns(header, *values, separator=",", decimal="."):
    rows = [separator.join(f"{value:.12g}".replace(".", decimal) for value in row)
            for row in zip(*values, strict=True)]
    return "\n".join([header, *rows]) + "\n"


def nominal(mode="uniaxial"):
    return YeohLaw(2).stress(C, mode, STRETCH)


def test_the_built_in_test_is_the_database_s_file(monkeypatch, tmp_path):
    test = read_test("dragon_skin_30")
    assert (test.stretch.size, test.mode) == (311, "uniaxial")
    assert (test.stretch[0], test.stress[0]) == pytest.approx((1.0446, 0.01736))
    assert "nominal stress 'Engineering Stress (MPa)' against nominal strain" in test.remarks[0]
    monkeypatch.chdir(tmp_path)
    (tmp_path / "dragon_skin_30").write_text(columns("strain,stress_MPa", [0, 1], [0, 0.3]))
    assert read_test("dragon_skin_30").stretch.size == 2  # a file of that name comes first
    assert list(BUILT_IN) == ["dragon_skin_30"]


def test_its_true_columns_say_the_same_as_its_nominal_ones():
    nominal = read_test("dragon_skin_30")
    true = read_test("dragon_skin_30", strain_kind="true", stress_kind="true")
    assert "true stress 'True Stress (MPa)' against true strain" in true.remarks[0]
    assert true.stretch == pytest.approx(nominal.stretch, rel=1e-4)
    assert true.stress == pytest.approx(nominal.stress, rel=0.005, abs=0.001)


@pytest.mark.parametrize("mode", ["uniaxial", "planar", "equibiaxial"])
@pytest.mark.parametrize("strain, header", [
    (STRETCH - 1, "nominal strain"), (100 * (STRETCH - 1), "elongation [%]"),
    (STRETCH, "stretch ratio"), (np.log(STRETCH), "True Strain"), (STRETCH, "lambda (-)")])
@pytest.mark.parametrize("factor, kind, unit", [
    (1.0, "engineering stress", "MPa"), (1e3, "true stress", "kPa"), (145.03773773, "Cauchy", "psi")
])
def test_known_constants_come_out_of_every_kind_and_unit(
        mode, strain, header, factor, kind, unit, written):
    true = kind != "engineering stress"
    stress = factor * nominal(mode) * (STRETCH if true else 1.0)
    name = kind if "stress" in kind else f"{kind} stress"
    file = written(columns(f"{header},{name} ({unit})", strain, stress), f"{mode}.csv")
    test = read_test(file)
    assert test.mode == mode
    assert test.stretch == pytest.approx(STRETCH) and test.stress == pytest.approx(nominal(mode))


@pytest.mark.parametrize("separator, decimal", [
    (";", "."), (";", ","), ("\t", "."), ("\t", ","), (",", "."), ("  ", "."), (" ", ",")])
def test_separator_and_decimal_sign_are_found(separator, decimal, written):
    head = separator.join(["time_s", "strain", "stress_MPa"])
    test = read_test(written(columns(
        head, 0.1 * STRETCH, STRETCH - 1, nominal(), separator=separator, decimal=decimal)))
    assert test.stretch == pytest.approx(STRETCH) and test.stress == pytest.approx(nominal())


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "cp1252"])
def test_encodings_of_machines_programs(encoding, written):
    text = "Prüfung;23 °C\r\n" + columns("Strain;Stress (N/mm²)", [0, 1], [0, 0.3], separator=";")
    test = read_test(written(text.replace("\n", "\r\n"), encoding=encoding))
    assert list(test.stress) == [0, 0.3]


def test_lines_above_units_below_quotes_and_longer_columns_beside(written):
    text = ('"Company; Ltd";1;2\nDate;26.11.2026\n\n"Time";"Tensile strain";"Tensile stress"\n'
            '(s);(%);(kPa)\n"0,1";"0,0";"0"\n0,2;50,0;1,5e2\n0,3;100;300\n0,4;;\n;;\n')
    test = read_test(written(text))
    assert list(test.stretch) == [1.0, 1.5, 2.0] and test.stress == pytest.approx([0, 0.15, 0.3])
    assert list(test.lines) == [6, 7, 8]


def test_columns_are_named_with_unit_or_without_or_by_number(written):
    file = written(columns("t,a (x),b (y),b2", STRETCH, STRETCH - 1, 10 * nominal(), nominal()))
    for strain, stress in (("a (x)", "b2"), ("A", "4"), ("2", "4")):
        test = read_test(file, strain=strain, stress=stress, stress_unit="MPa")
        assert test.stress == pytest.approx(nominal())
    assert read_test(file, strain="a", strain_unit="%", stress="b", stress_unit="MPa",
                     ).stretch == pytest.approx(1 + 0.01 * (STRETCH - 1))


@pytest.mark.parametrize("strain", ["strain %", "strain (%)", "strain_%", "strain [percent]",
                                    "Tensile strain (Extension) (%)", "strain in %", "strain/%"])
@pytest.mark.parametrize("stress", ["stress kPa", "stress [kPa]", "stress_kPa", "stress in kPa",
                                    "stress (of the grip) [kPa]", "sigma/kPa"])
def test_units_are_found_as_people_write_them(strain, stress, written):
    test = read_test(written(f"{strain},{stress}\n0,0\n25,100\n"))
    assert list(test.stretch) == [1.0, 1.25] and test.stress[1] == pytest.approx(0.1)


def test_a_file_without_header_wants_numbers_of_columns(written):
    file = written(columns("", STRETCH, nominal()).lstrip())
    test = read_test(file, strain="1", strain_kind="stretch", stress="2", stress_unit="N/mm2")
    assert test.stress == pytest.approx(nominal()) and test.lines[0] == 1
    with pytest.raises(InputError, match="no column of strain, the file has no header: must be"):
        read_test(file)


@pytest.mark.parametrize("name, header, mode", [
    ("a.csv", "strain,stress (MPa)", "uniaxial"), ("pure_shear.csv", "strain,stress (MPa)",
                                                   "planar"),
    ("a.csv", "pure shear strain,pure shear stress (MPa)", "planar"),
    ("a.csv", "biaxial strain,biaxial stress (MPa)", "equibiaxial"),
    ("bulge.csv", "planar strain,stress (MPa)", "equibiaxial")])
def test_the_mode_is_a_word_in_name_or_header(name, header, mode, written):
    test = read_test(written(columns(header, [0, 1], [0, 1]), name))
    assert test.mode == mode
    assumed = header.startswith("strain") and name == "a.csv"
    assert ("taken for granted" in test.remarks[0]) == assumed
    assert read_test(written(columns(header, [0, 1], [0, 1]), name), mode="planar").mode == "planar"


def test_compression_recovers_the_constants_too(written):
    stretch = np.linspace(1.0, 0.3, 15)
    file = written(columns("strain,stress MPa,x", stretch - 1,
                           YeohLaw(2).stress(C, "uniaxial", stretch), stretch))
    found = calibrate(read_test(file, stress_unit="MPa"))
    assert found.material.coefficients == pytest.approx(C)


GOOD = columns("strain,stress (MPa)", STRETCH - 1, nominal())
BAD = {
    "empty": ("", {}, "is empty, must hold columns of strain and stress"),
    "blank": (" \n;;\n\n", {}, "is empty, must hold columns"),
    "prose": ("Dear all,\nthe test went well.\n", {}, "must hold at least two columns of numbers"),
    "one column": ("stress (MPa)\n1\n2\n", {}, "must hold at least two columns of numbers"),
    "header alone": ("strain,stress (MPa)\n", {}, "must hold at least two columns of numbers"),
    "one row": ("strain,stress (MPa)\n0,0\n", {}, "1 row(s) of numbers under 'strain'"),
    "no strain": ("force,stress (MPa)\n0,0\n1,1\n", {},
                  "no column of strain, none of 'force', 'stress (MPa)' says so: must be named"),
    "no stress": ("strain,force\n0,0\n1,1\n", {}, "no column of stress, none of 'strain', 'force'"),
    "no unit": ("strain,stress\n0,0\n1,1\n", {}, "'stress' has no unit of stress, must have one"),
    "wrong unit": ("strain,stress (mm)\n0,0\n1,1\n", {}, "'stress (mm)' has no unit of stress"),
    "wrong unit given": (GOOD, {"stress_unit": "mm"}, "unit 'mm' must be one of stress, such as"),
    "evil unit": (GOOD, {"stress_unit": "MPa**(9**9**9)"}, "must be one of stress"),
    "zero unit": (GOOD, {"stress_unit": ""}, None),
    "unit of strain": (GOOD, {"strain_unit": "mm"}, "unit 'mm' must be % or 1"),
    "two stresses": ("strain,stress A (MPa),stress B (MPa)\n0,0,0\n1,1,1\n", {},
                     "'stress A (MPa)' and 'stress B (MPa)' both claim to be stress, one must be"),
    "two nominal stresses": (
        "strain,eng. stress (MPa),nominal stress (MPa),true stress (MPa)\n0,0,0,0\n1,1,1,1\n", {},
        "'eng. stress (MPa)' and 'nominal stress (MPa)' both claim to be nominal stress"),
    "two strains": ("strain 1,strain 2,stress (MPa)\n0,0,0\n1,1,1\n", {}, "both claim to be "),
    "same column twice": (GOOD, {"strain": "2", "stress": "2"}, "is named for both strain and"),
    "unknown column": (GOOD, {"stress": "force"}, "stress = 'force': must be one of 'strain', "),
    "column beyond": (GOOD, {"stress": "7"}, "stress = '7': must be one of 'strain'"),
    "NaN": (GOOD.replace("0.5,", "nan,"), {}, "'strain' is 'nan' in line 7: must be a finite numb"),
    "infinite": (GOOD.replace("0.5,", "inf,"), {}, "'strain' is 'inf' in line 7"),
    "hole": (GOOD.replace("0.5,", ","), {}, "'strain' is empty in line 7: must be a finite number"),
    "text in numbers": (GOOD.replace("0.5,", "about 0.5,"), {}, "'about 0.5' in line 7"),
    "overload": (GOOD.replace("0.5,", "----,"), {}, "'strain' is '----' in line 7"),
    "spreadsheet error": (GOOD.replace("0.5,", "#DIV/0!,"), {}, "'strain' is '#DIV/0!' in line 7"),
    "short row": (GOOD.replace("\n0.5,", "\n0.5;"), {}, "in line 7"),
    "footer": (GOOD + "end of test,ok\n", {}, "'strain' is 'end of test' in line 23"),
    "squeezed to nothing": ("strain,stress (MPa)\n0,0\n-1,-9\n", {},
                            "gives stretch 0 in line 3: must be greater than 0"),
    "negative stretch": ("stretch,stress (MPa)\n1,0\n-1,-9\n", {}, "gives stretch -1 in line 3"),
    "overflowing strain": ("true strain,stress (MPa)\n0,0\n900,1\n", {}, "without a unit, must be"),
    "per cent without saying so": ("strain,stress (MPa)\n0,0\n300,1\n", {},
                                   "reaches 300 without a unit, must be at most 30 or have one"),
    "unknown mode": (GOOD, {"mode": "shear"}, "mode = 'shear': must be one of uniaxial, planar"),
    "unknown kind": (GOOD, {"stress_kind": "PK2"}, "stress_kind = 'PK2': must be one of nominal"),
    "unknown strain": (GOOD, {"strain_kind": "Green"}, "strain_kind = 'Green': must be one of"),
    "no weight": (GOOD, {"weight": -1.0}, "weight = -1: must be greater than 0"),
    "a picture": (b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR", {}, "must be a text file, in UTF-8 or as Win"),
    "half of UTF-16": (codecs.BOM_UTF16_LE + b"a\0b", {}, "must be a text file"),
    "broken bytes": (b"strain,stress (MPa)\n0,0\n\x81,1\n", {}, "must be a text file"),
}


@pytest.mark.parametrize("text, options, sentence", BAD.values(), ids=BAD)
def test_what_cannot_be_read_is_refused_in_one_sentence(text, options, sentence, written):
    file = written(text)
    if sentence is None:  # an empty unit is none given
        assert read_test(file, **options).stress == pytest.approx(nominal())
        return
    with pytest.raises(InputError) as refused:
        read_test(file, **options)
    said = str(refused.value)
    assert sentence in said and "\n" not in said
    assert said.startswith((f"{file}: ", f"{file.name}: ", *options))


@pytest.mark.parametrize("name, why", [
    ("none.csv", "cannot be read, no such file"), ("", "cannot be read, is a directory"),
    ("a\0b", "cannot be read, no valid file name"), ("x" * 300, "cannot be read, file name too")])
def test_what_is_no_file_is_refused(name, why, tmp_path):
    with pytest.raises(InputError, match=why):
        read_test(tmp_path / name)
