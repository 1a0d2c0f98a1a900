"""Exported estimators in the clients' own code: onnxruntime, Isaac Lab, mjlab, Newton.

Isaac Lab and mjlab are installed without their dependencies (``pip install --no-deps
isaaclab==2.3.2.post1 mjlab==1.6.0``); their own actuator modules are imported from there, and only
what these import of the simulator around them is replaced. Newton runs whole.
"""

from __future__ import annotations

import importlib
import importlib.util
import io
import json
import sys
from pathlib import Path
from types import ModuleType, SimpleNamespace

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "oracles"))

from torque_networks import DT, PV, PVA, features, joint, motion, network

from cqdd_design.errors import UsageError
from cqdd_design.exporting.estimators.export import export_artefact
from cqdd_design.exporting.estimators.options import require_settings
from cqdd_design.torque.networks.predict import Streaming, predict

torch = pytest.importorskip("torch")
pytest.importorskip("onnx")
onnxruntime = pytest.importorskip("onnxruntime")
torch.set_num_threads(1)

TOLERANCE = 1e-5
WIDE = 1e6
"""Limits of the clients' motor envelopes, out of the way."""
KNOWN = {
    "data": {"source": "simulated"},
    "label_range_Nm": [-200.0, 90.0],
    "speed_range_rad_per_s": [-9.0, 8.0],
}
"""Of a network whose file says what its labels are."""
STREAMING = {"pva": network(), "pv": network(inputs=PV, seed=2)}
WINDOWS = {
    "pva-gru": network(mode="window", history=12),
    "pv-gru": network(inputs=PV, mode="window", history=12, seed=2),
    "mlp": network("mlp", inputs=PV, facts=KNOWN),
    "mlp-acceleration": network("mlp", activation="tanh"),
}


def golden(artefact, samples: int = 1) -> float:
    """The estimator's torque of a positive position error, all else zero, `samples` long."""
    error = np.full(max(samples, artefact.history), 0.3)
    raw = features(artefact, error, np.zeros(len(error)))
    found = predict(artefact, raw, engine="plain")
    return float(found[samples - 1] if artefact.mode == "streaming" else found[-1])


def two_joints(samples: int) -> tuple[np.ndarray, np.ndarray]:
    """Position errors and velocities (N, 2) of joints that move unlike each other."""
    pairs = [joint(samples, seed) for seed in (1, 2)]
    return tuple(np.column_stack(columns) for columns in zip(*pairs, strict=True))


def wanted_torque(artefact, error: np.ndarray, velocity: np.ndarray) -> np.ndarray:
    columns = [
        predict(artefact, features(artefact, error[:, i], velocity[:, i]), engine="plain")
        for i in range(error.shape[1])
    ]
    return np.column_stack(columns)


# onnxruntime ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "artefact", [*STREAMING.values(), network(inputs=(*PVA, "balance"), residual=True)]
)
def test_onnxruntime_streams(tmp_path, artefact):
    export_artefact(artefact, ["onnx"], tmp_path, "net")
    session = onnxruntime.InferenceSession(tmp_path / "net-streaming.onnx")
    raw = np.stack([motion(artefact, 200, seed) for seed in (1, 2)], 1)
    hidden = np.zeros((artefact.layers, 2, artefact.hidden), np.float32)
    found = []
    for row in raw.astype(np.float32):
        torque, hidden = session.run(None, {"features": row, "hidden": hidden})
        found.append(torque)
    wanted = np.column_stack([predict(artefact, raw[:, i], engine="plain") for i in (0, 1)])
    np.testing.assert_allclose(found, wanted, atol=TOLERANCE, rtol=0.0)


@pytest.mark.parametrize(
    "artefact",
    [
        *WINDOWS.values(),
        network("mlp", activation="elu"),
        network("mlp", activation="relu"),
        network("mlp", inputs=(*PV, "balance"), residual=True),
    ],
)
def test_onnxruntime_runs_windows(tmp_path, artefact):
    export_artefact(artefact, ["onnx"], tmp_path, "net")
    session = onnxruntime.InferenceSession(tmp_path / "net-window.onnx")
    raw = motion(artefact, 60)
    view = np.lib.stride_tricks.sliding_window_view(raw, artefact.history, axis=0)
    windows = view.swapaxes(1, 2).astype(np.float32)
    (found,) = session.run(None, {"window": windows})
    wanted = predict(artefact, raw, engine="plain", mode="window")[artefact.history - 1 :]
    np.testing.assert_allclose(found, wanted, atol=TOLERANCE, rtol=0.0)
    told = json.loads(session.get_modelmeta().custom_metadata_map["metadata"])
    assert told["inputs"] == list(artefact.inputs)
    assert told["sample_dt_s"] == DT
    assert told["position_gain_Nm_per_rad"] == 60.0
    assert told["torque_range_Nm"] == artefact.facts.get("label_range_Nm", [-90.0, 90.0])


# Isaac Lab --------------------------------------------------------------------------------------


def package_folder(name: str) -> Path:
    """Where an installed package lies, without importing it."""
    found = importlib.util.find_spec(name)
    if found is None or not found.submodule_search_locations:
        pins = {"isaaclab": "isaaclab==2.3.2.post1", "mjlab": "mjlab==1.6.0"}
        pytest.skip(f"{name} is not installed (pip install --no-deps {pins[name]})")
    return Path(next(iter(found.submodule_search_locations)))


def stub(patch: pytest.MonkeyPatch, name: str, folder: Path | None = None, **content):
    """A module that is not the client's actuator code: empty, or a package without its start."""
    module = ModuleType(name)
    vars(module).update(content)
    if folder:
        module.__path__ = [str(folder)]
    patch.setitem(sys.modules, name, module)
    return module


def unload(patch: pytest.MonkeyPatch, root: str) -> None:
    for name in [name for name in sys.modules if name == root or name.startswith(f"{root}.")]:
        patch.delitem(sys.modules, name)


@pytest.fixture
def isaaclab():
    """Isaac Lab's own `actuator_net` and its type of actions."""
    folder = package_folder("isaaclab")
    inside = next(
        path.parent
        for path in (folder / "source/isaaclab/isaaclab/actuators", folder / "actuators")
        if path.is_dir()
    )
    with pytest.MonkeyPatch.context() as patch:
        unload(patch, "isaaclab")
        stub(patch, "isaaclab", inside)
        stub(
            patch,
            "isaaclab.utils",
            inside / "utils",
            DelayBuffer=object,
            LinearInterpolation=object,
        )
        stub(patch, "isaaclab.utils.string")
        stub(
            patch,
            "isaaclab.utils.assets",
            read_file=lambda path: io.BytesIO(Path(path).read_bytes()),
        )
        stub(patch, "isaaclab.actuators", inside / "actuators")
        net = importlib.import_module("isaaclab.actuators.actuator_net")
        types = importlib.import_module("isaaclab.utils.types")
        yield SimpleNamespace(net=net, actions=types.ArticulationActions)
        unload(patch, "isaaclab")


def isaaclab_actuator(client, kind: str, settings: Path, envs: int = 1, joints: int = 2):
    """The client's own class, configured from the exported JSON alone."""
    told = json.loads(settings.read_text())
    assert told["class"] == f"{kind}Cfg"
    own = dict.fromkeys(
        (
            "effort_limit_sim",
            "velocity_limit_sim",
            "stiffness",
            "damping",
            "armature",
            "friction",
            "dynamic_friction",
            "viscous_friction",
        )
    )
    own |= {"effort_limit": WIDE, "velocity_limit": WIDE, "saturation_effort": WIDE}
    own |= told["configuration"]
    own["network_file"] = str(settings.with_name(own["network_file"]))
    names = [f"joint_{i}" for i in range(joints)]
    return getattr(client.net, kind)(
        SimpleNamespace(**own), names, slice(None), num_envs=envs, device="cpu"
    )


def isaaclab_run(client, actuator, error: np.ndarray, velocity: np.ndarray) -> np.ndarray:
    """Torques (N, joints) where the joints stand at 0.5 rad and their targets beyond."""
    found = []
    for e, v in zip(error, velocity, strict=True):
        position = torch.full((1, len(e)), 0.5)
        target = position + torch.tensor(e[None], dtype=torch.float32)
        action = client.actions(joint_positions=target)
        speed = torch.tensor(v[None], dtype=torch.float32)
        found.append(actuator.compute(action, position, speed).joint_efforts[0].numpy().copy())
    return np.array(found)


@pytest.mark.parametrize("name", list(WINDOWS))
def test_isaaclab_runs_windows_in_its_mlp_class(tmp_path, isaaclab, name):
    artefact = WINDOWS[name]
    export_artefact(artefact, ["torchscript-isaaclab"], tmp_path, "net")
    settings = tmp_path / "net-isaaclab-mlp.json"
    error, velocity = two_joints(60)
    actuator = isaaclab_actuator(isaaclab, "ActuatorNetMLP", settings)
    found = isaaclab_run(isaaclab, actuator, error, velocity)
    full = json.loads(settings.read_text())["configuration"]["input_idx"][-1]
    wanted = wanted_torque(artefact, error, velocity)
    np.testing.assert_allclose(found[full:], wanted[full:], atol=TOLERANCE, rtol=0.0)
    # Backwards in time it would be another torque: the order is right.
    turned = wanted_torque(artefact, error[::-1], velocity[::-1])
    assert np.abs(turned[-1] - found[-1]).max() > 1e-2
    actuator.reset(slice(None))
    steady = isaaclab_run(isaaclab, actuator, np.full((full + 1, 2), 0.3), np.zeros((full + 1, 2)))
    assert steady[-1] == pytest.approx(golden(artefact), abs=TOLERANCE)
    assert np.sign(steady[-1][0]) == np.sign(golden(artefact))


def test_isaaclab_takes_the_limits_and_the_bare_joint_of_the_settings(tmp_path, isaaclab):
    """What the training's labels reach is not clipped, and nothing of the actuator is left."""
    facts = {
        "data": {"source": "simulated"},
        "label_range_Nm": [-120.0, 150.0],
        "speed_range_rad_per_s": [-9.0, 8.0],
    }
    artefact = network("mlp", inputs=PV, facts=facts)
    export_artefact(artefact, ["torchscript-isaaclab"], tmp_path, "net")
    actuator = isaaclab_actuator(isaaclab, "ActuatorNetMLP", tmp_path / "net-isaaclab-mlp.json")
    assert float(actuator.effort_limit.max()) == 150.0
    for name in ("armature", "friction", "dynamic_friction", "viscous_friction"):
        assert float(getattr(actuator, name).max()) == 0.0
    error, velocity = two_joints(60)
    found = isaaclab_run(isaaclab, actuator, error, velocity)
    wanted = wanted_torque(artefact, error, velocity)
    full = artefact.history
    np.testing.assert_allclose(found[full:], wanted[full:], atol=TOLERANCE, rtol=0.0)


@pytest.mark.parametrize("name", list(STREAMING))
def test_isaaclab_streams_a_gru_in_its_lstm_class(tmp_path, isaaclab, name):
    artefact = STREAMING[name]
    export_artefact(artefact, ["torchscript-isaaclab"], tmp_path, "net")
    settings = tmp_path / "net-isaaclab-lstm.json"
    error, velocity = two_joints(300)
    actuator = isaaclab_actuator(isaaclab, "ActuatorNetLSTM", settings)
    wanted = wanted_torque(artefact, error, velocity)
    found = isaaclab_run(isaaclab, actuator, error, velocity)
    np.testing.assert_allclose(found, wanted, atol=TOLERANCE, rtol=0.0)
    actuator.reset([0])
    again = isaaclab_run(isaaclab, actuator, error[:20], velocity[:20])
    np.testing.assert_allclose(again, wanted[:20], atol=TOLERANCE, rtol=0.0)
    actuator.reset([0])
    first = isaaclab_run(isaaclab, actuator, np.full((1, 2), 0.3), np.zeros((1, 2)))[0]
    assert first == pytest.approx(golden(artefact), abs=TOLERANCE)
    assert np.sign(first[0]) == np.sign(golden(artefact))


@pytest.mark.parametrize("name", list(STREAMING))
def test_the_gru_form_streams_with_a_state_as_large_as_its_submodule_tells(tmp_path, name):
    """As the proposed class sizes its state: layers and width from `.gru`'s own weights."""
    artefact = STREAMING[name]
    export_artefact(artefact, ["torchscript-isaaclab"], tmp_path, "net")
    extra = {"metadata.json": ""}
    file = torch.jit.load(str(tmp_path / "net-isaaclab-gru.pt"), _extra_files=extra)
    assert json.loads(extra["metadata.json"])["sample_dt_s"] == DT
    weights = file.gru.state_dict()
    hidden = torch.zeros(len(weights) // 4, 2, weights["weight_hh_l0"].shape[1])
    error, velocity = two_joints(300)
    found = []
    with torch.inference_mode():
        for e, v in zip(error, velocity, strict=True):
            x = torch.tensor(np.stack([e, v], 1)[:, None], dtype=torch.float32)
            torque, hidden = file(x, hidden)
            found.append(torque.reshape(2).numpy().copy())
    wanted = wanted_torque(artefact, error, velocity)
    np.testing.assert_allclose(found, wanted, atol=TOLERANCE, rtol=0.0)


# mjlab ------------------------------------------------------------------------------------------


@pytest.fixture
def mjlab():
    """mjlab's own actuators and buffers, without its simulator."""
    pytest.importorskip("mujoco")
    folder = package_folder("mjlab")
    with pytest.MonkeyPatch.context() as patch:
        unload(patch, "mjlab")
        stub(patch, "mujoco_warp")
        stub(patch, "mjlab", folder)
        stub(patch, "mjlab.actuator", folder / "actuator")
        stub(patch, "mjlab.utils", folder / "utils")
        stub(patch, "mjlab.utils.spec", create_motor_actuator=None)
        learned = importlib.import_module("mjlab.actuator.learned_actuator")
        yield learned
        unload(patch, "mjlab")


@pytest.mark.parametrize("name", list(WINDOWS))
def test_mjlab_runs_windows(tmp_path, mjlab, name):
    artefact = WINDOWS[name]
    export_artefact(artefact, ["mjlab"], tmp_path, "net")
    told = json.loads((tmp_path / "net-mjlab.json").read_text())
    own = told["configuration"]
    own["network_file"] = str(tmp_path / own["network_file"])
    own = dict.fromkeys(("effort_limit", "saturation_effort", "velocity_limit"), WIDE) | own
    configuration = mjlab.LearnedMlpActuatorCfg(target_names_expr=(".*",), **own)
    if name == "mlp":
        joint = (configuration.armature, configuration.frictionloss, configuration.viscous_damping)
        assert joint == (0.0, 0.0, 0.0)
        assert configuration.effort_limit == 200.0
    entity = SimpleNamespace(indexing=SimpleNamespace(ctrl_ids=torch.zeros(0, dtype=torch.long)))
    actuator = configuration.build(entity, [0, 1], ["a", "b"])
    actuator.initialize(None, None, SimpleNamespace(nworld=1), "cpu")
    error, velocity = two_joints(60)

    def run(error, velocity):
        found = []
        for e, v in zip(error, velocity, strict=True):
            position = torch.full((1, 2), 0.5)
            zero = torch.zeros(1, 2)
            command = mjlab.ActuatorCmd(
                position_target=position + torch.tensor(e[None], dtype=torch.float32),
                velocity_target=zero,
                effort_target=zero,
                pos=position,
                vel=torch.tensor(v[None], dtype=torch.float32),
            )
            found.append(actuator.compute(command)[0].numpy().copy())
        return np.array(found)

    found, full = run(error, velocity), own["history_length"] - 1
    wanted = wanted_torque(artefact, error, velocity)
    np.testing.assert_allclose(found[full:], wanted[full:], atol=TOLERANCE, rtol=0.0)
    actuator.reset()
    # mjlab fills its history with the first sample: a steady error is there at once.
    first = run(np.full((1, 2), 0.3), np.zeros((1, 2)))[0]
    assert first == pytest.approx(golden(artefact), abs=TOLERANCE)
    assert np.sign(first[0]) == np.sign(golden(artefact))


# Newton -----------------------------------------------------------------------------------------


@pytest.fixture
def newton():
    pytest.importorskip(
        "newton", reason="newton is not installed (pip install 'newton[onnx]==1.8.0')"
    )
    import warp

    warp.config.quiet = True
    return importlib.import_module("newton.actuators"), warp


def newton_case(newton, model: Path, joints: int = 2):
    actuators, warp = newton
    index = warp.array(np.arange(joints, dtype=np.uint32), device="cpu")
    actuator = actuators.Actuator(indices=index, drive=actuators.DriveNeuralGRU(str(model)))
    arrays = {
        name: warp.zeros(joints, dtype=warp.float32, device="cpu")
        for name in ("joint_target_q", "joint_target_qd", "joint_act", "joint_f", "acceleration")
    }
    state = {name: warp.zeros(joints, dtype=warp.float32, device="cpu") for name in ("q", "qd")}
    return SimpleNamespace(
        actuator=actuator,
        control=SimpleNamespace(**arrays),
        state=SimpleNamespace(joint_q=state["q"], joint_qd=state["qd"]),
        states=[actuator.state(), actuator.state()],
    )


def newton_step(case, error, velocity, acceleration, dt: float = DT) -> np.ndarray:
    case.state.joint_q.assign(np.full(len(error), 0.5, np.float32))
    case.state.joint_qd.assign(np.float32(velocity))
    case.control.joint_target_q.assign(np.float32(0.5 + error))
    case.control.acceleration.assign(np.float32(acceleration))
    case.control.joint_f.zero_()
    case.actuator.step(case.state, case.control, *case.states, dt=dt)
    case.states.reverse()
    return case.control.joint_f.numpy().copy()


@pytest.mark.parametrize("name", list(STREAMING))
def test_newton_drives_with_the_gru(tmp_path, newton, name):
    artefact = STREAMING[name]
    export_artefact(artefact, ["newton"], tmp_path, "net")
    error, velocity = two_joints(100)
    acceleration = np.zeros_like(velocity)
    if name == "pva":
        columns = [features(artefact, error[:, i], velocity[:, i])[:, 2] for i in (0, 1)]
        acceleration = np.column_stack(columns)
    case = newton_case(newton, tmp_path / "net-newton.onnx")
    rows = zip(error, velocity, acceleration, strict=True)
    found = np.array([newton_step(case, *row) for row in rows])
    wanted = wanted_torque(artefact, error, velocity)
    np.testing.assert_allclose(found, wanted, atol=TOLERANCE, rtol=0.0)
    fresh = newton_case(newton, tmp_path / "net-newton.onnx")
    zero = np.zeros(2)
    first = newton_step(fresh, np.full(2, 0.3), zero, zero)
    assert first == pytest.approx(golden(artefact), abs=TOLERANCE)
    assert np.sign(first[0]) == np.sign(golden(artefact))


def test_newton_refuses_another_time_step(tmp_path, newton):
    export_artefact(STREAMING["pv"], ["newton"], tmp_path, "net")
    case = newton_case(newton, tmp_path / "net-newton.onnx")
    zero = np.zeros(2)
    with pytest.raises(ValueError, match=r"dt|timestep|sample"):
        newton_step(case, zero, zero, zero, dt=0.004)


def test_newtons_file_holds_what_its_loader_reads(tmp_path):
    """Without Newton: the graph and the metadata, run by onnxruntime with separate states."""
    artefact = STREAMING["pva"]
    export_artefact(artefact, ["newton"], tmp_path, "net")
    session = onnxruntime.InferenceSession(tmp_path / "net-newton.onnx")
    told = json.loads(session.get_modelmeta().custom_metadata_map["metadata"])
    assert told["input_columns"] == list(PVA)
    assert told["custom_inputs"] == ["acceleration"]
    assert told["sample_dt_s"] == DT
    mean, std = (
        np.array([told["normalization"]["inputs"][which][one] for one in PVA])
        for which in ("mean", "std")
    )
    target = told["normalization"]["targets"]
    raw = motion(artefact, 50)
    states = {f"initial_h_{k}": np.zeros((1, 1, artefact.hidden), np.float32) for k in range(4)}
    one = Streaming(artefact)
    for row in raw:
        scaled = np.float32((row - mean) / std)[None, None]
        torque, *new = session.run(None, {"features": scaled, **states})
        states = dict(zip(states, new, strict=True))
        found = torque[0, 0] * target["std"]["torque"] + target["mean"]["torque"]
        assert found == pytest.approx(one.step(row), abs=TOLERANCE)


# Refusals ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", ["torchscript-isaaclab", "newton", "mjlab"])
@pytest.mark.parametrize(
    ("inputs", "why"),
    [
        ((*PVA, "sin_11", "cos_11"), "absolute, homed position"),
        ((*PVA, "balance"), "actuator's parameters"),
    ],
)
def test_a_client_that_cannot_feed_an_input_is_refused(tmp_path, kind, inputs, why):
    artefact = network(inputs=inputs, mode="window")
    with pytest.raises(UsageError, match=why):
        export_artefact(artefact, [kind], tmp_path, "net")
    assert not list(tmp_path.iterdir())


def test_forms_that_a_client_has_not_are_refused(tmp_path):
    with pytest.raises(UsageError, match="MLP"):
        export_artefact(WINDOWS["mlp"], ["newton"], tmp_path, "net")
    with pytest.raises(UsageError, match="no state"):
        export_artefact(STREAMING["pv"], ["mjlab"], tmp_path, "net")
    narrow = network(hidden=4, layers=1)
    with pytest.raises(UsageError, match="no room"):
        export_artefact(narrow, ["torchscript-isaaclab"], tmp_path, "net")


def test_a_network_of_windows_that_a_client_streams_is_told(tmp_path):
    written = export_artefact(WINDOWS["pv-gru"], ["newton"], tmp_path, "net")
    assert any("drifts" in sentence for sentence in written.warnings)
    assert not export_artefact(STREAMING["pv"], ["newton"], tmp_path / "b", "net").warnings


def test_other_settings_than_the_trainings_are_refused(tmp_path):
    export_artefact(WINDOWS["mlp"], ["mjlab"], tmp_path, "net")
    settings = tmp_path / "net-mjlab.json"
    require_settings(settings, DT, 60.0, 2.0)
    for given, name in (
        ((0.004, 60.0, 2.0), "sample time"),
        ((DT, 61.0, 2.0), "position gain"),
        ((DT, 60.0, 1.0), "velocity gain"),
    ):
        with pytest.raises(UsageError, match=name):
            require_settings(settings, *given)
    with pytest.raises(UsageError, match="is not a text file"):
        require_settings(tmp_path / "net-mjlab.pt", DT, 60.0, 2.0)
