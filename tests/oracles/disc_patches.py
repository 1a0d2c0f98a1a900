"""A disc on a fine lattice, loaded by pressures on patches: the influence of contacts once more."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import plane_stress
from scipy.sparse import coo_matrix

from cqdd_design.gearbox.bodies.disc import DiscShape
from cqdd_design.gearbox.bodies.point_load import DEPTH

Hold = Callable[[np.ndarray], np.ndarray] | None
"""Radial springs round the bore, a stiffness over angle (N/m^2); None: reactions spread evenly."""


class DiscPatches:
    """A disc, its bearing's ring where it has one, and unit forces on patches round some places.

    Parameters
    ----------
    ids : sequence of int
        Places, one force each.
    half_width, coarse : float
        Of the patches, and side of the lattice away from them, m.
    turned : complex
        Direction of the forces over the inward normal.
    """

    def __init__(
        self,
        shape: DiscShape,
        ids: Sequence[int],
        half_width: float,
        coarse: float,
        turned: complex = 1.0,
    ) -> None:
        self.shape, self.ids, self.half_width = shape, list(ids), half_width
        self._moved: dict[Hold, tuple[np.ndarray, np.ndarray, np.ndarray]] = {}
        outline, places, plate = shape.outline, shape.places(), shape.plate
        R, seat = shape.bearing.raceway, shape.bearing.outer

        def outside(u: np.ndarray) -> np.ndarray:
            return outline.profile(2.0 * np.pi * np.asarray(u))[0]

        def round_hole(centre: complex, radius: float):
            return lambda u: centre + radius * np.exp(2j * np.pi * np.asarray(u))

        rim = outside(np.linspace(0.0, 1.0, 20_001))
        angle = np.unwrap(np.angle(rim))

        def inside(z: np.ndarray) -> np.ndarray:
            good = np.abs(z) < np.interp(np.mod(np.angle(z), 2.0 * np.pi), angle, np.abs(rim))
            for centre in shape.holes:
                good &= np.abs(z - centre) > shape.hole_radius
            for centre in shape.columns:
                good &= np.abs(z - centre) > shape.column_radius
            return good & (np.abs(z) > R)

        holes = [round_hole(c, shape.hole_radius) for c in shape.holes]
        columns = [round_hole(c, shape.column_radius) for c in shape.columns]
        curves = [outside, *holes, *columns, round_hole(0j, R)]
        self.mesh = plane_stress.lattice(
            plane_stress.Domain(curves, inside), coarse, places.point[self.ids], half_width / 6.0
        )
        self.matrix = plane_stress.stiffness(
            self.mesh, plate.modulus, plate.poisson, plate.thickness
        )
        if seat > R:
            # No sides run along the seat: right where the ring is about as stiff as the disc.
            corner = self.mesh.triangles[:3]
            own = np.abs(self.mesh.nodes[corner].mean(axis=0)) < seat
            ring = plane_stress.Lattice(self.mesh.nodes, self.mesh.triangles[:, own], [])
            self.matrix = self.matrix + plane_stress.stiffness(
                ring,
                plate.modulus,
                plate.poisson,
                (shape.ring_factor - 1.0) * plate.thickness,
            )
        self.directions = places.inward[self.ids] * turned
        self.patches = []
        for place, direction in zip(self.ids, self.directions, strict=True):

            def hertz(z: np.ndarray, at=places.point[place], along=direction) -> np.ndarray:
                width = np.sqrt(np.clip(half_width**2 - np.abs(z - at) ** 2, 0.0, None))
                return 2.0 / (np.pi * half_width**2) * width * along

            lobes = shape.grid.per_lobe * outline.lobe_count
            edge = 0 if place < lobes else 1 + (place - lobes) // shape.grid.per_hole
            force = plane_stress.nodal(self.mesh, edge, hertz)
            self.patches.append(force / abs(complex(force[0::2].sum(), force[1::2].sum())))

    def moved(self, hold: Hold) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Balanced forces (nodes, N), what they move, and what the rigid disc on springs adds."""
        if hold not in self._moved:
            self._moved[hold] = self._solved(hold)
        return self._moved[hold]

    def _solved(self, hold: Hold) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        R, edge = self.shape.bearing.raceway, len(self.mesh.edges) - 1
        length = 2.0 * np.pi * R
        even = [
            plane_stress.nodal(self.mesh, edge, lambda z, t=t: t(z) / length)
            for t in (
                lambda z: 1.0 + 0.0 * z,
                lambda z: 1j + 0.0 * z,
                lambda z: 1j * z / np.abs(z) / R,
            )
        ]
        columns, pushes = [], []
        for force in self.patches:
            total = complex(force[0::2].sum(), force[1::2].sum())
            moment = (np.conj(self.mesh.nodes) * (force[0::2] + 1j * force[1::2])).imag.sum()
            balanced = force - moment * even[2]
            if hold is None:
                balanced = balanced - total.real * even[0] - total.imag * even[1]
            columns.append(balanced)
            pushes.append([total.real, total.imag])
        forces, push = np.array(columns).T, np.array(pushes).T
        rim = self.mesh.edges[-1]
        if hold is None:
            half = rim[len(rim) // 2]
            held = [2 * rim[0], 2 * rim[0] + 1, 2 * half + 1]
            nothing = np.zeros((len(self.ids), len(self.ids)))
            return forces, plane_stress.solve(self.matrix, forces, held), nothing
        z = self.mesh.nodes[rim]
        radial = np.stack([z.real, z.imag]) / R
        stiff = hold(np.angle(z)) * length * 0.5 * (even[0][2 * rim] + even[1][2 * rim + 1])
        at, pairs = np.stack([2 * rim, 2 * rim + 1]), [(a, b) for a in (0, 1) for b in (0, 1)]
        values = np.stack([stiff * radial[a] * radial[b] for a, b in pairs]).ravel()
        rows, others = (np.stack([at[pair[k]] for pair in pairs]).ravel() for k in (0, 1))
        springs = coo_matrix((values, (rows, others)), shape=self.matrix.shape)
        found = plane_stress.solve((self.matrix + springs).tocsc(), forces, [2 * rim[0] + 1])
        return forces, found, push.T @ np.linalg.solve((stiff * radial) @ radial.T, push)

    def compliance(self, hold: Hold) -> np.ndarray:
        """Displacement along every force, (N, N), m/N, less the rigid disc's on the springs.

        At its own place that of the middle of the patch, less what a half plane gives down to
        the depth from which bodies count.
        """
        forces, moved, rigid = self.moved(hold)
        found = forces.T @ moved
        for k, place in enumerate(self.ids):
            read, point = forces[:, k].copy(), self.shape.places().point[place]
            near = np.abs(self.mesh.nodes - point) < 3.0 * self.half_width
            read[0::2][near] = read[1::2][near] = 0.0
            middle = int(np.abs(self.mesh.nodes - point).argmin())
            read[2 * middle] = self.directions[k].real
            read[2 * middle + 1] = self.directions[k].imag
            local = float(self.shape.plate.approach(DEPTH, self.half_width))
            found[k, k] = read @ moved[:, k] - local
        return found - rigid

    def edge_stress(self, curve: int, hold: Hold) -> tuple[np.ndarray, np.ndarray]:
        """Middles of a curve's sides (S,), and E times their elongation by each force, (S, N)."""
        moved, corners = self.moved(hold)[1], self.mesh.edges[curve][0::2]
        u = moved[2 * corners] + 1j * moved[2 * corners + 1]
        z = self.mesh.nodes[corners]
        side, longer = np.roll(z, -1) - z, np.roll(u, -1, axis=0) - u
        strain = (np.conj(side)[:, None] * longer).real / (np.abs(side) ** 2)[:, None]
        return z + 0.5 * side, self.shape.plate.modulus * strain

    def stress_at(self, curve: int, centre: complex, at: np.ndarray) -> np.ndarray:
        """The same by the first force, at places of a curve that goes round `centre`."""
        middle, stress = self.edge_stress(curve, None)
        around = np.angle(middle - centre)
        order = np.argsort(around)
        return np.interp(np.angle(at - centre), around[order], stress[order, 0], period=2.0 * np.pi)
