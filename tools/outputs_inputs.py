"""Files that lie in every folder in which `outputs.py` runs a command."""

from __future__ import annotations

import math

MOTOR = """\
name = "RO100, measured"
based_on = "CubeMars RO100 KV55"
torque_constant = "0.1504 N*m/A"
convention = "torque_per_peak"
resistance = "71.5 mohm"
measured_between = "phase"
cogging_amplitude = "0.02 N*m"
cogging_order = 252
"""
MEASURED = "name,value,unit\nbackdrive_static,1500,mN*m\nno_load_speed,13.5,rad/s\n"
REFERENCE = "time [s],torque [N m]\n0,0\n0.05,10\n0.1,-5\n0.2,0\n"
REQUIREMENTS = """\
[requirements]
ratio = 9
peak_torque = "40 N*m"
disc_count = 2
duty = [
  {torque = "20 N*m", speed = "8 rad/s", share = 0.25},
  {torque = "-6 N*m", speed = "10 rad/s", share = 0.75},
]
"""
FIRST = """\
schema_version = 1
name = "bad"
[reducer]
ratio = 10
ring_pitch_radius = "32 mm"
eccentricity = "1.6 mm"
ring_pin_diameter = "7 mm"
"""
"""A design with nothing wrong, to which the bad ones add or of which they change one thing."""


def _log() -> str:
    """A joint's log of three seconds as CSV."""
    rows = ["t,q,q_des,dq,tau"]
    for k in range(3000):
        t = k / 1000.0
        q, dq = math.sin(5.0 * t), 5.0 * math.cos(5.0 * t)
        rows.append(f"{t:.3f},{q:.9f},{q + 0.1:.9f},{dq:.9f},{6.0 - 2.0 * dq:.9f}")
    return "\n".join(rows) + "\n"


BAD = {
    "not-toml": "reducer = [",
    "empty": "",
    "unknown-key": FIRST + 'rinf_type = "solid"\n',
    "unknown-table": FIRST + "[gearing]\n",
    "unknown-material": FIRST + 'disc_material = "cheese"\n',
    "unknown-motor": FIRST + '[motor]\nname = "CubeMars RO100 KV56"\n',
    "unknown-bearing": FIRST + '[reducer.cam_bearing]\ndesignation = "6902X"\n',
    "missing-key": FIRST.replace('eccentricity = "1.6 mm"\n', ""),
    "bare-number": FIRST.replace('"32 mm"', "32"),
    "wrong-unit": FIRST.replace('"32 mm"', '"32 kg"'),
    "wrong-type": FIRST.replace("ratio = 10", 'ratio = "ten"'),
    "not-finite": FIRST.replace('"32 mm"', '"nan mm"'),
    "ratio": FIRST.replace("ratio = 10", "ratio = 3"),
    "undercut": FIRST.replace('"7 mm"', '"14 mm"').replace('"1.6 mm"', '"2.6 mm"'),
    "overlap": FIRST.replace('"7 mm"', '"25 mm"'),
    "curtate": FIRST.replace('"1.6 mm"', '"4 mm"'),
    "break-out": FIRST + '[reducer.output_pins]\ncircle_radius = "27 mm"\n',
    "columns": FIRST + '[reducer.carrier]\njoint = "columns"\ncolumn_diameter = "14 mm"\n',
    "duty": FIRST + '[[requirements.duty]]\ntorque = "1 N*m"\n',
    "version": FIRST.replace("schema_version = 1", "schema_version = 7"),
}
"""Designs that are refused, or that say so."""

INPUTS = {
    "motor.toml": MOTOR,
    "measured.csv": MEASURED,
    "reference.csv": REFERENCE,
    "requirements.toml": REQUIREMENTS,
    "log.csv": _log(),
    **{f"bad-{name}.toml": text for name, text in BAD.items()},
}
"""Files that lie in every folder."""
