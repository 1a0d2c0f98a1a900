"""What a refusal says would fit: the road to it; deep, that it does and little less does not."""

import gc
import weakref
from dataclasses import replace
from types import SimpleNamespace

import pytest

from cqdd_design.design import requirements_from_mapping
from cqdd_design.sizing import nearest, slower
from cqdd_design.sizing.able import TooHotError
from cqdd_design.sizing.infeasible import SizingInfeasibleError
from cqdd_design.sizing.no_nearer import size_or_refuse
from cqdd_design.sizing.spaces import FITS
from cqdd_design.sizing.verified import new_hunt, size_to_verdict

ASKED = {
    "ratio": 16,
    "peak_torque": "45 N*m",
    "continuous_torque": "6 N*m",
    "continuous_speed": "300 rpm",
}


def refused(*binding):
    return SizingInfeasibleError("it does not fit.", binding=binding, most_torque=None)


def found(**asked):
    design = SimpleNamespace(requirements=SimpleNamespace(**asked))
    return SimpleNamespace(sizing=SimpleNamespace(design=design))


def said(
    monkeypatch,
    bears,
    verdict,
    given=ASKED,
    first=("BEARING-STATIC",),
    length="8 mm",
    progress=lambda _: None,
):
    """The refusal of a search that fails at first, with what bears and passes by length."""
    asked = requirements_from_mapping({**given, "length": length})
    tried = []

    def searched(hunt, stated):
        own = hunt.requirements
        if not tried:
            tried.append("first")
            raise refused(*first)
        tried.append((1e3 * own.length, tuple(sorted(own.derived))))
        answer = verdict(1e3 * own.length, own.derived)
        if isinstance(answer, Exception):
            raise answer
        return answer

    monkeypatch.setattr(nearest, "searched", searched)
    monkeypatch.setattr(nearest, "_more_again", lambda _, found, refusal: found)
    monkeypatch.setattr(nearest, "both_bearable", lambda _: 1.0)
    sound = SimpleNamespace(worth=(False, 1.0))
    monkeypatch.setattr(
        nearest,
        "ranked",
        lambda hunt, **_: [sound] if bears(1e3 * hunt.requirements.length) else [],
    )
    with pytest.raises(SizingInfeasibleError) as caught:
        nearest.size_or_nearest(asked, progress)
    return caught.value, tried


def test_that_it_does_not_fit_is_told_before_what_would_is_looked_for(monkeypatch):
    """The ways out take minutes: each sentence, in which nothing is left open, as it is known."""
    told = []
    torques = found(peak_torque=15.0, continuous_torque=5.0)
    said(monkeypatch, lambda length: length >= 13.2, lambda *_: torques, progress=told.append)
    assert told == [
        "it does not fit.",
        "looking for what would fit, which may take minutes (Ctrl-C where that is enough)",
        "looking for the torques that fit",
        "What fits at least: peak_torque 15 N*m with continuous_torque 5 N*m.",
        "looking for more torque that still fits",
        "looking for the least length that fits, up to 20 mm",
    ]


def test_where_nothing_is_looked_for_it_is_told_once(monkeypatch):
    told, given = [], {"ratio": 16}
    error, tried = said(
        monkeypatch, lambda _: True, None, given, ("THERMAL-RISE",), progress=told.append
    )
    assert tried == ["first"]
    assert told == []
    assert error.message.startswith("it does not fit.")


def test_torques_and_the_least_length_are_told(monkeypatch):
    def verdict(length, derived):
        return found(peak_torque=15.0, continuous_torque=5.0)

    error, tried = said(monkeypatch, lambda length: length >= 13.2, verdict)
    assert error.message == (
        "it does not fit. What fits, by the whole verdict: peak_torque 15 N*m with "
        "continuous_torque 5 N*m, or length 13.5 mm."
    )
    assert error.to_dict() == {
        "binding": ["BEARING-STATIC"],
        "most_peak_torque_Nm": 15.0,
        "most_continuous_torque_Nm": 5.0,
        "outer_diameter_needed_mm": None,
        "length_needed_mm": 13.5,
        "ratio_needed": None,
    }
    assert tried == [
        "first",
        (8.0, ("continuous_torque", "peak_torque")),
        (pytest.approx(13.5), ()),
    ]


@pytest.mark.parametrize(
    ("length", "least"), [("10.2 mm", 10.5), ("10.26 mm", 10.5), ("10.74 mm", 11.0)]
)
def test_a_length_between_the_steps_ends_the_search_too(monkeypatch, length, least):
    torques = found(peak_torque=15.0, continuous_torque=5.0)
    error, _ = said(monkeypatch, lambda _: True, lambda *_: torques, length=length)
    assert 1e3 * error.length_needed == pytest.approx(least)


def test_a_length_that_the_verdict_refuses_is_not_told(monkeypatch):
    """What it has learnt moves the next one on."""

    def verdict(length, derived):
        return (
            found(peak_torque=15.0, continuous_torque=5.0)
            if derived or length > 14.2
            else refused("YIELD")
        )

    error, tried = said(monkeypatch, lambda length: length >= 13.2, verdict)
    assert error.length_needed is not None
    assert error.length_needed > 14.2e-3
    lengths = [one[0] for one in tried[2:]]
    assert lengths[0] > 13.0
    # The most is tried before another length is.
    assert lengths[1] == max(lengths)
    assert lengths[0] < lengths[2]
    assert lengths[2:] == sorted(lengths[2:])


def test_where_the_most_does_not_do_no_other_length_is_tried(monkeypatch):
    def verdict(length, derived):
        return found(peak_torque=15.0, continuous_torque=5.0) if derived else refused("YIELD")

    error, tried = said(monkeypatch, lambda length: length >= 13.2, verdict)
    assert error.length_needed is None
    assert len(tried) == 4
    assert tried[3][0] > tried[2][0]


def test_where_less_torque_does_not_help_neither_does_space(monkeypatch):
    hot = TooHotError("the motor holds nothing; state continuous_speed.")
    error, tried = said(monkeypatch, lambda _: True, lambda *_: hot)
    assert error.message == (
        "it does not fit. Less torque does not help: the motor holds nothing; state "
        "continuous_speed."
    )
    assert len(tried) == 2
    error, tried = said(monkeypatch, lambda _: True, lambda *_: refused("MOTOR-PEAK", "EFFICIENCY"))
    assert error.message == (
        "it does not fit. Less torque does not help: the nearest is short of peak torque of motor "
        "and driver at standstill and efficiency of the gearbox."
    )
    assert error.length_needed is None
    assert len(tried) == 2


def test_where_space_may_not_help_the_most_of_it_is_tried_first(monkeypatch):
    torques = found(peak_torque=15.0, continuous_torque=5.0)
    hot = refused("THERMAL-RISE", "YIELD")
    binding = "MOTOR-CONTINUOUS", "YIELD"

    def never(length, derived):
        return torques if derived else hot

    error, tried = said(monkeypatch, lambda _: True, never, first=binding)
    assert error.length_needed is None
    assert error.to_dict()["most_peak_torque_Nm"] == 15.0
    assert [one[0] for one in tried[2:]] == [20.0]
    assert error.message.endswith(
        "continuous_torque 5 N*m. With length 20 mm it is still short of steady temperature "
        "of winding, grease and housing."
    )

    def if_long(length, derived):
        return torques if derived or length > 14.2 else hot

    error, tried = said(monkeypatch, lambda length: length >= 13.2, if_long, first=binding)
    assert 14.2e-3 < error.length_needed < 15e-3
    assert tried[2][0] == 20.0
    # What was found to fit is told where nothing smaller was in a few steps.
    error, tried = said(
        monkeypatch,
        lambda _: True,
        lambda length, derived: torques if derived or length > 19.9 else hot,
        first=binding,
    )
    assert error.length_needed == pytest.approx(20e-3)
    assert len(tried) == 2 + 1 + nearest._ROUNDS
    # A search for more space that fails for heat ends as well.
    error, tried = said(monkeypatch, lambda length: length >= 13.2, if_long)
    assert error.length_needed is None
    assert len(tried) == 3
    assert "With length 13.5 mm it is still short of steady temperature" in error.message


@pytest.mark.parametrize(
    ("binding", "freed"),
    [
        ("MOTOR-PEAK", ("peak_torque",)),
        ("MOTOR-CONTINUOUS", ("continuous_torque",)),
        ("BEARING-STATIC", ("continuous_torque", "peak_torque")),
    ],
)
def test_only_the_torque_that_is_short_is_lowered(monkeypatch, binding, freed):
    torques = found(peak_torque=15.0, continuous_torque=6.0)
    _, tried = said(monkeypatch, lambda _: False, lambda *_: torques, first=(binding,))
    assert tried[1] == (8.0, freed)
    # Where that alone does not help, both are.
    alone = {("peak_torque",), ("continuous_torque",)}
    _, tried = said(
        monkeypatch,
        lambda _: False,
        lambda _, derived: refused("YIELD") if tuple(derived) in alone else torques,
        first=(binding,),
    )
    assert tried[1 if len(freed) == 2 else 2] == (8.0, ("continuous_torque", "peak_torque"))


def test_what_the_motor_reaches_is_tried_as_it_is(monkeypatch):
    peaks = []

    def tried(hunt, asked):
        peaks.append((asked.peak_torque, asked.continuous_torque, asked.derived))
        return nearest._Way(hunt, found(), None)

    monkeypatch.setattr(nearest, "_tried", tried)
    hunt = new_hunt(requirements_from_mapping(ASKED), lambda _: None, None, None, "mass")
    short = SizingInfeasibleError("no.", binding=("MOTOR-PEAK",), most_torque=19.47)
    nearest._less_torque(hunt, short)
    assert peaks == [(19.0, 6.0, frozenset())]
    # A little less than it holds for ever, which hangs on the gearbox.
    short = SizingInfeasibleError(
        "no.", binding=("MOTOR-CONTINUOUS",), most_torque=None, most_lasting_torque=2.0
    )
    nearest._less_torque(hunt, short)
    assert peaks[1:] == [(45.0, 1.9, frozenset())]
    # Not where it holds nothing, which has no such figure, or where something else is short too.
    for binding, held in ((("MOTOR-CONTINUOUS",), None), (("MOTOR-CONTINUOUS", "YIELD"), 2.0)):
        short = SizingInfeasibleError(
            "no.", binding=binding, most_torque=None, most_lasting_torque=held
        )
        nearest._less_torque(hunt, short)
    assert len(peaks) == 4
    assert all(free for *_, free in peaks[2:])


@pytest.mark.parametrize(("bears", "holds"), [(23.0, 9.0), (44.9, 3.0), (15.0, 2.2), (30.0, 4.1)])
def test_torques_that_are_told_are_nearly_the_most(monkeypatch, bears, holds):
    """Those that a search lowered from stated ones are raised again: it goes down in strides."""
    asked = requirements_from_mapping(ASKED)
    tried = []

    def way(hunt, own):
        tried.append((own.peak_torque, own.continuous_torque))
        fits = own.peak_torque <= bears and own.continuous_torque <= holds
        torques = {"peak_torque": own.peak_torque, "continuous_torque": own.continuous_torque}
        return nearest._Way(hunt, found(**torques) if fits else None, None)

    monkeypatch.setattr(nearest, "_tried", way)
    hunt = new_hunt(asked, lambda _: None, None, None, "mass")
    low = found(peak_torque=15.0, continuous_torque=2.0)
    most = nearest._more_again(hunt, low, refused("YIELD")).sizing.design.requirements
    assert 15.0 <= most.peak_torque <= bears
    assert 2.0 <= most.continuous_torque <= holds
    # One of both binds; strides are halved as often as is worth while.
    assert max(most.peak_torque / bears, most.continuous_torque / holds) > 0.92
    assert 1 <= len(tried) <= nearest._RISES
    assert all(peak < 45.0 and lasting < 6.0 for peak, lasting in tried)
    # A torque that nobody stated is no aim.
    free = replace(hunt, requirements=asked.deriving("continuous_torque"))
    tried.clear()
    nearest._more_again(free, low, refused("YIELD"))
    assert {lasting for _, lasting in tried} == {free.requirements.continuous_torque}


def test_what_a_failed_search_says_is_borne_saves_searches_for_more(monkeypatch):
    """100 N m at ratio 10: 72.1 fails and says 61, 61.2 fails after a minute and says 58."""
    tried = []

    def way(hunt, own):
        tried.append(own.peak_torque)
        if own.peak_torque <= 57.0:
            return nearest._Way(
                hunt, found(peak_torque=own.peak_torque, continuous_torque=6.0), None
            )
        about = 57.0 + 0.2 * (own.peak_torque - 57.0)
        estimate = f"; no more than about {about:g} N*m are carried"
        short = SizingInfeasibleError(
            f"no{estimate}.", binding=("YIELD",), most_torque=about, estimate=estimate
        )
        return nearest._Way(hunt, None, short)

    monkeypatch.setattr(nearest, "_tried", way)
    asked = requirements_from_mapping({**ASKED, "peak_torque": "100 N*m"})
    hunt = new_hunt(asked, lambda _: None, None, None, "mass")
    low = found(peak_torque=52.0, continuous_torque=6.0)
    most = nearest._more_again(hunt, low, refused("YIELD")).sizing.design.requirements
    assert tried[0] == pytest.approx(72.1)
    assert max(tried[1:]) < 61.0
    assert most.peak_torque > 55.0
    # What it says is less than what fits: nothing more is tried.
    tried.clear()
    low = found(peak_torque=70.0, continuous_torque=6.0)
    nearest._more_again(hunt, low, refused("YIELD"))
    assert len(tried) == 1


def found_at(speed, holds):
    verdict = SimpleNamespace(evidence=SimpleNamespace(actuator=holds))
    return SimpleNamespace(verdict=verdict, speed=speed)


@pytest.mark.parametrize(
    ("first", "most", "told"),
    [
        # The nearest design's motor stands 96 rpm; those that are found ever more, up to 118.
        (96.0, 118.0, 118.0),
        # With another gearbox a little more is held than the motor of any was found to stand.
        (96.0, 98.5, 98.5),
        # No design at that speed is found, but a little below.
        (96.0, 90.0, 90.0),
        (96.0, 80.0, None),
        # Nothing more than was asked for.
        (290.0, 400.0, 300.0),
        (None, 400.0, None),
    ],
)
def test_the_speed_is_told_at_which_the_torque_is_held(monkeypatch, first, most, told):
    """A motor that its own drag overheats at 800 rpm holds what is asked at 276."""
    tried = []

    def search(own):
        speed = own.continuous_speed * 30.0 / 3.141592653589793
        assert own.peak_torque == 45.0
        assert "continuous_speed" in own.model_fields_set
        tried.append(speed)
        fits = speed <= most + 1e-9
        holds = min(1.1 * speed, most) if most > 100.0 else speed
        return found_at(speed, holds) if fits else None

    monkeypatch.setattr(slower, "held_up_to", lambda holds, _: holds)
    hunt = new_hunt(requirements_from_mapping(ASKED), lambda _: None, None, None, "mass")
    short = SizingInfeasibleError(
        "no.", binding=("MOTOR-CONTINUOUS",), most_torque=None, most_speed=first
    )
    answer = slower.less_speed(hunt, short, search)
    if told is None:
        assert answer is None
    else:
        # 2 % nearer to what was asked is too much, or no less than it.
        assert told / 1.02 <= answer <= told
    rounds = len(tried)
    assert rounds <= 2 + slower.TRIES
    assert all(speed < 300.0 for speed in tried)
    # Where anything else is short it is not looked for.
    short.binding = ("MOTOR-CONTINUOUS", "YIELD")
    assert slower.less_speed(hunt, short, search) is None
    assert len(tried) == rounds


def test_a_refusal_that_is_kept_holds_no_designs(monkeypatch):
    """Its frames held machines for as long as other requirements were searched."""
    kept = []

    class Held:
        """Something large in a frame of the search."""

    def refused(hunt, asked):
        large = Held()
        kept.append(weakref.ref(large))
        hunt.solved.append((large, ()))
        hunt.fit = FITS[-1]
        try:
            raise KeyError(large)
        except KeyError as error:
            raise SizingInfeasibleError("no.", binding=("YIELD",), most_torque=None) from error

    monkeypatch.setattr(nearest, "searched", refused)
    asked = requirements_from_mapping(ASKED)
    hunt = new_hunt(asked, lambda _: None, None, None, "mass")
    way = nearest._tried(hunt, asked)
    gc.collect()
    assert way.refusal.binding == ("YIELD",)
    assert [one() for one in kept] == [None]
    # What was learnt is kept.
    assert way.hunt.fit == FITS[-1]


@pytest.mark.parametrize(
    ("peak", "lasting", "told"), [(27.0, 5.0, False), (11.0, 5.0, True), (27.0, 1.5, True)]
)
def test_an_estimate_that_a_search_overtakes_is_not_told_beside_it(
    monkeypatch, peak, lasting, told
):
    """`no more than about 12 N m are carried` stood before `what fits: peak_torque 27.3 N m`."""
    estimate = "; no more than about 12 N*m are carried"
    short = SizingInfeasibleError(
        f"it does not fit{estimate}. Ask for less.",
        binding=("YIELD",),
        most_torque=12.0,
        estimate=estimate,
    )
    fits = found(peak_torque=peak, continuous_torque=lasting)
    monkeypatch.setattr(nearest, "_less_torque", lambda hunt, _: nearest._Way(hunt, fits, None))
    monkeypatch.setattr(nearest, "_more_again", lambda _, found, refusal: found)
    monkeypatch.setattr(nearest, "_limits", lambda _: iter(()))
    sentences: list[str] = []
    hunt = new_hunt(requirements_from_mapping(ASKED), sentences.append, None, None, "mass")
    error = nearest._with_ways(short, hunt)
    assert sentences[0] == "it does not fit. Ask for less."
    assert (estimate in error.message) == told
    assert error.message.startswith("it does not fit")
    assert f"peak_torque {peak:g} N*m with continuous_torque {lasting:g} N*m" in error.message


def test_a_speed_that_fits_is_told_beside_why_torque_does_not_help(monkeypatch):
    hot = TooHotError("the motor holds nothing.")
    monkeypatch.setattr(nearest, "less_speed", lambda *_: 276.0)
    error, _ = said(monkeypatch, lambda _: False, lambda *_: hot, first=("MOTOR-CONTINUOUS",))
    assert error.message.endswith(
        "What fits, by the whole verdict: continuous_speed 276 rpm. Less torque does not help: "
        "the motor holds nothing."
    )
    assert error.to_dict()["most_continuous_speed_rpm"] == 276.0


@pytest.mark.parametrize(
    ("line", "low", "most"),
    [("MOTOR-CONTINUOUS", (15.0, 2.0), (44.0, 2.05)), ("MOTOR-PEAK", (15.0, 2.0), (15.2, 5.5))],
)
def test_what_the_motor_cannot_do_does_not_keep_the_other_torque_down(monkeypatch, line, low, most):
    """Heat left 2.85 N m of 6.76 for ever, and 24.2 N m of 29 beside it that bore more."""
    bears, holds = most
    tried = []

    def way(hunt, own):
        tried.append((own.peak_torque, own.continuous_torque))
        torques = {"peak_torque": own.peak_torque, "continuous_torque": own.continuous_torque}
        if own.peak_torque <= bears and own.continuous_torque <= holds:
            return nearest._Way(hunt, found(**torques), None)
        own_fault = own.continuous_torque > holds if "CONT" in line else own.peak_torque > bears
        return nearest._Way(hunt, None, refused(line if own_fault else "YIELD"))

    monkeypatch.setattr(nearest, "_tried", way)
    hunt = new_hunt(requirements_from_mapping(ASKED), lambda _: None, None, None, "mass")
    start = found(peak_torque=low[0], continuous_torque=low[1])
    told = nearest._more_again(hunt, start, refused(line)).sizing.design.requirements
    assert told.peak_torque > 0.75 * bears
    assert told.continuous_torque > 0.75 * holds
    assert len(tried) == nearest._RISES
    # Once the other is as it was asked for, the one that is short is tried again.
    tried.clear()
    start = found(peak_torque=45.0, continuous_torque=0.5)
    nearest._more_again(hunt, start, refused("MOTOR-CONTINUOUS"))
    assert {peak for peak, _ in tried} == {45.0}
    assert len({lasting for _, lasting in tried}) == nearest._RISES


def test_torques_that_nobody_stated_are_not_looked_for(monkeypatch):
    given = {"ratio": 16}
    error, tried = said(monkeypatch, lambda _: False, lambda *_: refused("YIELD"), given)
    both = "continuous_torque", "peak_torque"
    assert tried == ["first", (pytest.approx(20.0), both)]
    assert error.message.endswith("were found that do, by the whole verdict.")
    # What the motor could do may be too much there as well, but not what fits.
    fits = found(peak_torque=5.0, continuous_torque=1.0)
    error, tried = said(monkeypatch, lambda _: False, lambda *_: fits, given)
    assert error.length_needed == pytest.approx(20e-3)


def test_for_torques_that_nobody_stated_hardly_any_has_to_be_borne(monkeypatch):
    peaks = []

    def ranked(hunt, **_):
        peaks.append(hunt.requirements.peak_torque)
        return [SimpleNamespace(worth=(False, 1.0))]

    monkeypatch.setattr(nearest, "ranked", ranked)
    monkeypatch.setattr(nearest, "both_bearable", lambda _: 0.0)
    stated = requirements_from_mapping(ASKED)
    hunt = new_hunt(stated, lambda _: None, None, None, "mass")
    assert not nearest._bears(hunt, stated)
    assert nearest._bears(hunt, stated.deriving("peak_torque", "continuous_torque"))
    assert peaks == [pytest.approx(4.5, rel=0.05)]


def test_the_cam_bearing_that_did_last_time_is_tried_first(monkeypatch):
    """The others are in vain: of six lengths that are tried that takes most of the time."""
    first = []

    def ranked(hunt, **_):
        first.append(hunt.strongest)
        one = SimpleNamespace(worth=(len(first) == 3, 1.0), cam=f"69{len(first):02}")
        hunt.known["space"] = one
        return [one]

    monkeypatch.setattr(nearest, "ranked", ranked)
    monkeypatch.setattr(nearest, "both_bearable", lambda _: 1.0)
    stated = requirements_from_mapping(ASKED)
    hunt = new_hunt(stated, lambda _: None, None, None, "mass")
    hunt.extra_of = {"6802": {}, "16001": {}}
    borne = [nearest._bears(hunt, stated) for _ in range(4)]
    assert borne == [True, True, False, True]
    # Before any did, the one that was looked at last; what fails says nothing of it.
    assert first == ["16001", "6901", "6902", "6902"]


def test_a_ring_that_fills_the_bore_is_not_made_larger():
    hunt = nearest.new_hunt(requirements_from_mapping(ASKED), lambda _: None, None, None, "mass")
    assert dict(nearest._limits(hunt)) == {"length": pytest.approx(50e-3)}
    small = replace(
        hunt, requirements=requirements_from_mapping({**ASKED, "outer_diameter": "60 mm"})
    )
    assert dict(nearest._limits(small))["outer_diameter"] == pytest.approx(72e-3)


@pytest.mark.deep
def test_the_length_that_is_told_fits_and_little_less_does_not():
    with pytest.raises(SizingInfeasibleError) as caught:
        size_or_refuse(requirements_from_mapping({**ASKED, "length": "8 mm"}))
    need = caught.value.length_needed
    assert need is not None
    fits = size_to_verdict(requirements_from_mapping({**ASKED, "length": f"{1e3 * need} mm"}))
    assert fits.verdict.meets == "yes"
    with pytest.raises(SizingInfeasibleError):
        size_to_verdict(requirements_from_mapping({**ASKED, "length": f"{980.0 * need} mm"}))
