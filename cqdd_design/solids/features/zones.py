"""Tolerance zones of the seats, named as on a drawing (ISO 286), and why these.

The load of a cam bearing turns with the crank, so its inner ring has a standing load and slips on
the lobe (h6), while its outer ring is pressed into the disc (N7). The shaft's support bearings are
pressed on what turns (k6) and slide in what stands (H7). Their load turns with the crank too, and
would roll their outer rings round in such seats; but pressed on both sides they could not be set to
their axial play, so a retaining compound holds them there. The output bearing slides in what stands
too; its inner ring is clamped by a nut and sits on h5, as the maker asks for crossed rollers of
normal clearance (THK, General Catalog, Cross-Roller Ring: fitting), which a press fit would use up.
Ring and pins are located without play that matters: n6 in H7 for the ring, with a compound round
it, since a warm housing of aluminium lets go of it, H7 over the f9 shoulders of the screws. A
retaining compound fills what H7 leaves there where a pin is to sit stiffly: in a cap whose joint is
clamped, and in the plate where a dowel has no thread. The bell's bore is F7 over the k6 of the
shaft, a slip fit of a few hundredths at most that the compound fills. So does D8 round the m6
dowels of the ring, whose halves are cut apart: where ring and housing miss each other by the zones
of their grooves, a dowel still goes in by hand, and the compound takes the play that would let the
ring turn.
"""

from __future__ import annotations

DISC_BORE, LOBE = "N7", "h6"
"""Round and inside the cam bearing."""
JOURNAL, OUTPUT_JOURNAL, HOUSED = "k6", "h5", "H7"
"""What turns in the shaft's bearings and in the output bearing, and what stands round them."""
RING_OUTSIDE, RING_SEAT = "n6", "H7"
PIN, PIN_HOLE = "f9", "H7"
"""Output pins and their seats; dowels and what they sit in."""
DOWEL, SEAM_GROOVE = "m6", "D8"
"""Ground dowels, and the half grooves of the ring's, in ring and housing."""
REGISTER = "h7"
"""Under the stator."""
OUTPUT_REGISTER = "H7"
"""Round a spigot of what is driven, which is turned to h6 or g6."""
SPIGOT = "h6"
"""Of the ring clamp, in the seats of ring and output bearing: H7/h6 goes together by hand."""
CAN_SPIGOT, CAN_BORE = "h7", "H8"
"""Of the flange, and of the motor's cover on it: a thin can, which only the encoder asks to be
centred, within a quarter of a millimetre."""
BAND = "h9"
"""Of the cylinder for an indicator, which only has to run true."""
SEAL_INSIDE, SEAL_OUTSIDE = "h9", "H9"
"""Of what turns in a gap seal, and of the bore about it."""
BELL_BORE, MAGNETS, MAGNET_POCKET = "F7", "H7", "H9"
PRESSED_CAM, CAM_BORE = "j5", "H5"
"""Seat of a loose eccentric cam, and its bore: within about 10 um true to the seat while its
compound sets, which alone holds it; more interference would tear its thin side and gain nothing."""
LOOSE_LOBE = "g5"
"""Of a loose cam, which is ground before it is pressed on, and grows: by less than g5 lies below
h6, so that its bearing slips on it as on the others."""
RUNNER = "js6"
"""Outside of sleeves and rollers, whose mean is their nominal size, as it is judged."""
RING_PIN, RING_PIN_SEAT = "h6", "H7"
"""Of ring pins whose ends housing and clamp hold."""
