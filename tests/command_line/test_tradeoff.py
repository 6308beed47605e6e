"""``morphing-wing tradeoff``: rows, files, who beats whom."""

import json

import pandas as pd
import pytest

from morphing_wing.cli import main
from morphing_wing.ladder import LADDERS
from morphing_wing.tradeoff.front import beaten_by


def test_rib_is_measured_now(tmp_path, capsys, monkeypatch):
    monkeypatch.setitem(LADDERS, "rib", ("instant", "draft"))  # the others take minutes
    assert main(["tradeoff", "rib", "--out", str(tmp_path)]) == 0
    table = pd.read_csv(tmp_path / "tradeoff.csv")
    assert list(table["fidelity"]) == ["instant", "draft"] * 4
    draft = table[table["fidelity"] == "draft"]
    assert (draft["error"].abs() < 0.05).all() and (draft["dofs"] > 0).all()
    parts = draft["assembly_s"] + draft["factor_s"]
    assert (parts > 0.0).all() and (parts < draft["seconds"]).all()
    assert (draft["peak_MB"] > 50).all()
    summary = json.loads((tmp_path / "summary.json").read_text())
    assert len(summary["rows"]) == 8 and summary["scene"] == "rib"
    assert (tmp_path / "tradeoff.png").stat().st_size > 10_000
    said = capsys.readouterr().out
    assert "3.3, flush, N = 6, 1 N mm" in said and str(tmp_path) in said


@pytest.mark.quick
def test_a_rung_is_beaten_only_in_its_own_case_and_in_both():
    rows = [("a", 1, "x", "one", 1.0, 0.10), ("a", 1, "x", "two", 2.0, -0.20),
            ("a", 1, "x", "three", 3.0, 0.05), ("b", 1, "x", "two", 2.0, -0.20),
            ("b", 1, "x", "one", 9.0, 0.20)]
    names = ["case", "n_cells", "load", "fidelity", "seconds", "error"]
    table = pd.DataFrame(rows, columns=names)
    assert beaten_by(table) == ["", "one", "", "", ""]


@pytest.mark.quick
@pytest.mark.parametrize("arguments, sentence", [
    (["fuselage"], "scene = 'fuselage': must be one of spar, rib, wing"),
    (["rib", "--out", "/proc/version"], "--out /proc/version: must be a folder"),
])
def test_bad_input_is_one_sentence(arguments, sentence, capsys):
    assert main(["tradeoff", *arguments]) == 2
    said = capsys.readouterr().err
    assert sentence in said and len(said.splitlines()) == 1
