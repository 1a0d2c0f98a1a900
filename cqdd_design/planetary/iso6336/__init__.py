"""ISO 6336 for one gear pair: influence factors (part 1), pitting (part 2), bending (part 3).

Clause and equation numbers are those of the 2006 editions unless another year is named. One
function is one formula of the standard. Arguments and results are SI (m, N, Pa); the millimetres,
micrometres and newtons per square millimetre of the empirical formulas live inside the functions.
"""
