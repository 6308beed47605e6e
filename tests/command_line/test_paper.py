"""The contract of `morphing-wing paper`; the study of Figure 7 is a stand-in."""

import io
import json
from types import SimpleNamespace

import pandas as pd
import pytest
from mpi4py import MPI

from morphing_wing import figure7 as module
from morphing_wing import figure7_result
from morphing_wing import reach as map_module
from morphing_wing.cli import main
from morphing_wing.figure6 import study as figure6_module
from morphing_wing.figure7_result import Curve, Figure7
from morphing_wing.ladder import LADDERS
from morphing_wing.path import Path, State
from morphing_wing.record import SceneRecord

pytestmark = pytest.mark.quick

SCENE = SceneRecord("wing", "draft", 7, "pressure_MPa", MPI.COMM_SELF, {})


FURTHER = {"table2": ["levels.csv"], "table3": ["levels.csv"], "fig6": ["sensitivities.csv"]}


def path(panel, loads, converged):
    name, angle = {"pressure": ("upper_MPa", "span_angle_deg"),
                   "cables": ("cable_N", "chord_angle_deg")}[panel]
    states = [State({"upper_MPa": 0.0, "lower_MPa": 0.0, "cable_N": 0.0} | {name: load},
                    {"span_angle_deg": 0.0, "span_line_deg": 0.0, "chord_angle_deg": 0.0,
                     "chord_line_deg": 0.0} | {angle: 100.0 * load}, 3, 1.0, 1.0, 0, 0.1, True)
              for load in loads]
    return Path(states, SCENE, converged, "the end" if converged else "Newton diverged", 0.1)


@pytest.fixture
def asked(monkeypatch, tmp_path):
    """Replace the study by one that remembers what it was asked for; stop its cables on wish."""
    monkeypatch.chdir(tmp_path)
    found = SimpleNamespace(calls=[], cables_converge=True, maps=[])

    def figure7(fidelities, pressures, tensions, skins, directions, geometry, panels, comm, begin,
                done, contact):
        found.calls.append((fidelities, list(pressures), list(tensions), skins, directions))
        found.contact, found.skin_root, found.panels = contact, geometry.skin_root, panels
        study = Figure7(comm)
        for panel in panels:
            loads = {"pressure": pressures, "cables": tensions}[panel]
            ok = panel == "pressure" or found.cables_converge
            curve = Curve(panel, skins[0], directions[0], fidelities[-1])
            begin(curve, SimpleNamespace(dofs=7, comm=comm)).end(ok, "")
            study.paths[curve] = path(panel, loads, ok)
            done(study, curve, path(panel, [], ok))
        return study

    def reach(pressures, tensions, fidelity, geometry, begin, contact):
        found.maps.append((len(pressures), len(tensions), geometry.skin_thickness,
                           geometry.skin_root))
        return map_module.Reach(path("pressure", pressures, True))

    monkeypatch.setattr(module, "figure7", figure7)
    monkeypatch.setattr(figure7_result, "draw", lambda table, file, stopped: file.touch())
    monkeypatch.setattr(map_module, "reach", reach)
    return found


def test_by_default_draft_eight_points_with_skin_and_without_downwards(asked, tmp_path, capsys):
    assert main(["paper", "fig7"]) == 0
    ((fidelities, pressures, tensions, skins, directions),) = asked.calls
    assert (fidelities, skins, directions) == (("draft",), (True, False), ("down",))
    assert (asked.contact, asked.skin_root) == (True, "clamped")
    assert asked.panels == ("pressure", "cables")
    assert pressures[::8] == pytest.approx([0.0, 0.04]) and len(pressures) == 9
    assert tensions[::8] == pytest.approx([0.0, 0.5]) and len(tensions) == 9
    folder = tmp_path / "output" / "fig7"
    assert {f.name for f in folder.iterdir()} >= {"fig7.png", "table.csv", "summary.json"}
    assert json.loads((folder / "summary.json").read_text())["converged"] is True
    said = capsys.readouterr().out
    assert "results are in output/fig7" in said and "not reached" in said


def test_options_choose_what_is_run(asked):
    assert main(["paper", "fig7", "--fidelity", "draft", "--fidelity", "standard", "--skin", "off",
                 "--points", "2", "--both-directions", "--skin-root", "free", "--no-contact",
                 "--panel", "cables", "--out", "here"]) == 0
    assert (asked.contact, asked.skin_root, asked.panels) == (False, "free", ("cables",))
    assert asked.calls == [(("draft", "standard"), [0.0, 0.02, 0.04], [0.0, 0.25, 0.5], (False,),
                            ("down", "up"))]


def test_a_curve_that_stopped_is_status_3_and_what_was_reached_is_written(asked, tmp_path):
    asked.cables_converge = False
    assert main(["paper", "fig7", "--out", "here"]) == 3
    summary = json.loads((tmp_path / "here" / "summary.json").read_text())
    assert summary["converged"] is False
    assert summary["reason"] == "cables, with skin, down, draft: Newton diverged"


def test_the_map_is_run_where_it_is_asked_for(asked, tmp_path):
    assert main(["paper", "fig7", "--map", "--map-points", "3x2", "--skin-root", "free",
                 "--out", "here"]) == 0
    assert asked.maps == [(3, 2, 1.0, "free"), (3, 2, None, "clamped")]
    assert (tmp_path / "here" / "map_with_skin_down_draft" / "map.png").exists()


@pytest.mark.parametrize("arguments, sentence", [
    (["fig8"], "table or figure = 'fig8': must be one of table2, table3, fig5, fig6, fig7"),
    (["table2", "--skin", "on"], "--skin: must be left out of table2, it is an option of fig7"),
    (["fig5", "--one-direction"], "--both-directions: must be left out of fig5, it is an option"),
    (["table3", "--map"], "--map: must be left out of table3, it is an option of fig7"),
    (["table3", "--points", "4"], "--points: must be left out of table3, it is an option of fig5 "
                                  "and fig7"),
    (["fig6", "--points", "4"], "--points: must be left out of fig6, it is an option of fig5 and"),
    (["fig5", "--resume"], "--resume: must be left out of fig5, it is an option of fig6"),
    (["fig6", "--reading", "round"], "--reading = 'round': must be flush, square or both"),
    (["fig6", "--fidelity", "best"], "--fidelity = 'best': must be one of instant, cell, draft"),
    (["fig6", "--resume"], "--resume: output/fig6 must hold a solved.csv of a run to go on with"),
    (["table3", "--fidelity", "cheap"], "--fidelity = 'cheap': must be one of instant, cell"),
    (["table2", "--fidelity", "instant", "--fidelity", "best"], "--fidelity = 'best': must be one"),
    (["fig5", "--fidelity", "best"], "--fidelity = 'best': must be one of instant, cell, draft"),
    (["fig5", "--points", "0"], "--points = 0: must be at least 1"),
    (["fig7", "--fidelity", "best"], "--fidelity = 'best': must be one of draft, standard"),
    (["fig7", "--points", "0"], "--points = 0: must be at least 1"),
    (["fig7", "--points", "many"], "Invalid value for '--points'"),
    (["fig7", "--skin-root", "glued"], "skin_root = 'glued': must be 'clamped' or 'free'"),
    (["fig7", "--panel", "B-2"], "--panel = 'B-2': must be pressure, cables or both"),
    (["fig7", "--skin", "thick"], "--skin = 'thick': must be on, off or both"),
    (["fig7", "--map-points", "3x2"], "--map-points: must be left out without --map"),
    (["fig7", "--map", "--map-points", "1x4"], "--map-points = '1x4': must be two numbers"),
    (["fig7", "--map", "--map-points", "four"], "--map-points = 'four': must be two numbers"),
    ([], "Missing argument"),
])
def test_bad_input_is_one_sentence_and_leaves_nothing(arguments, sentence, asked, tmp_path, capfd):
    assert sentence in refused(capfd, *arguments)
    assert asked.calls == [] and list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name, said", [
    ("table2", "none: nothing is fitted"), ("table3", "32.33 N mm, fitted"),
    ("fig5", "26.13 deg at 30 kPa"), ("fig6", "l_s1 has 75% of h_t's effect")])
def test_tables_and_figures_by_the_formulas(name, said, asked, tmp_path, capsys):
    assert main(["paper", name, "--fidelity", "instant"]) == 0
    folder = tmp_path / "output" / name
    assert {file.name for file in folder.iterdir()} == {
        f"{name}.png", "table.csv", "summary.json", *FURTHER.get(name, ())}
    summary = json.loads((folder / "summary.json").read_text())
    assert summary["study"] == name and summary["fidelity"] == "instant"
    printed = capsys.readouterr().out
    assert said in printed and f"results are in output/{name}" in printed
    assert name != "table3" or "Misprint: Table 3 has 24.354" in printed


def test_figure_6_goes_on_after_the_cases_that_were_solved(asked, monkeypatch, tmp_path, capsys):
    for scene in ("Spar", "Rib"):  # formulas in the place of finite elements
        formula = getattr(figure6_module, scene)
        monkeypatch.setattr(figure6_module, scene, lambda shape, fidelity, comm, kind=formula: kind(
            shape, fidelity="instant", comm=comm))
    monkeypatch.setattr(figure6_module, "Bulge", lambda scene: None)
    figure6 = ["paper", "fig6", "--fidelity", "draft", "--reading", "flush", "--out", "here"]
    assert main(figure6) == 0
    kept = tmp_path / "here" / "solved.csv"
    cases, whole = kept.read_text().splitlines(), (tmp_path / "here" / "table.csv").read_text()
    kept.write_text("\n".join(cases[:-3]) + "\n")  # killed before the last three
    capsys.readouterr()
    assert main([*figure6, "--resume"]) == 0
    said = capsys.readouterr().out
    assert f"{len(cases) - 4} case(s) were solved before" in said
    assert [line.split(":")[0] for line in said.splitlines() if "rib, draft, flush, " in line
            and " of 16" in line] == [f"rib, draft, flush, {i} of 16" for i in (14, 15, 16)]
    assert same_but_for_seconds(whole, (tmp_path / "here" / "table.csv").read_text())


def same_but_for_seconds(*texts):
    first, second = (pd.read_csv(io.StringIO(text)).drop(columns="seconds") for text in texts)
    return first.equals(second)


def test_a_rung_that_only_one_half_of_figure_5_has_wants_another_beside_it(asked, monkeypatch,
                                                                           capfd):
    monkeypatch.setitem(LADDERS, "rib", ("instant", "draft"))
    assert "the rib has no such rung" in refused(capfd, "fig5", "--fidelity", "cell")


def test_a_file_in_the_place_of_the_folder_is_refused_before_anything_is_run(asked, tmp_path,
                                                                             capfd):
    (tmp_path / "taken").write_text("precious")
    for name in ("fig5", "fig6", "fig7", "table2"):
        assert "must be a folder" in refused(capfd, name, "--out", "taken")
    assert asked.calls == []


def refused(capfd, *arguments):
    assert main(["paper", *arguments]) == 2
    said = capfd.readouterr()
    assert said.out == "" and said.err.count("\n") == 1
    return said.err
