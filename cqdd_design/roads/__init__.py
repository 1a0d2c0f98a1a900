"""What a command or a notebook calls: one module a road, from a design to what comes out of it.

A road makes the design concrete once and hands the machine to the rooms below. Every room is
imported by the function that needs it: the command line must answer ``--help`` without numpy, and
size a gearbox without a CAD kernel.
"""
