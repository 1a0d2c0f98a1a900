"""Backlash of rigid parts by a search on the exact profile, apart from the package's own road.

Crank and ring are held. The carrier may turn as long as every disc still has some pose (x, y,
theta) in which no ring tooth, no output hole and no cam bearing is pressed. Two independent
searches: successive linear programs (scipy's HiGHS), and SLSQP from several starts.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from contact_oracle import Faults
from scipy import optimize

from cqdd_design.geometry.cycloid import CycloidDisc
from cqdd_design.geometry.meshing import project

UNIT = np.array([1.0, 1j])
MICRON = 1e-6


@dataclass(frozen=True)
class Rigid:
    """One stack as rigid bodies, m and rad. `cam_play` is the total play."""

    disc: CycloidDisc
    disc_count: int
    pin_count: int
    pin_circle_radius: float
    clocking: float
    hole_radius: float
    pin_radius: float
    cam_play: float
    faults: Faults = field(default_factory=Faults)


def _plane(vectors: np.ndarray | float) -> np.ndarray | float:
    return vectors @ UNIT if isinstance(vectors, np.ndarray) else vectors


def _of(values: np.ndarray | float, index: int) -> np.ndarray | float:
    return values[index] if isinstance(values, np.ndarray) else values


class DiscGaps:
    """Gaps of one disc at crank angle phi as functions of its pose and the carrier's angle.

    Unknowns v = (x, y, R_w theta, R_w gamma), all in microns.
    """

    def __init__(self, stack: Rigid, phi: float, index: int) -> None:
        disc = stack.disc
        n = disc.lobe_count
        crank = phi + 2.0 * np.pi * index / stack.disc_count
        self.stack, self.disc = stack, disc
        self.lobes = np.exp(-1j * crank / n)
        self.nominal = disc.eccentricity * np.exp(1j * crank)
        faults = stack.faults
        self.teeth = disc.ring_pitch_radius * np.exp(2j * np.pi * np.arange(n + 1) / (n + 1))
        self.teeth = self.teeth + _plane(faults.tooth_position)
        self.tooth_radius = disc.tooth_radius + faults.tooth_radius
        beta = -phi / n + stack.clocking
        beta = beta + 2.0 * np.pi * np.arange(stack.pin_count) / stack.pin_count
        self.pins = stack.pin_circle_radius * np.exp(1j * beta)
        turned = np.exp(-1j * phi / n)
        self.holes = self.pins + turned * _plane(_of(faults.hole_position, index))
        self.pins = self.pins + turned * _plane(faults.pin_position)
        self.hole_play = stack.hole_radius + _of(faults.hole_radius, index)
        self.hole_play = self.hole_play - stack.pin_radius - faults.pin_radius
        along = _of(faults.cam_centre, index)
        self.axis = complex(_plane(faults.output_axis))
        shift = 0.5 * self.axis
        if isinstance(along, np.ndarray):
            shift = shift + complex(*along) * np.exp(1j * crank)
        self.cam = np.array([shift.real, shift.imag]) / MICRON
        self.half_play = 0.5 * max(stack.cam_play + float(_of(faults.cam_play, index)), 0.0)
        self.profile = None if faults.disc_profile is None else faults.disc_profile[index]

    def __call__(self, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Ring and hole gaps in microns, and their Jacobian."""
        arm = self.stack.pin_circle_radius
        x, y, theta, gamma = v[0] * MICRON, v[1] * MICRON, v[2] * MICRON / arm, v[3] * MICRON / arm
        centre, turn = self.nominal + complex(x, y), np.exp(1j * theta)
        local = (self.teeth - centre) / (turn * self.lobes)
        foot = project(self.disc, np.stack([local.real, local.imag], axis=-1))
        normal = (foot.normal @ UNIT) * turn * self.lobes
        point = (foot.point @ UNIT) * turn * self.lobes
        ring = foot.distance - self.tooth_radius
        if self.profile is not None:
            order = np.outer(foot.parameter, 1 + np.arange(self.profile.shape[1]))
            ring = ring - np.cos(order) @ self.profile[0] - np.sin(order) @ self.profile[1]
        ring_rows = np.stack(
            [
                -normal.real,
                -normal.imag,
                -(np.conj(point) * normal).imag / arm,
                np.zeros(len(ring)),
            ],
            axis=1,
        )
        # Pins turn about the carrier's own axis.
        hole, pin = self.holes * turn, self.pins * np.exp(1j * gamma)
        apart = self.axis + pin - centre - hole
        far = np.abs(apart)
        out = apart / far
        holes = self.hole_play - far
        hole_rows = np.stack(
            [
                out.real,
                out.imag,
                (np.conj(hole) * out).imag / arm,
                -(np.conj(pin) * out).imag / arm,
            ],
            axis=1,
        )
        return np.concatenate([ring, holes]) / MICRON, np.concatenate([ring_rows, hole_rows])

    def end_by_linear_programs(self, sense: float, first: float = 200.0) -> float:
        """Farthest carrier angle (rad) in one sense (+1 or -1), by successive linear programs."""
        play = self.half_play / MICRON
        v, room = np.zeros(4), first
        angles = 2.0 * np.pi * np.arange(24) / 24
        cuts = [np.array([np.cos(a), np.sin(a)]) for a in angles]
        for turn in range(200):
            gap, rows = self(v)
            A = [-rows]
            b = [gap]
            for cut in cuts:
                A.append(np.array([[cut[0], cut[1], 0.0, 0.0]]))
                b.append(np.array([play - cut @ (v[:2] - self.cam)]))
            found = optimize.linprog(
                [0.0, 0.0, 0.0, -sense],
                A_ub=np.concatenate(A),
                b_ub=np.concatenate(b),
                bounds=[(-room, room)] * 4,
                method="highs",
            )
            if found.status == 2:
                # Not within the trust region, or nowhere at all.
                room *= 4.0
                if room > 1e6:
                    raise ValueError("no pose of the disc is free of interference")
                continue
            step = found.x
            v = v + step
            away = v[:2] - self.cam
            off = float(np.hypot(away[0], away[1]))
            if off > play * (1.0 + 1e-14) and off > 0.0:
                cuts.append(away / off)
            gap, _ = self(v)
            clean = gap.min() > -1e-5 and off <= play + 1e-5
            # Solver tolerances leave the pose loose along nearly parallel contacts, not the angle.
            if clean and abs(step[3]) < 1e-6 and np.abs(step).max() < 1e-2:
                return float(v[3]) * MICRON / self.stack.pin_circle_radius
            # Where a round constraint is alone in the way the programs hop across its top; a
            # shrinking step ends that.
            room = min(room, 0.5 * room if turn > 8 else 2.0 * float(np.abs(step).max()) + 1e-3)
        raise RuntimeError("the linear programs did not settle")

    def end_by_slsqp(self, sense: float, starts: int = 4, rng: int = 0) -> float:
        """The same by SLSQP from several starts; the farthest feasible end."""
        play = self.half_play / MICRON
        generator = np.random.default_rng(rng)
        best = -np.inf
        for k in range(starts):
            spread = 0.0 if k == 0 else 1.0
            first = spread * generator.normal(size=4) * np.array([play, play, 5.0, 20.0])
            found = optimize.minimize(
                lambda v: -sense * v[3],
                first,
                jac=lambda v: np.array([0.0, 0.0, 0.0, -sense]),
                method="SLSQP",
                constraints=[
                    {"type": "ineq", "fun": lambda v: self(v)[0], "jac": lambda v: self(v)[1]},
                    {
                        "type": "ineq",
                        "fun": lambda v: play**2 - ((v[:2] - self.cam) ** 2).sum(),
                        "jac": lambda v: np.append(-2.0 * (v[:2] - self.cam), [0.0, 0.0]),
                    },
                ],
                options={"ftol": 1e-10, "maxiter": 300},
            )
            v = found.x
            if self(v)[0].min() > -1e-5 and np.hypot(*(v[:2] - self.cam)) < play + 1e-5:
                best = max(best, sense * float(v[3]))
        if not np.isfinite(best):
            raise ValueError("SLSQP found no free pose")
        return sense * best * MICRON / self.stack.pin_circle_radius


def carrier_range(stack: Rigid, phi: float, method: str = "linear programs") -> tuple[float, float]:
    """Least and greatest carrier angle error at crank angle phi that every disc allows, rad."""
    low, high = -np.inf, np.inf
    for index in range(stack.disc_count):
        gaps = DiscGaps(stack, phi, index)
        end = gaps.end_by_slsqp if method == "slsqp" else gaps.end_by_linear_programs
        low, high = max(low, end(-1.0)), min(high, end(1.0))
    return low, high


def backlash(stack: Rigid, phi: float, method: str = "linear programs") -> float:
    """Range of the carrier angle at crank angle phi, rad."""
    low, high = carrier_range(stack, phi, method)
    return high - low
