"""G-code: read here by a small control of its own, and compared with the formula of the profile.

The reader below shares nothing with the package; the package's own is shown spoilt programs.
"""

from __future__ import annotations

import cmath
import math
import re
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from examples import examples
from geometry_designs import design_of, discs
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from cqdd_design.design import load_design
from cqdd_design.errors import CqddError, ReadBackError
from cqdd_design.exporting import ExportOptions
from cqdd_design.exporting.edm.begin import OVERLAP_SHARE
from cqdd_design.exporting.edm.flat_parts import flat_parts
from cqdd_design.exporting.edm.gcode import program
from cqdd_design.exporting.edm.gcode_check import check_program
from cqdd_design.exporting.edm.passes import BORDER, contour_times, wire_passes
from cqdd_design.exporting.edm.wire_path import segmented
from cqdd_design.exporting.options import DEFAULTS
from cqdd_design.gearbox.contact.sweep import contact_sweep
from cqdd_design.geometry.contours import Circle
from cqdd_design.geometry.cycloid import CycloidDisc
from cqdd_design.machine import resolve
from cqdd_design.roads.export import export

SEVERAL = settings(
    max_examples=examples(8), deadline=None, suppress_health_check=[HealthCheck.filter_too_much]
)
NUMBER = r"([XYIJ])(-?\d+\.\d{4})(?!\d)"


@pytest.fixture(scope="module")
def paper(paper_design_file):
    return load_design(paper_design_file)


@pytest.fixture(scope="module")
def parts(paper):
    return flat_parts(resolve(paper))


@pytest.fixture(scope="module")
def text(paper, parts):
    return program(parts[0], paper)


def _blocks(text):
    """Blocks as they are run: those of a subprogram where it is called."""
    bare = [re.sub(r"\(.*", "", line).strip() for line in text.splitlines()]
    end = bare.index("M02")
    subprograms = {}
    for block in bare[end + 1 :]:
        if re.fullmatch(r"[ON]\d{4}", block):
            own = subprograms[block[1:]] = []
        elif block not in {"M99", "%", ""}:
            own.append(block)
    for block in bare[:end]:
        called = re.fullmatch(r"M98 P(\d{4})", block)
        yield from subprograms[called.group(1)] if called else [block]


def _cuts(text):
    """Blocks of each cut: from a rapid to the next, as (command, start, end, centre, words), mm."""
    cuts, here, motion = [], 0j, None
    for block in _blocks(text):
        words = dict(re.findall(NUMBER, block))
        command = re.search(r"G0[0-3]", block)
        motion = command.group() if command else motion
        if motion == "G00" and "X" in words:
            cuts.append([])
        if "X" in words:
            end = complex(float(words["X"]), float(words["Y"]))
            centre = here + complex(float(words.get("I", 0)), float(words.get("J", 0)))
            cuts[-1].append((motion, here, end, centre if "I" in words else None, block))
            here = end
        elif cuts and block == "M01":
            cuts[-1].append(("M01", here, here, None, block))
    return cuts


def _passes(cut):
    """Of the wall and of the tab: moves from offset on to offset off, both of them included."""
    found = ([], [])
    stopped, own = 0, None
    for move in cut[1:]:
        stopped += move[0] == "M01"
        if re.match(r"G4[12]", move[4]):
            own = []
        if own is not None:
            own.append(move)
        if move[4].startswith("G40"):
            found[stopped].append(own)
            own = None
    return found


def _points(moves, count=7):
    """Points on the arcs and lines of a cut, mm."""
    found = []
    for motion, start, end, centre, _ in moves:
        if centre is None:
            found += [start + (end - start) * f for f in np.linspace(0.0, 1.0, count)]
            continue
        turn = cmath.phase((end - centre) / (start - centre)) % (2.0 * math.pi)
        if motion == "G02":
            turn -= 2.0 * math.pi
        found += [
            centre + (start - centre) * cmath.exp(1j * turn * f)
            for f in np.linspace(0.0, 1.0, count)
        ]
    return np.array(found)


def _psi_form(design, count):
    """The profile by the angle psi of the literature, mm."""
    reducer = design.reducer
    R, r, e, n = (
        1e3 * reducer.ring_pitch_radius,
        1e3 * (reducer.ring_pin_diameter / 2.0 + reducer.modification.equidistant),
        1e3 * reducer.eccentricity,
        reducer.ratio,
    )
    t = np.linspace(0.0, 2.0 * math.pi, count, endpoint=False)
    psi = -np.arctan2(np.sin(n * t), R / (e * (n + 1)) - np.cos(n * t))
    x = R * np.cos(t) - r * np.cos(t + psi) - e * np.cos((n + 1) * t)
    y = R * np.sin(t) - r * np.sin(t + psi) - e * np.sin((n + 1) * t)
    return x + 1j * y


def _contour_moves(cut):
    """Of the first pass of the wall, and of the pass of the tab that runs the same way."""
    wall, tab = _passes(cut)
    onward = next(one for one in tab if one[0][2] == wall[0][-2][2])
    return wall[0][1:-1] + onward[1:-1]


def test_the_lobed_contour_is_the_exact_curve_within_fit_and_rounding(text, paper):
    moves = _contour_moves(_cuts(text)[-1])
    exact = _psi_form(paper, 200_000)
    angle = np.unwrap(np.angle(exact))
    found = _points(moves)
    place = np.searchsorted(angle, np.mod(np.angle(found), 2.0 * math.pi))
    around = (place[:, None] + np.arange(-10, 10)) % len(exact)
    chord = exact[(around + 1) % len(exact)] - exact[around]
    local = (found[:, None] - exact[around]) / chord
    off = np.abs(local - np.clip(local.real, 0.0, 1.0)) * np.abs(chord)
    assert off.min(axis=1).max() * 1e3 <= 0.5 + 0.1
    assert abs(moves[0][1] - moves[-1][2]) == 0.0


def test_the_holes_are_the_circles_of_the_design(text, parts):
    holes = parts[0].shape.holes
    for cut, hole in zip(_cuts(text), holes, strict=False):
        off = np.abs(_points(_contour_moves(cut)) - 1e3 * complex(*hole.centre)) - 1e3 * hole.radius
        assert np.abs(off).max() < 1.5e-4


@pytest.mark.parametrize("index", [0, 1])
def test_radii_of_every_arc_agree_and_sides_keep_the_material(paper, parts, index):
    cuts = _cuts(program(parts[index], paper))
    for number, cut in enumerate(cuts, start=1):
        for _, start, end, centre, _ in cut:
            if centre is not None:
                assert abs(abs(start - centre) - abs(end - centre)) < 1.5e-4
        outer = number == len(cuts)
        wall, tab = _passes(cut)
        passes = wall + tab
        codes = [re.search(r"G4[12]", one[0][4]).group() for one in passes]
        moves = _contour_moves(cut)
        points = _points(moves)
        centre = moves[0][3]
        along = 1j * (moves[0][1] - centre)
        area = 0.5 * np.sum((points.conjugate() * np.roll(points, -1)).imag)
        # Left of a counter-clockwise path is the inside: the waste of a hole, never of the part.
        left_is_waste = (area > 0.0) != outer
        assert codes[0] == ("G41" if left_is_waste else "G42")
        # To and fro, also from the wall to the tab, with the waste on the same hand.
        for here, there in pairwise(passes):
            assert here[-2][2] == there[0][2]
        for k, one in enumerate(passes):
            same = [move[2] for move in one[1:-1]] == [move[2] for move in wall[0][1:-1]]
            if k < len(wall):
                assert (codes[k] == codes[0]) == same == (k % 2 == 0)
        lead = cut[1][2] - cut[1][1]
        # Rounding by 0.05 um turns the shortest arcs most.
        assert abs((lead * along.conjugate()).real) < 2e-4 * abs(lead) * abs(along)


@pytest.mark.parametrize("tab", [0.5e-3, 3e-3])
def test_the_tab_is_as_long_as_asked(paper, parts, tab):
    for flat in parts:
        for cut in _cuts(program(flat, paper, ExportOptions(tab_length=tab))):
            whole, left = (
                np.abs(np.diff(_points(moves, 200))).sum()
                for moves in (_contour_moves(cut), _passes(cut)[1][0][1:-1])
            )
            assert left == pytest.approx(min(1e3 * tab, whole / 8.0), abs=2e-3)
            assert cut[-1][4].startswith("G40 G01")
            assert cut[-1][2] == cut[0][2]


def _length(moves):
    return np.abs(np.diff(_points(moves, 200))).sum()


@pytest.mark.parametrize("count", [1, 2, 3, 4])
@pytest.mark.parametrize("index", [0, 1])
def test_the_last_pass_runs_over_the_finished_wall_on_both_sides_of_the_tab(
    paper, parts, index, count
):
    text = program(parts[index], paper, ExportOptions(passes=count))
    told = " ".join(line.strip("()") for line in text.splitlines())
    both = "BEGINS AND " if count > 1 else ""
    assert f"THE LAST PASS OF A TAB {both}ENDS 10% OF ITS LENGTH BEYOND IT" in told
    for cut in _cuts(text):
        wall, tab = _passes(cut)
        one_way = wall[0][1:-1]
        whole = _points(one_way, 2 + 20_000 // len(one_way))
        # The last pass of the tab holds its way out too.
        bare = next(k for k, move in enumerate(tab[-1]) if move[0] == "G01" and "G40" in move[4])
        last = tab[-1][1:bare]
        begins, ends = tab[-1][0][2], last[-1][2]
        first_joint, far_joint = one_way[0][1], one_way[-1][2]
        long = _length(last)
        if count > 1:
            long -= abs(begins - far_joint)
            assert np.abs(whole - begins).min() < 0.05
        left = long - abs(ends - first_joint)
        over = abs(ends - first_joint)
        assert over == pytest.approx(0.1 * left, abs=0.012)
        assert count == 1 or abs(begins - far_joint) == pytest.approx(over, abs=0.012)
        # All of it lies on the wall or on the tab, and no further than a tooth or pin comes.
        for place in _points(last, 20):
            near = np.abs(whole - place).min() < 0.05
            assert near or min(abs(place - first_joint), abs(place - far_joint)) < left
        # The wire goes home along the kerf and the way that it came.
        home = tab[-1][bare:]
        came = cut[1][1], cut[1][2]
        kerf = home[-1][1]
        along = (came[1] - came[0]) / abs(came[1] - came[0])
        assert abs(((kerf - came[0]) / along).imag) < 1e-3
        assert home[-1][2] == came[0]
        apart = abs(kerf - first_joint)
        for place in _points(home[1:-1], 20) if len(home) > 2 else ():
            assert np.abs(whole - place).min() == pytest.approx(apart, abs=2e-3)


def test_holes_come_first_and_the_wire_is_cut_between(text):
    assert text.startswith("%\nO0001\n")
    assert text.endswith("M99\n%\n")
    assert text.isascii()
    titles = re.findall(r"\(CUT (\d) OF 7: (\w+) CONTOUR", text)
    assert titles == [(str(k), "INNER") for k in range(1, 7)] + [("7", "OUTER")]
    # To thread, to take the slug out of the tab, and to cut the wire.
    assert text.count("\nM00\n") == 7 + 7 + 6
    assert text.count("\nM01\n") == 7
    assert re.search(r"^G90 G21", text, re.MULTILINE)
    # A bracket within a comment would end it.
    assert all(line.count("(") == line.count(")") <= 1 for line in text.splitlines())


def test_names_with_umlauts_are_spelt_out(text, paper, parts):
    named = program(parts[0], paper.replacing({"name": "Knie Größe Ωé"}))
    assert "KNIE GROESSE ?E" in named
    assert named.isascii()
    assert list(_blocks(named)) == list(_blocks(text))


def test_no_block_is_longer_than_a_control_reads(paper, parts):
    """What is said of a ring's grooves takes several comments, its zone no sign before a sign."""
    assert any(len(remark) > 200 for remark in parts[1].remarks)
    for part in parts:
        lines = program(part, paper).splitlines()
        assert max(map(len, lines)) <= 100
        assert not any("- +" in line or "- -" in line for line in lines)
    words = " ".join(line.strip("()") for line in program(parts[1], paper).splitlines())
    assert parts[1].remarks[1] in words
    assert "72 N6, +0.039/+0.02" in words


def test_a_seat_has_offsets_of_its_own(text, paper, parts):
    (note,) = re.findall(r"\((11 AND ON FOR INNER CONTOUR 1[^)]*)\)", text)
    assert "28 N7" in note
    # 28 N7 is -7 to -28 um: the middle is 17.5 um less, half of it on each side.
    assert "+0.0087 MORE, TO CUT DIA 27.9825" in note.replace("\n", " ")
    assert re.findall(r"G41 (D\d+)", text)[:2] == ["D11", "D13"]
    assert set(re.findall(r"G4[12] (D\d+)", text)) == {
        f"D{base}{k}" for base in (0, 1) for k in (1, 2, 3, 4)
    }
    held = dict(re.findall(r"\((D\d+) = (\S+),", text))
    for k in "1234":
        assert float(held[f"D1{k}"]) - float(held[f"D0{k}"]) == pytest.approx(8.75e-3, abs=1e-4)
    ring = program(parts[1], paper)
    assert "72 N6" in ring
    assert "+0.0147 MORE, TO CUT DIA 72.0295" in ring


def test_the_last_pass_is_the_wire_and_its_gap_and_each_leaves_what_the_next_take(paper, parts):
    for count, left in ((1, [0]), (2, [50, 0]), (3, [65, 15, 0]), (4, [70, 20, 5, 0])):
        found = wire_passes(parts[0].contours, paper.edm, count)
        assert [one.left for one in found] == pytest.approx([1e-6 * one for one in left])
        for one in found:
            assert one.offset == pytest.approx(0.125e-3 + 12e-6 + one.left)
        text = program(parts[0], paper, ExportOptions(passes=count))
        told = [float(one) for one in re.findall(r"\(D0\d = (\S+),", text)]
        assert told == pytest.approx([1e3 * one.offset for one in found], abs=6e-5)
        for cut in _cuts(text):
            assert [len(one) for one in _passes(cut)] == [count, count]


def test_where_the_rough_cut_could_not_follow_skim_cuts_take_less(paper, parts):
    outer, inner = (segmented(one) for one in parts[1].contours)
    # Inside of the teeth's fillets, outside of the dowels' grooves.
    tightest = min(
        inner.arcs().radii[inner.bulges > 0.0].min(), outer.arcs().radii[outer.bulges < 0.0].min()
    )
    thick = paper.edm.unchecked_copy({"wire_diameter": 2.0 * (tightest - 32e-6)})
    found = wire_passes(parts[1].contours, thick, 4)
    assert found[-1].offset == pytest.approx(tightest - 20e-6)
    assert found[0].offset < tightest
    assert found[0].left == pytest.approx(18e-6)
    assert found[2].left / found[0].left == pytest.approx(5.0 / 70.0)


@pytest.mark.parametrize("name", ["cqdd-10", "reference-s"])
def test_no_tooth_touches_the_tab_of_a_disc(name, paper_design_file):
    """By the equilibrium at the peak torque, of rigid bodies."""
    machine = replace(resolve(load_design(paper_design_file.with_name(f"{name}.toml"))), stiff=True)
    sweep = contact_sweep(machine.contact, machine.design.requirements.peak_torque)
    point, _ = machine.contact.disc.profile(sweep.ring_parameter[sweep.ring_force > 0.0])
    off = np.abs(math.tau / 10 * np.round(np.angle(point) * 10 / math.tau) - np.angle(point))
    away = off * np.abs(point)
    assert away.min() > (0.5 + OVERLAP_SHARE) * DEFAULTS.tab_length


def test_tabs_are_where_no_tooth_or_pin_pushes(paper, parts):
    """Their middle is in a valley, between teeth, and outward in an output hole."""
    for flat in parts:
        for cut, number in zip(_cuts(program(flat, paper)), flat.cut_order, strict=True):
            wall, tab = _passes(cut)
            ends = wall[0][0][2], wall[0][-2][2]
            way = np.array([move[2] for move in tab[0][:-1]])
            assert {complex(way[0]), complex(way[-1])} == set(ends)
            contour = flat.contours[number]
            if not isinstance(contour, Circle):
                middle = cmath.phase(ends[0] + ends[1])
                pitch = 2.0 * math.pi / (10 if flat.label == "disc" else 11)
                off = math.remainder(middle - (0.0 if flat.label == "disc" else pitch / 2), pitch)
                assert abs(off) < 1e-3
                # Deepest in the part, away from the waste.
                radii = np.abs(_points(_contour_moves(cut)))
                deep = radii.min() if flat.label == "disc" else radii.max()
                assert abs(abs(0.5 * (ends[0] + ends[1])) - deep) < 0.3
            elif abs(complex(*contour.centre)) > 1e-6:
                outward = 1e3 * complex(*contour.centre)
                lever = ((0.5 * (ends[0] + ends[1]) - outward) / outward).imag
                assert abs(lever) < 1e-4


def test_the_other_dialect_cuts_the_same(paper, parts):
    usual = program(parts[0], paper)
    other = program(parts[0], paper, ExportOptions(gcode_dialect="sodick"))
    check_program(other, parts[0], paper.edm)
    assert re.findall(r"^H001 = (\S+)", other, re.MULTILINE) == ["0.2070"]
    assert "\nN0011\n" in other
    assert "\nO0011\n" not in other
    assert " D0" not in re.sub(r"\(.*\)", "", other)
    for one, two in zip(_cuts(usual), _cuts(other), strict=True):
        assert [move[:4] for move in one] == [move[:4] for move in two]


def test_a_piece_takes_as_long_as_its_wall_and_its_passes(parts):
    disc = parts[0]
    wall = sum(one.length() for one in disc.contours)
    holes = len(disc.contours)
    for count in (1, 4):
        expected = 60.0 * (holes + wall * disc.thickness / 100e-6 + (count - 1) * wall / 6e-3)
        assert sum(contour_times(disc, count)) == pytest.approx(expected)


def _replaced(text, old, new, count=1):
    assert re.search(old, text)
    return re.sub(old, new, text, count=count)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        (r"G42 D01 G01 X27\.122", "G41 D01 G01 X27.122", "G41 puts the wire into the material"),
        ("G41", "G42", "G42 puts the wire into the material"),
        ("G90 ", "G91 ", "G90 G21"),
        ("G21", "G20", "G90 G21"),
        (r"\nM01\n", "\n", "does not stop once"),
        (r"G02 X27\.", "G02 X27.1", "radii of|close"),
        (r"G02 (X\S+ Y\S+ I)-", r"G02 \1", "radii of"),
        (r"\nG02 X", "\nG03 X", "exact curve|clockwise|turns by|material|contour|pass before"),
        (r"G00 X12", "G00 X19", "lead out as it led in|threaded in the material"),
        (r"%\n$", "", "begin and end with %"),
        (r"G01 X", "G01 Q", "without an offset"),
        ("D02 = 0.1570", "D02 = 0.1470", "register 2 holds 0.1470 mm, not 0.1570"),
        ("G42 D02", "G42 D03", "register 3 holds"),
        ("G42 D12", "G41 D12", "G41 puts the wire into the material"),
        ("M98 P0012", "M98 P0011", "does not begin|close|along the pass"),
        ("M98 P0012", "M98 P0099", "calls no subprogram"),
        (r"(G40 G01 X\d+\.)\d", r"\g<1>9", "middle of the kerf"),
        (r"\nM99\n%", "\n%", "does not end at an M99"),
        (
            r"X13\.8844 Y-1\.7950\nM98 P0016",
            r"X13.9197 Y-1.4971\nM98 P0014",
            "runs 0.0000 and 0.0000 mm over the wall, not 0.3000 and 0.3",
        ),
        (r"(G01 G40 X\d+\.)\d", r"\g<1>9", "radii of"),
        (r"G01 G40 (X\S+ Y\S+)\nG02 .*\n", r"G01 G40 \1\n", "does not lead out as it led in"),
        (r"G01 G40 (X\S+ Y\S+)\nG02 .*\n", r"", "middle of the kerf"),
        (r"\nG02 (X22\.1491 Y4\.8210) I\S+ J\S+", r"\nG01 \1", "leaves the kerf"),
        (r"(G02 X13\.7052 .*\n)", r"\1G41 D14 G01 X13.9 Y1.4\n", "again on the way"),
    ],
)
def test_a_spoilt_program_is_refused(text, paper, parts, old, new, said):
    check_program(text, parts[0], paper.edm)
    with pytest.raises(ReadBackError, match=said):
        check_program(_replaced(text, old, new), parts[0], paper.edm)


def test_the_blank_holds_the_start_hole_and_a_border_to_clamp(paper, parts):
    for flat in parts:
        told = program(flat, paper)
        side = float(re.search(r"BLANK (\d+) X", told)[1])
        x, y = re.findall(r"^G00 X(\S+) Y(\S+)$", told, flags=re.M)[-1]
        beyond = 0.5 * side - math.hypot(float(x), float(y))
        assert 1e3 * BORDER < beyond < 1e3 * BORDER + 3.0, "half of a start hole more, rounded"


def test_a_program_for_a_plastic_says_that_no_wire_cuts_it(paper):
    for material, said in (("PC-CF FDM along layers", True), ("AISI 4140 Q&T 540C", False)):
        design = paper.replacing({"reducer.disc_material": material})
        disc = flat_parts(resolve(design))[0]
        assert ("NO WIRE CUTS IT" in program(disc, design)) is said


@pytest.mark.parametrize("lobes", [9, 10, 28])
def test_no_clamp_stands_where_the_wire_runs(paper, lobes):
    """A start hole beside a disc is nearer to the axis than the lobes are."""
    change = {"requirements.ratio": lobes, "reducer.ratio": lobes}
    if lobes != 10:
        change |= {"reducer.eccentricity": 1.6e-3 * 10 / lobes, "reducer.ring_pin_diameter": 3e-3}
    design = paper.replacing(change)
    for flat in flat_parts(resolve(design)):
        told = program(flat, design)
        side, free = map(int, re.search(r"BLANK (\d+) X .* OUTSIDE DIA (\d+)", told).groups())
        reached = 2e3 * max(math.hypot(x, y) for x, y in flat.contours[0].sample(1e-6))
        wire = 2e3 * design.edm.wire_offset
        assert reached + 2.0 * wire < free
        assert abs(side - free - 2e3 * BORDER) <= 1.0, "rounded up"
        x, y = re.findall(r"^G00 X(\S+) Y(\S+)$", told, flags=re.M)[-1]
        assert free > 2.0 * math.hypot(float(x), float(y))


def test_a_missing_cut_and_the_wrong_part_are_refused(text, paper, parts):
    with pytest.raises(ReadBackError, match="7 cuts for 2 contours"):
        check_program(text, parts[1], paper.edm)
    bigger = program(
        flat_parts(resolve(paper.replacing({"reducer.eccentricity": "1.61 mm"})))[0], paper
    )
    with pytest.raises(ReadBackError, match=r"disc, cut \d"):
        check_program(bigger, parts[0], paper.edm)


@SEVERAL
@given(
    disc=discs(modified=True, least_lobes=4, most_lobes=40),
    ring_type=st.sampled_from(["solid", "conjugate", "pinwheel"]),
)
# A hole whose centre lies off the grid of the coordinates, with joints that round away from it.
@example(
    disc=CycloidDisc(
        lobe_count=15,
        ring_pitch_radius=0.0625,
        eccentricity=0.0009560793163542446,
        tooth_radius=0.006096572563004008,
    ),
    ring_type="solid",
)
def test_any_design_gives_programs_that_pass_their_check(tmp_path_factory, disc, ring_type):
    folder = tmp_path_factory.mktemp("any")
    try:
        design = design_of(disc, ring_type=ring_type)
        parts = flat_parts(resolve(design))
        files = export(design, "gcode", folder)
    except CqddError as error:
        refused = error
    else:
        refused = None
    if refused is not None:
        # Too thick a wire is the design's fault; nothing else may be refused as a bad program.
        assert not isinstance(refused, ReadBackError) or "choose a wire" in str(refused)
        assert list(folder.iterdir()) == []
        return
    for file, flat in zip(files, parts, strict=True):
        cuts = _cuts(file.path.read_text(encoding="ascii"))
        assert len(cuts) == 1 + len(flat.shape.holes)
        for cut, hole in zip(cuts, flat.shape.holes, strict=False):
            if isinstance(hole, Circle):
                off = np.abs(_points(_contour_moves(cut)) - 1e3 * complex(*hole.centre))
                assert np.abs(off - 1e3 * hole.radius).max() < 2e-4
