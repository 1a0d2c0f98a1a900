"""Stored networks, checkpoints and data sets from elsewhere: read, or refused in a sentence."""

import io
import json
import pickle
import tracemalloc
import zipfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cqdd_design.errors import UsageError
from cqdd_design.files import read_arrays
from cqdd_design.torque.data.episodes import read_data
from cqdd_design.torque.features.physics import actuator_from_dict
from cqdd_design.torque.networks.artefact import read_artefact
from cqdd_design.torque.training.checkpoint import read_checkpoint

NETWORK = Path(__file__).parents[2] / "designs" / "cqdd-10-torque" / "phase-gru-0.npz"
READERS = (read_artefact, read_checkpoint)


def npy(header: str, body: bytes = b"") -> bytes:
    """An array file with any header."""
    text = header.encode() + b"\n"
    return b"\x93NUMPY\x01\x00" + len(text).to_bytes(2, "little") + text + body


def packed(entries) -> bytes:
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w") as archive:
        for name, content in entries.items():
            archive.writestr(name, content)
    return made.getvalue()


def array(values, **more) -> bytes:
    made = io.BytesIO()
    np.save(made, values, **more)
    return made.getvalue()


def header(shape, kind="'<f8'"):
    return f"{{'descr': {kind}, 'fortran_order': False, 'shape': {shape}, }}"


def test_another_npz_is_no_network(tmp_path):
    np.savez(tmp_path / "record.npz", metadata="{}", angle=np.zeros(3))
    with pytest.raises(UsageError, match=r"record\.npz is not a torque network of this program"):
        read_artefact(tmp_path / "record.npz")


TEXT = array(np.array("{}"))
CRAFTED = {
    "2^40 doubles": packed({"metadata.npy": TEXT, "a.npy": npy(header((2**40,)), b"12345678")}),
    "2^80 doubles": packed({"metadata.npy": TEXT, "a.npy": npy(header((2**40, 2**40)))}),
    "negative shape": packed({"metadata.npy": TEXT, "a.npy": npy(header((-1,)), b"12345678")}),
    "list of metadata": packed({"metadata.npy": array(np.array(["{}", "{}"]))}),
    "metadata of numbers": packed({"metadata.npy": array(np.zeros(3))}),
    "100,000 brackets": packed({"metadata.npy": array(np.array("[" * 100_000))}),
    "brackets in the header": packed({"metadata.npy": npy("(" * 9000)}),
    "JSON list": packed({"metadata.npy": array(np.array("[1, 2]"))}),
    "JSON number": packed({"metadata.npy": array(np.array("1e999"))}),
    "no metadata": packed({"a.npy": array(np.zeros(3))}),
    "pickle inside": packed({"metadata.npy": array(np.array([{}], object), allow_pickle=True)}),
    "structure": packed({"metadata.npy": TEXT, "a.npy": array(np.zeros(2, "f8,i4"))}),
    "zero bytes a value": packed({"metadata.npy": TEXT, "a.npy": npy(header((9,), "'<V0'"))}),
    "pickle": pickle.dumps({"a": 1}),
    "array alone": array(np.zeros(3)),
    "empty": b"",
    "text": b"no archive",
    "empty archive": packed({}),
    "half": NETWORK.read_bytes()[:5000],
}


@pytest.mark.parametrize("reader", READERS, ids=lambda one: one.__name__)
@pytest.mark.parametrize("kind", CRAFTED)
def test_crafted_archives_are_refused_without_memory(tmp_path, reader, kind):
    path = tmp_path / "a.npz"
    path.write_bytes(CRAFTED[kind])
    tracemalloc.start()
    with pytest.raises(UsageError, match=r"a\.npz"):
        reader(path)
    assert tracemalloc.get_traced_memory()[1] < 50e6
    tracemalloc.stop()


def test_a_bomb_is_not_unpacked(tmp_path):
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("metadata.npy", TEXT)
        archive.writestr("a.npy", npy(header((2_000_000,)), bytes(16_000_000)))
    path = tmp_path / "a.npz"
    path.write_bytes(made.getvalue())
    with pytest.raises(UsageError, match="holds more than 10 MB"):
        read_arrays(path, 10_000_000, "a file")
    assert read_arrays(path, 20_000_000, "a file")[0]["a"].shape == (2_000_000,)


@pytest.fixture(scope="module")
def network():
    return read_arrays(NETWORK, 10**8, "a network")


def changed(content, place, value):
    """A copy of a document with another value in one place."""
    copy = json.loads(json.dumps(content))
    table = copy
    for key in place[:-1]:
        table = table[key]
    table[place[-1]] = value
    return copy


def written(path, arrays, content):
    np.savez(path, metadata=np.array(json.dumps(content)), **arrays)
    return path


@pytest.mark.parametrize(
    ("place", "value"),
    [
        (("history",), -1),
        (("history",), 10**12),
        (("history",), 1.5),
        (("history",), True),
        (("layers",), 0),
        (("layers",), 10**9),
        (("hidden",), -3),
        (("hidden",), "32"),
        (("name",), "../x"),
        (("name",), "a\x1b[2J"),
        (("name",), 3),
        (("family",), "cnn"),
        (("mode",), None),
        (("inputs",), "velocity"),
        (("inputs",), ["velocity", "velocitx", "acceleration"]),
        (("input_mean",), [0.0, float("nan"), 0.0]),
        (("input_std",), [1.0, "1", 1.0]),
        (("torque_std",), -1.0),
        (("torque_mean",), 10**400),
        (("residual",), "no"),
        (("validity",), [1]),
        (("validity", "dt"), 0.0),
        (("validity", "torque_range"), [1.0]),
        (("differentiator",), {"taps": [], "delay": 0.0}),
        (("differentiator",), {"taps": 3, "delay": 0.0}),
        (("activation",), "tan"),
        (("facts",), []),
        (("facts", "seed"), -1),
        (("facts", "split"), {"protocol": 3}),
        (("facts", "split", "train"), "abc"),
        (("facts", "choice"), {"peak": "x"}),
        (("facts", "choice"), {"activation": "", "peak": 0.1, "more": 1}),
        (("facts", "supply_voltage_V"), "48"),
        (("facts", "leaked_rmse_Nm"), [1.0]),
        (("more",), 1),
    ],
    ids=str,
)
def test_a_wrong_value_is_refused_by_its_name(tmp_path, network, place, value):
    arrays, content = network
    with pytest.raises(UsageError, match=place[0]):
        read_artefact(written(tmp_path / "n.npz", arrays, changed(content, place, value)))


@pytest.mark.parametrize(
    ("place", "value"),
    [
        (("motor",), 3),
        (("motor", "resistance"), "x"),
        (("motor", "resistance"), -1.0),
        (("gear", "error_orders"), "abc"),
        (("gear", "error_cosine"), [[1.0], [2.0, 3.0]]),
        (("name",), None),
        (("mass",), "1"),
        (("drive", "encoder_bits"), {}),
    ],
    ids=str,
)
def test_a_wrong_actuator_is_refused(network, place, value):
    content = network[1]["facts"]["actuator"]
    assert actuator_from_dict(content).mass > 0.0
    with pytest.raises(UsageError):
        actuator_from_dict(changed(content, place, value))


json_like = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=4), inner),
    max_leaves=5,
)


@settings(deadline=None)
@given(data=st.data())
def test_no_metadata_raise_anything_but_our_own(tmp_path_factory, network, data):
    arrays, content = network
    key = data.draw(st.sampled_from(sorted(content)))
    value = data.draw(json_like)
    path = written(tmp_path_factory.mktemp("n") / "n.npz", arrays, changed(content, (key,), value))
    try:
        found = read_artefact(path)
    except UsageError:
        return
    assert found.history == content["history"] or key == "history"


MANIFEST = {
    "format": "cqdd-design torque data 1",
    "dt_s": 0.01,
    "position_gain_Nm_per_rad": 60.0,
    "velocity_gain_Nms_per_rad": 2.0,
    "torque_range_Nm": [-10.0, 10.0],
    "facts": {},
    "episodes": [{"name": "a", "samples": 3, "group": {"mass": 1}}],
}


@pytest.mark.parametrize(
    ("place", "value", "said"),
    [
        ((), [], "not 'cqdd-design torque data 1'"),
        (("format",), 3, "not 'cqdd-design torque data 1'"),
        (("dt_s",), "0.01", "dt_s is '0.01'"),
        (("dt_s",), -1.0, "dt_s is -1"),
        (("episodes",), [], "episodes"),
        (("episodes",), {"a": 1}, "episodes"),
        (("episodes", 0, "name"), "../../a", "episodes.0.name"),
        (("episodes", 0, "group"), {"mass": [1]}, "episodes.0.group"),
        (("torque_range_Nm",), [1], "torque_range"),
        (("facts",), 3, "facts"),
        (("facts",), {"held_mass_kg": "heavy"}, "held_mass_kg"),
        (("facts",), {"pendulum": {"gravity": "down"}}, "pendulum"),
        (("dt_s",), 10**400, "401 digits"),
    ],
    ids=str,
)
def test_a_wrong_manifest_is_refused(tmp_path, place, value, said):
    pytest.importorskip("pyarrow")
    content = changed(MANIFEST, place, value) if place else value
    (tmp_path / "manifest.json").write_text(json.dumps(content))
    with pytest.raises(UsageError, match=said):
        read_data(tmp_path)
