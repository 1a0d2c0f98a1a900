"""``torque export``: files named as told, nothing half-written, every wrong input told."""

from __future__ import annotations

import io
import json
import sys
import zipfile
from pathlib import Path

import numpy as np
import pytest
import typer

sys.path.insert(0, str(Path(__file__).parents[1] / "oracles"))

from torque_networks import PVA, network

import cqdd_design
from cqdd_design.cli import session
from cqdd_design.cli.torque_export import export_network
from cqdd_design.errors import CqddError, DependencyError, UsageError
from cqdd_design.exporting.estimators.torchscript import client_history
from cqdd_design.torque.networks.artefact import read_artefact, write_artefact
from cqdd_design.torque.networks.predict import predict


@pytest.fixture
def printed(monkeypatch):
    stream = io.StringIO()
    monkeypatch.setattr(session, "standard_output", lambda: stream)
    return stream


@pytest.fixture
def model(tmp_path):
    write_artefact(network(mode="window"), tmp_path / "pva-gru.npz")
    return tmp_path / "pva-gru.npz"


def export(*arguments, **options):
    return export_network(session.Output("export", as_json=True, quiet=True), *arguments, **options)


def test_every_form_is_written_and_listed(printed, model, tmp_path):
    for package in ("torch", "onnx", "onnxruntime"):
        pytest.importorskip(package)
    folder = tmp_path / "files"
    export(model, "onnx,torchscript-isaaclab,newton,mjlab,c", folder)
    document = json.loads(printed.getvalue())
    names = {Path(one["path"]).name for one in document["files"]}
    assert names == {path.name for path in folder.iterdir()}
    assert {"pva-gru.h", "pva-gru-newton.onnx", "pva-gru-window.onnx", "pva-gru-mjlab.pt"} <= names
    assert {
        "pva-gru-isaaclab-mlp.pt",
        "pva-gru-isaaclab-lstm.pt",
        "pva-gru-isaaclab-gru.pt",
    } <= names
    assert document["results"]["inputs"] == list(PVA)
    assert document["results"]["sample_dt_s"] == 0.005
    assert any("acceleration" in sentence for sentence in document["warnings"])


def test_torchscript_tells_nothing_of_the_place_it_was_made_at(printed, model, tmp_path):
    """Neither the package's folder nor torch's; what is left still loads and gives the torque."""
    torch = pytest.importorskip("torch")
    export(model, "torchscript-isaaclab,mjlab", tmp_path)
    written = sorted(tmp_path.glob("*.pt"))
    assert len(written) == 4
    places = [str(Path(module.__file__).parents[1]).encode() for module in (cqdd_design, torch)]
    for path in written:
        with zipfile.ZipFile(path) as archive:
            parts = [archive.read(name) for name in archive.namelist()]
        assert not any(place in part for place in places for part in (path.read_bytes(), *parts))
    artefact = read_artefact(model)
    window = np.random.default_rng(3).uniform(-0.1, 0.1, (client_history(artefact), 2))
    asked = torch.tensor(window[::-1].T.reshape(1, -1).copy(), dtype=torch.float32)
    velocity = window[:, 1]
    taps = len(artefact.differentiator.taps)
    rate = np.convolve(velocity, artefact.differentiator.taps, mode="valid")
    features = np.column_stack([window[taps - 1 :, 0], velocity[taps - 1 :], rate])
    wanted = predict(artefact, features, engine="plain")[-1]
    for name in ("pva-gru-isaaclab-mlp.pt", "pva-gru-mjlab.pt"):
        found = torch.jit.load(str(tmp_path / name))(asked)
        assert float(found) == pytest.approx(wanted, abs=1e-4)


def test_what_the_torque_is_and_of_which_design_is_told(printed, model, tmp_path):
    """In the terminal; with the design of today whether that is the one of the training."""
    data = {"source": "simulated", "design": "cqdd-10", "design_sha256": "a" * 64}
    write_artefact(network(mode="window", facts={"data": data}), model)
    design = Path(__file__).parents[2] / "designs" / "cqdd-10.toml"
    out = session.Output("export", as_json=False, quiet=False)
    export_network(out, model, "c", tmp_path / "out", design=design)
    said = " ".join(printed.getvalue().split())
    assert "Set armature, damping and friction of the joint to 0" in said
    assert "low-pass of second order (80 Hz" in said
    assert "that of cqdd-10 (sha256 aaaaaaaa)" in said
    assert any("the design has moved on" in one for one in out.warnings)
    with pytest.raises(UsageError, match="--motor belongs to a design"):
        export_network(out, model, "c", tmp_path / "other", motor="any")


def test_the_same_network_gives_the_same_bytes(printed, model, tmp_path):
    pytest.importorskip("onnxruntime")
    for name in ("a", "b"):
        export(model, "onnx,c", tmp_path / name)
    for path in (tmp_path / "a").iterdir():
        assert path.read_bytes() == (tmp_path / "b" / path.name).read_bytes()


def test_nothing_is_overwritten_without_force(printed, model, tmp_path):
    export(model, "c", tmp_path / "out")
    with pytest.raises(UsageError, match="--force"):
        export(model, "c", tmp_path / "out")
    export(model, "c", tmp_path / "out", force=True)


def test_default_place_is_a_folder_of_the_models_name(printed, model, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    export(model, "c")
    export(model, "c")
    assert (tmp_path / "exports" / "pva-gru" / "pva-gru.h").is_file()


@pytest.mark.parametrize(
    ("to", "words"),
    [("newtn", "did you mean 'newton'"), ("", "no kind"), ("c,x", "'x' is not a kind")],
)
def test_a_wrong_list_is_told(printed, model, tmp_path, to, words):
    with pytest.raises(UsageError, match=words):
        export(model, to, tmp_path / "out")
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("to", ["c,newton", "newton,c"])
def test_a_refusal_of_one_kind_keeps_the_others(printed, tmp_path, to):
    model, folder = tmp_path / "mlp.npz", tmp_path / "out"
    write_artefact(network("mlp"), model)
    assert export(model, to, folder) == UsageError.exit_code
    document = json.loads(printed.getvalue())
    assert [path.name for path in folder.iterdir()] == ["mlp.h"]
    assert [one["path"] for one in document["files"]] == [str(folder / "mlp.h")]
    (told,) = document["warnings"]
    assert told.startswith("newton was not written: ")
    assert "takes a GRU" in told


def test_nothing_but_refusals_is_an_error(printed, tmp_path):
    write_artefact(network("mlp"), tmp_path / "mlp.npz")
    with pytest.raises(UsageError, match="takes a GRU"):
        export(tmp_path / "mlp.npz", "newton", tmp_path / "out")
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("content", [b"", b"\x80\x04K\x01.", b"PK\x03\x04broken"])
def test_a_file_that_is_no_network_is_told(printed, tmp_path, content):
    path = tmp_path / "net.npz"
    path.write_bytes(content)
    with pytest.raises(UsageError, match="not a torque network"):
        export(path, "c", tmp_path / "out")
    with pytest.raises(UsageError, match="there is no"):
        export(tmp_path / "none.npz", "c", tmp_path / "out")


def test_a_missing_package_says_what_to_install(printed, model, tmp_path, monkeypatch):
    for kind, package in (("onnx", "onnx"), ("newton", "onnx"), ("mjlab", "torch")):
        with monkeypatch.context() as patch:
            patch.setitem(sys.modules, package, None)
            with pytest.raises(DependencyError, match=r"cqdd-design\[torque\]") as caught:
                export(model, kind, tmp_path / "out")
            assert isinstance(caught.value, CqddError)
            assert caught.value.exit_code == 5
            assert export(model, f"{kind},c", tmp_path / kind) == 5
            assert [path.name for path in (tmp_path / kind).iterdir()] == ["pva-gru.h"]


def test_it_is_a_command_with_the_common_options(printed, model, tmp_path):
    app = typer.Typer()
    app.command("export")(session.command(export_network))
    application = typer.main.get_command(app)
    arguments = [str(model), "--to", "c", "--out", str(tmp_path / "out"), "--json"]
    application.main(arguments, standalone_mode=False)
    assert json.loads(printed.getvalue())["files"][0]["kind"] == "c"
