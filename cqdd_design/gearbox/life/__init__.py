"""Life under a duty: contact fatigue, output-pin fatigue, cam bearings on their true spectrum."""

from cqdd_design.gearbox.life.life import LifeResult, PartLife, life

__all__ = ["LifeResult", "PartLife", "life"]
