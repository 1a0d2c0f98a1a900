"""What `outputs.py` blanks before hashing, because it is different every time.

Elapsed times, latencies and names of logs, each with its reason; nothing else.
"""

from __future__ import annotations

import hashlib
import io
import re
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Blank:
    """What is blanked before hashing.

    Attributes
    ----------
    steps, outputs : str
        Patterns of the names of steps and outputs, matched whole.
    pattern : bytes
        What is replaced by `replacement`, line by line.
    reason : str
        Why it differs from run to run.
    within : bytes
        Pattern of the part of the output in which it is; "" for all.
    """

    steps: str
    outputs: str
    pattern: bytes
    replacement: bytes
    reason: str
    within: bytes = b""

    def applied(self, step: str, output: str, content: bytes) -> bytes:
        """`content` blanked, if it is of the step and output concerned."""
        if not (re.fullmatch(self.steps, step) and re.fullmatch(self.outputs, output)):
            return content

        def replaced(text: bytes) -> bytes:
            return re.sub(self.pattern, self.replacement, text, flags=re.MULTILINE)

        if not self.within:
            return replaced(content)
        return re.sub(self.within, lambda found: replaced(found[0]), content)


TIMED = "(size|tolerance|bench|torque-train|torque-evaluate)(-.*)?"
"""Steps that tell how long they took."""
HOLDING_TIMES = "torque-(train|evaluate)(-.*)?"
"""Steps whose files tell how long they took."""
_TIME = rb"[-+.e\d]+"
_CELL = rb'<td class="number">[^<]*</td>'
_SHOWN = rb"(?:\xe2\x80\x93|[-+.e\d]+)"  # a number, or the dash for none

BLANKS = (
    Blank(
        ".*",
        "stderr",
        rb"^compiling the (contact solver|actuator's simulation); .*\n",
        b"",
        "told only where kernels are not compiled yet",
    ),
    Blank(
        ".*",
        "stderr|stdout",
        rb"[^\s]*/cqdd-design-\w+\.log",
        b"LOG",
        "a bug's log has a new name every time",
    ),
    Blank(
        ".*",
        "stderr",
        rb"[^\s]+\.py:\d+: (\w+Warning: .*\n)  .*\n",
        rb"\1",
        "where in the package's folder a warning of Python comes from, with its line of source",
    ),
    Blank("doctor-.*", "stdout", rb'"detail": "[^"]*"', b'"detail": ""', "versions and places"),
    Blank(TIMED, "stdout", rb'"seconds": ' + _TIME, b'"seconds": 0', "elapsed time"),
    Blank(TIMED, "stdout", rb"( in) " + _TIME + rb" s(;.*)?$", rb"\1 0 s\2", "elapsed time"),
    Blank("torque-train-.*", "stderr", rb"(\)), " + _TIME + rb" s$", rb"\1", "elapsed time"),
    Blank("torque-train-.*", "stdout", rb"^(time) +" + _TIME + rb"  s$", rb"\1", "elapsed time"),
    Blank("torque-train-.*", ".*npz", rb'"seconds": ' + _TIME, b'"seconds": 0', "elapsed time"),
    Blank("torque-evaluate-?.*", "stdout", rb"^in " + _TIME + rb" s$", b"in 0 s", "elapsed time"),
    Blank(
        "torque-evaluate-?.*",
        "stdout",
        rb'("latency_us"): \{[^}]*\}',
        rb"\1: {}",
        "measured on the machine",
    ),
    Blank(
        "torque-evaluate-?.*",
        "stdout",
        rb"(?: {11,}[-+.e\d]+| {2,8}[-+.e\d]+ {2,9}[-+.e\d]+)$",
        b"",
        "latencies, measured on the machine: the last two columns",
        within=rb"\nmodel .*  step us  batch us\n(?:.+\n)*",
    ),
    Blank(
        "torque-evaluate-?.*",
        ".*html",
        rb'(<td class="model">[^<]*</td>' + _CELL + _CELL + rb")(?:" + _CELL + rb"){4}",
        rb"\1",
        "latencies, measured on the machine: the third to sixth number",
        within=rb"<h3>Size and speed</h3>(?s:.*?)</table>",
    ),
    Blank(
        "torque-evaluate-?.*",
        ".*md",
        rb"\| " + _SHOWN + rb" \| " + _SHOWN + rb" \|$",
        b"|",
        "latencies, measured on the machine: the last two columns",
        within=rb"\n\| model \|.*\| one step, [^\n]*\n(?:\|.*\n)*",
    ),
    Blank(
        HOLDING_TIMES,
        "stdout",
        rb'"(bytes|sha256)": ("\w*"|\d+)',
        rb'"\1": ""',
        "of files that tell elapsed times",
        within=rb'"files": \[(?s:.*?)\]',
    ),
    Blank(
        HOLDING_TIMES,
        "stdout",
        rb"^(wrote .*), [,\d]+ bytes\)$",
        rb"\1)",
        "of files that tell elapsed times",
    ),
)


def blanked(step: str, output: str, content: bytes) -> bytes:
    """An output without what the table says is different every time."""
    if re.fullmatch("torque-train-.*", step) and output.endswith(".npz"):
        content = _as_text(content)  # so that the elapsed time inside can be blanked
    for blank in BLANKS:
        content = blank.applied(step, output, content)
    return content


def _as_text(npz: bytes) -> bytes:
    """The arrays of an npz file: their text, or type, shape and hash."""
    with np.load(io.BytesIO(npz)) as arrays:
        lines = [
            f"{name}: {array}"
            if array.dtype.kind == "U"
            else f"{name}: {array.dtype}{array.shape} {hashlib.sha256(array.tobytes()).hexdigest()}"
            for name, array in arrays.items()
        ]
    return "\n".join(lines).encode()
