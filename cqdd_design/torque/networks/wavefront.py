"""A stacked GRU over short windows on the CPU, along diagonals instead of layer by layer.

Layer k at sample t needs layer k - 1 at t and itself at t - 1, so all layers with the same
``t + k`` are worked at once: for 4 layers and 30 samples 33 steps of batched products, where
torch takes 120 steps of small ones. The gradient is written out likewise. Gates in torch's order:
reset, update, new.
"""

from __future__ import annotations

import functools
import importlib
from typing import Any, ClassVar


def last_state(x: Any, parameters: list[Any]) -> Any:
    """Top state (B, H) of a GRU at the end of windows (B, T, F), from a zero state.

    Parameters
    ----------
    x : tensor (B, T, F)
        Needs no gradient, and gets none.
    parameters : list of tensor
        ``weight_ih, weight_hh, bias_ih, bias_hh`` of each layer, as `torch.nn.GRU` lists them.
    """
    return _function().apply(x, *parameters)


@functools.lru_cache(maxsize=1)
def _function() -> Any:
    # Who has tensors has torch; asking for it kindly is the caller's.
    torch = importlib.import_module("torch")

    class Wavefront(torch.autograd.Function):  # type: ignore[misc, name-defined]
        @staticmethod
        def forward(ctx: Any, x: Any, *parameters: Any) -> Any:
            ctx.save_for_backward(x, *parameters)
            ctx.space = _Workspace.taken(x, parameters)
            return _forward(torch, x, parameters, ctx.space)

        @staticmethod
        def backward(ctx: Any, grad: Any) -> Any:
            x, *parameters = ctx.saved_tensors
            space, ctx.space = ctx.space, None
            if space is None:
                raise RuntimeError("the gradient of one forward pass can be taken once")
            found = _backward(torch, x, parameters, space, grad)
            space.free()
            return (None, *found)

    return Wavefront


class _Workspace:
    """Tensors (layers, diagonals, batch, ...) of one pass, used again by the next of its shape.

    Fresh memory for each of them would cost a third of the whole step. What no diagonal works on
    stays zero for ever.
    """

    _idle: ClassVar[dict[Any, list[_Workspace]]] = {}

    def __init__(self, x: Any, layers: int, width: int, key: Any) -> None:
        batch, samples, _ = x.shape
        steps = samples + layers - 1
        self.key = key
        self.states = x.new_zeros(layers, steps + 1, batch, width)
        self.gates = x.new_zeros(layers, steps, batch, 2 * width)
        self.into, self.around = (x.new_zeros(layers, steps, batch, 3 * width) for _ in range(2))
        self.fresh, self.inner, self.kept, self.by_new, self.by_update, self.by_reset = (
            x.new_zeros(layers, steps, batch, width) for _ in range(6)
        )

    @classmethod
    def taken(cls, x: Any, parameters: Any) -> _Workspace:
        layers, width = len(parameters) // 4, parameters[1].shape[1]
        key = (tuple(x.shape[:2]), layers, width, x.dtype)
        idle = cls._idle.setdefault(key, [])
        return idle.pop() if idle else cls(x, layers, width, key)

    def free(self) -> None:
        idle = self._idle.setdefault(self.key, [])
        # One for full batches of one training is enough.
        if not idle:
            idle.append(self)


def _stacked(torch: Any, parameters: Any) -> Any:
    """Recurrent weights of all layers (L, H, 3H), and input weights of all but the first."""
    recurrent = torch.stack([weight.t() for weight in parameters[1::4]])
    upward = [weight.t() for weight in parameters[4::4]]
    return recurrent, torch.stack(upward) if upward else None


def _forward(torch: Any, x: Any, parameters: Any, space: _Workspace) -> Any:
    batch, samples, features = x.shape
    layers, width = len(parameters) // 4, parameters[1].shape[1]
    recurrent, upward = _stacked(torch, parameters)
    recurrent_bias = torch.stack(list(parameters[3::4]))[:, None]
    upward_bias: Any = torch.stack(list(parameters[6::4]))[:, None] if layers > 1 else None
    rows = x.transpose(0, 1).reshape(samples * batch, features)
    first = torch.addmm(parameters[2], rows, parameters[0].t()).view(1, samples, batch, 3 * width)
    # `states[:, s]` are those before diagonal s; a layer that has not begun stands at zero.
    states, steps = space.states, samples + layers - 1
    for s in range(steps):
        low, high = max(0, s - samples + 1), min(layers, s + 1)
        before = states[low:high, s]
        own = torch.baddbmm(recurrent_bias[low:high], before, recurrent[low:high])
        above = max(low, 1)
        parts = [first[:, s]] if low == 0 else []
        if high > above:
            under = slice(above - 1, high - 1)
            parts.append(torch.baddbmm(upward_bias[under], states[under, s], upward[under]))
        given = torch.cat(parts) if len(parts) > 1 else parts[0]
        gate, new, kept = (part[low:high, s] for part in (space.gates, space.fresh, space.inner))
        torch.add(given[..., : 2 * width], own[..., : 2 * width], out=gate)
        gate.sigmoid_()
        kept.copy_(own[..., 2 * width :])
        torch.addcmul(given[..., 2 * width :], gate[..., :width], kept, out=new)
        new.tanh_()
        torch.lerp(new, before, gate[..., width:], out=states[low:high, s + 1])
    return states[layers - 1, steps].clone()


def _backward(torch: Any, x: Any, parameters: Any, space: _Workspace, grad: Any) -> list[Any]:
    batch, samples, features = x.shape
    layers, width = len(parameters) // 4, parameters[1].shape[1]
    recurrent, onward = _stacked(torch, parameters)
    recurrent = recurrent.transpose(1, 2)
    upward: Any = None if onward is None else onward.transpose(1, 2)
    reset, update = space.gates[..., :width], space.gates[..., width:]
    states, fresh, into, around = space.states, space.fresh, space.into, space.around
    # (1 - z)(1 - n^2), (h - n) z (1 - z) and c r (1 - r), of all diagonals at once.
    kept = torch.neg(update, out=space.kept).add_(1.0)
    by_new = torch.mul(fresh, fresh, out=space.by_new).neg_().add_(1.0).mul_(kept)
    by_update = torch.sub(states[:, :-1], fresh, out=space.by_update).mul_(update).mul_(kept)
    by_reset = torch.mul(space.inner, reset, out=space.by_reset)
    by_reset.addcmul_(by_reset, reset, value=-1.0)
    state = x.new_zeros(layers, batch, width)
    state[layers - 1] = grad
    for s in range(samples + layers - 2, -1, -1):
        low, high = max(0, s - samples + 1), min(layers, s + 1)
        own, given, back = state[low:high], into[low:high, s], around[low:high, s]
        new = given[..., 2 * width :]
        torch.mul(own, by_new[low:high, s], out=new)
        torch.mul(own, by_update[low:high, s], out=given[..., width : 2 * width])
        torch.mul(new, by_reset[low:high, s], out=given[..., :width])
        back[..., : 2 * width] = given[..., : 2 * width]
        torch.mul(new, reset[low:high, s], out=back[..., 2 * width :])
        own.mul_(update[low:high, s]).baddbmm_(back, recurrent[low:high])
        above = max(low, 1)
        if high > above:
            under = slice(above - 1, high - 1)
            state[under].baddbmm_(given[above - low :], upward[under])
    found = []
    for k in range(layers):
        span = slice(k, k + samples)
        given = into[k, span].view(samples * batch, 3 * width)
        back = around[k, span].view(samples * batch, 3 * width)
        own = states[k, span].view(samples * batch, width)
        if k == 0:
            source = x.transpose(0, 1).reshape(samples * batch, features)
        else:
            source = states[k - 1, span].view(samples * batch, width)
        found += [given.t() @ source, back.t() @ own, given.sum(0), back.sum(0)]
    return found
