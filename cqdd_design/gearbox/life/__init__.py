"""Life under a duty: contact fatigue, output-pin fatigue, cam bearings on their true spectrum."""

from cqdd_design.gearbox.life.life import duty_cases, life
from cqdd_design.gearbox.life.result import DutyCase, LifeResult, PartLife

__all__ = ["DutyCase", "LifeResult", "PartLife", "duty_cases", "life"]
