"""numba's own steps for a function that is not finished by itself (:mod:`.kernel_part`).

Nor is it compiled anew for each kind of caller: numba asks how a caller is to be compiled, and made
two or three of a part that a kernel calls and other parts too.

These are names that numba keeps for itself, so this module is imported with versions alone that it
was tried with.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from numba import _dynfunc, types  # type: ignore[attr-defined]
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.compiler_machinery import register_pass
from numba.core.typed_passes import NativeLowering
from numba.core.typing.templates import infer, infer_global, make_overload_template


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


def register(function: Callable[..., Any], options: Mapping[str, Any]) -> None:
    """Let kernels call a function, as :func:`numba.extending.register_jitable` does."""
    how = {"nopython": True, "no_cpython_wrapper": True, "pipeline_class": PartCompiler, **options}
    usual: Any = make_overload_template(  # type: ignore[no-untyped-call]
        function, lambda *_, **__: function, how, strict=False, inline="never"
    )

    def found(template: Any, args: Any, named: Any) -> Any:
        key = template.context, tuple(args), tuple(named.items())
        if key not in template._impl_cache:
            template._build_impl(key, args, named)
        return template._impl_cache[key]

    once = type(usual)(usual.__name__, (usual,), {"_get_impl": found})
    infer(once)  # type: ignore[no-untyped-call]
    infer_global(function, types.Function(once))  # type: ignore[no-untyped-call]
