"""What a compiled kernel rests on, in a few bytes: its own code and all that is compiled into it.

numba asks the time and size of the kernel's file whether what it keeps is still good. A kernel also
has in it the functions it calls, the constants it reads and the order of the values' fields, which
stand in other files: after an edit or an upgrade of those it would go on as before.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from types import CodeType, FunctionType, ModuleType
from typing import Any

import numpy as np

_OURS = "cqdd_design."


def kernel_stamp(function: FunctionType) -> str:
    """Digest of a Python function with everything of this package that it reaches by its names.

    Docstrings, comments, line numbers and times of files do not matter.
    """
    seen: dict[int, FunctionType] = {}
    words: list[str] = []
    left = [function]
    while left:
        here = left.pop()
        if id(here) in seen:
            continue
        seen[id(here)] = here
        words.append(f"{here.__module__}.{here.__qualname__} {_plain(here.__defaults__)}")
        for code in _codes(here.__code__):
            told = _has_doc(code, here)
            constants = (None, *code.co_consts[1:]) if told else code.co_consts
            plain = [_plain(one) for one in constants if not isinstance(one, CodeType)]
            words.append(f"{code.co_code.hex()} {code.co_varnames} {code.co_names} {plain}")
            for value in _values(here, code.co_names):
                words.append(_plain(value))
                left.extend(_functions(value))
    return hashlib.sha256("\n".join(words).encode()).hexdigest()


def _has_doc(code: CodeType, function: FunctionType) -> bool:
    return bool(
        code is function.__code__ and function.__doc__ and code.co_consts[:1] == (function.__doc__,)
    )


def _codes(code: CodeType) -> Iterable[CodeType]:
    """A function's code, and that of functions inside it."""
    yield code
    for one in code.co_consts:
        if isinstance(one, CodeType):
            yield from _codes(one)


def _values(function: FunctionType, names: Iterable[str]) -> Iterable[Any]:
    """What names of its code stand for: in its module, in modules of ours, and around it."""
    known = function.__globals__
    for name in names:
        if name in known:
            yield known[name]
    for module in [known[name] for name in names if isinstance(known.get(name), ModuleType)]:
        if module.__name__.startswith(_OURS):
            yield from (vars(module)[name] for name in names if name in vars(module))
    for cell in function.__closure__ or ():
        yield cell.cell_contents


def _functions(value: Any) -> Iterable[FunctionType]:
    """Python functions of ours behind a value: itself, or what numba compiles."""
    found = getattr(value, "py_func", value)
    if isinstance(found, FunctionType) and found.__module__.startswith(_OURS):
        yield found


def _plain(value: Any) -> str:
    """A value in words that are the same in every process."""
    if value is None or isinstance(value, bool | int | float | complex | str | bytes):
        return repr(value)
    if isinstance(value, np.generic | np.ndarray):
        array = np.asarray(value)
        return f"{array.dtype} {array.shape} {array.tobytes().hex()}"
    if isinstance(value, tuple | list):
        return f"({', '.join(_plain(one) for one in value)})"
    if isinstance(value, set | frozenset):
        return f"{{{', '.join(sorted(_plain(one) for one in value))}}}"
    if isinstance(value, dict):
        return f"{{{', '.join(f'{_plain(k)}: {_plain(v)}' for k, v in value.items())}}}"
    if isinstance(value, type):
        fields = getattr(value, "_fields", ())
        return f"{value.__module__}.{value.__qualname__} {fields}"
    if hasattr(value, "py_func"):
        return f"{value.py_func.__qualname__} {_plain(getattr(value, 'targetoptions', None))}"
    told = f"{getattr(value, '__module__', '')}.{getattr(value, '__qualname__', type(value))}"
    return f"{told} {_plain(getattr(value, 'part_options', None))}"
