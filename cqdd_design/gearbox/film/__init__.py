"""The film between discs, ring and output pins: how thick it is, and the friction it leaves."""
