"""numba's own steps for a function that is not finished by itself (:mod:`.kernel_part`).

These are names that numba keeps for itself, so this module is imported with versions alone that it
was tried with.
"""

from __future__ import annotations

from typing import Any

from numba import _dynfunc  # type: ignore[attr-defined]
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.compiler_machinery import register_pass
from numba.core.typed_passes import NativeLowering


class _Unfinished(JITCodeLibrary):
    """Instructions that are linked into a kernel, neither optimised nor made machine code here."""

    def _optimize_final_module(self) -> None:
        """Left to the kernel."""

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()  # type: ignore[no-untyped-call]
        self._finalized = True


@register_pass(mutates_CFG=True, analysis_only=False)  # type: ignore[no-untyped-call]
class _PartLowering(NativeLowering):
    """Lowering into an unfinished library; what stands for the part in Python is never called."""

    _name = "part_lowering"

    def run_pass(self, state: Any) -> bool:
        """Lower one part; see :class:`numba.core.typed_passes.BaseNativeLowering`."""
        library = _Unfinished(state.targetctx.codegen(), state.func_id.func_qualname)  # type: ignore[no-untyped-call]
        state.library = library
        state.flags.no_compile = True
        super().run_pass(state)  # type: ignore[no-untyped-call]
        lowered = state["cr"]
        described = lowered.fndesc
        name = described.qualname.rpartition(".")[2]
        stand_in = _dynfunc.make_function(
            described.lookup_module(), name, f"part {name}", 0, lowered.env, (library,)
        )
        state.targetctx.insert_user_function(stand_in, described, [library])
        state["cr"] = lowered._replace(cfunc=stand_in)
        return True


class PartCompiler(CompilerBase):
    """numba's own passes, with lowering that leaves the rest to the kernel."""

    def define_pipelines(self) -> list[Any]:
        """The pipelines, as numba asks for them."""
        passes = DefaultPassBuilder.define_nopython_pipeline(self.state)  # type: ignore[no-untyped-call]
        passes.passes = [
            (_PartLowering if one is NativeLowering else one, why) for one, why in passes.passes
        ]
        passes._finalized = False
        passes.finalize()
        return [passes]
